"""The first zero of an arc's distance to the base or to a brace, bracketed by what is known where its stretches meet.

There (``crossing`` says what a stretch is) cos eta is known and e^t grows by given factors, so that the distance w and
its rate need no elementary function. A bracket holds one zero; whatever is not certain by a wide margin is UNSURE and left
to ``crossing``.
"""

import math
from typing import NamedTuple

from numba import njit

from .arc import after, exponentials, lapse_of
from .elementary import INNER, WITHIN
from .harmonic import first_cut, forcing_rates, forcing_term

MOST_TURNS = 64
# Knots of a dip that are looked at.
MOST_DIPS = 4
MARGIN = 1e-11
# In units of the rounding error of c+ and c-.
WIDE = 16.0

# What a walk ends with: a bracket, none for ever, none before its end, or a doubt.
ZERO, NEVER, CLEAR, UNSURE = range(4)


class Level(NamedTuple):
    """What an arc may meet, w = constant + of_angle u away, and how its stretches follow each other."""

    constant: float
    of_angle: float
    half: float
    convex_inside: bool
    # at the cuts: w less what the exponentials give; |w'| likewise; |w'''- w'|
    place: float
    rate: float
    bend: float
    # lengths of the stretches, and e^+-length of the convex one
    convex: float
    concave: float
    growth: float
    decay: float
    tanh: float


class Knot(NamedTuple):
    """w at one time, with what gives all its derivatives: w'' = w + f, w''' = w' + df."""

    time: float
    w: float
    dw: float
    f: float
    df: float


class Walk(NamedTuple):
    """How a walk ended; the bracket of ZERO."""

    answer: int
    low: Knot
    high: Knot


@njit(**INNER)
def base_level(p):
    """The base: w = u."""
    return Level(
        0.0,
        1.0,
        p.base_half,
        False,
        p.cut_place,
        p.cut_rate,
        p.cut_rate * (1.0 + p.frequency * p.frequency),
        p.base_outside,
        p.base_inside,
        p.base_outside_growth,
        p.base_outside_decay,
        p.base_outside_tanh,
    )


@njit(**INNER)
def brace_level(p):
    """The brace: w = brace_angle - u."""
    return Level(
        p.brace_angle,
        -1.0,
        p.brace_half,
        p.brace_half < math.inf or p.brace_angle < 1.0,
        p.brace_place,
        p.brace_rate,
        p.brace_rate * (1.0 + p.frequency * p.frequency),
        p.brace_inside,
        p.brace_outside,
        p.brace_inside_growth,
        p.brace_inside_decay,
        p.brace_inside_tanh,
    )


@njit(**INNER)
def knot(p, arc, constant, s, time, now):
    """The knot of w = constant + s u at an instant; w from its change since the start, so that it is accurate near a brace too."""
    f = forcing_term(p, now.cosine)
    df, _ = forcing_rates(p, now.cosine, now.sine)
    return Knot(time, (constant + s * arc.angle) + s * now.risen, s * now.velocity, s * f - constant, s * df)


@njit(**INNER)
def start_knot(p, arc, level):
    """The knot at the arc's start."""
    f = forcing_term(p, arc.cosine)
    df, _ = forcing_rates(p, arc.cosine, arc.sine)
    s = level.of_angle
    return Knot(0.0, level.constant + s * arc.angle, s * arc.velocity, s * f - level.constant, s * df)


@njit(**INNER)
def first_stretch(p, arc, level):
    """(when the first stretch ends, whether it is convex)."""
    if level.half == math.inf:
        return math.inf, level.convex_inside
    cut, inside = first_cut(p, arc.side, arc.psi, 0.0, level.half)
    return cut, inside == level.convex_inside


@njit(**INNER)
def rises(w, dw):
    """Whether w, positive here, stays so as long as f > 0 lasts from here on: it lies above the free motion (w'' = w)."""
    return w + dw >= 0.0


@njit(**INNER)
def lasts(here, doubt):
    """Whether w is positive in all of a convex stretch, by one knot in it: it lies above the free motion through that, either way."""
    return here.w - abs(here.dw) > doubt


@njit(**INNER)
def may_dip(level, left, right, left_doubt, right_doubt):
    """Whether w, positive at both ends of a convex stretch, may reach zero within.

    It stays clear if the free motions through either end never reach zero, or only after passing each other.
    """
    w, dw = left.w - left_doubt, left.dw - left_doubt
    w_right, dw_right = right.w - right_doubt, right.dw + right_doubt
    if rises(w, dw) or rises(w_right, -dw_right):
        return False
    crossed = w * dw_right - w_right * dw
    return not crossed >= level.tanh * (w * w_right - dw * dw_right) * (1.0 + MARGIN)


@njit(**INNER)
def held_up(p, level, here, left):
    """Whether w, falling, certainly stays positive in what is ``left`` of a convex stretch, of at most half a turn.

    There f is concave and ends at zero: it lies above its chord, and w, as w'' >= f, above a cubic.
    """
    if not (here.f > 0.0 and p.frequency * level.convex <= math.pi):
        return False
    # the cubic falls to its least at left - left sqrt(1 + 2 w'/(f left)), or all the way
    under = 1.0 + 2.0 * here.dw / (here.f * left)
    time = left - left * math.sqrt(max(under, 0.0))
    least = here.w + time * (here.dw + time * here.f * (0.5 - time / (6.0 * left)))
    return least > MARGIN * (1.0 + here.w + left * (left * here.f - here.dw))


@njit(**WITHIN)
def bottom(p, arc, level, left, right, doubt):
    """A knot of a dip that tells whether it reaches zero, or, after some tries, a knot near its bottom.

    The first is where the slope, a cubic by its values and derivatives at both ends, vanishes; then Newton's method.
    """
    width = right.time - left.time
    a, b = left.dw, right.dw
    da, db = (left.w + left.f) * width, (right.w + right.f) * width
    x = -a / (b - a)
    for _ in range(2):
        c2, c3 = 3.0 * (b - a) - 2.0 * da - db, da + db - 2.0 * (b - a)
        x -= (a + x * (da + x * (c2 + x * c3))) / (da + x * (2.0 * c2 + x * 3.0 * c3))
    x = min(max(x, 0.0), 1.0)
    time, here = left.time + x * width, left
    for _ in range(MOST_DIPS):
        now = after(p, arc, lapse_of(p, time))
        here = knot(p, arc, level.constant, level.of_angle, time, now)
        if here.w < -doubt or lasts(here, doubt):
            break
        time = min(max(time - here.dw / (here.w + here.f), left.time), right.time)
    return here


@njit(**INNER)
def at_cut(level, time, growing, shrinking, turned):
    """The knot at the beginning (``turned`` = -1) or end (1) of a convex stretch, from c+ e^t and c- e^-t."""
    angle, rate = growing + shrinking + level.place, growing - shrinking + turned * level.rate
    return Knot(time, angle, rate, 0.0, -turned * level.bend)


@njit(**INNER)
def stays_clear(p, arc, level, end):
    """Whether w certainly stays positive on (0, end), where it does not fall below zero.

    Most often the order of the stretches alone proves it: that leaves the convex ones which the arc passes from end to end,
    and those in which it begins falling or ends rising.
    """
    start, (cut, convex) = start_knot(p, arc, level), first_stretch(p, arc, level)
    begins_well, ends_well = rises(start.w, start.dw), rises(end.w, -end.dw)
    time = cut + level.concave if convex else cut
    if not (start.w > 0.0 or start.dw > 0.0):
        return False
    if convex and not begins_well:
        return ends_well and end.time <= cut
    if end.time <= time or (ends_well and end.time <= time + level.convex):
        return True
    grow, shrink, error = exponentials(p, arc)
    grow, shrink, error = level.of_angle * grow, level.of_angle * shrink, WIDE * error
    z = math.exp(time)
    per_z = 1.0 / z
    for _ in range(MOST_TURNS):
        growing, shrinking = grow * z, shrink * per_z
        left = at_cut(level, time, growing, shrinking, -1.0)
        doubt = MARGIN * (abs(growing) + abs(shrinking) + 1.0) + error * (z + per_z)
        growing, shrinking = growing * level.growth, shrinking * level.decay
        right = at_cut(level, time, growing, shrinking, 1.0)
        doubt = level.growth * doubt + MARGIN * abs(growing)
        if not (left.w > doubt and right.w > doubt) or may_dip(level, left, right, doubt, doubt):
            return False
        time += p.period
        if end.time <= time or (ends_well and end.time <= time + level.convex):
            return True
        z *= p.turn_growth
        per_z *= p.turn_decay
    return False


@njit(**INNER)
def walk(p, arc, level, end):
    """From turn to turn to the first zero of w, or to the knot ``end``, where w >= 0 (at time infinity: no end).

    A concave stretch that begins with w >= 0 holds one zero if it ends with w < 0, else none; a convex one that begins
    with w > 0, or rising from 0, likewise, but for a dip. Most often their order alone shows that ``end`` is reached. None
    will ever come as soon as what grows outweighs all else.
    """
    before, (cut, convex) = start_knot(p, arc, level), first_stretch(p, arc, level)
    ends_well = rises(end.w, -end.dw)
    # a convex stretch under way in which w rises holds no zero; else it is looked at like a whole one, and so is that of a
    # lift-off, through all of which w rises: from where it ends w is known to be positive, or all is in doubt
    lifts = before.w == 0.0 == before.dw
    under_way = convex and (lifts or not rises(before.w, before.dw))
    time = 0.0 if under_way else cut + level.concave if convex else cut
    length = cut if under_way else level.convex
    if not (before.w > 0.0 or before.dw > 0.0 or (convex and lifts and (end.w > 0.0 or end.time > cut))):
        return Walk(UNSURE, before, before)
    if end.time <= time or (ends_well and end.time <= time + length):
        return Walk(CLEAR, before, end)
    grow, shrink, error = exponentials(p, arc)
    grow, shrink, error = level.of_angle * grow, level.of_angle * shrink, WIDE * error
    least = level.constant + level.of_angle - p.response
    growth, decay = level.growth, level.decay
    z, per_z, left, doubt = 1.0, 1.0, before, MARGIN
    if under_way:
        growth = math.exp(cut)
        decay = 1.0 / growth
    else:
        z = math.exp(time)
        per_z = 1.0 / z
    for k in range(MOST_TURNS):
        if k > 0 or not under_way:
            growing, shrinking = grow * z, shrink * per_z
            left = at_cut(level, time, growing, shrinking, -1.0)
            doubt = MARGIN * (abs(growing) + abs(shrinking) + 1.0) + error * (z + per_z)
            if end.time <= time:
                return Walk(CLEAR, before, end)
            if left.w < -doubt:
                return Walk(ZERO, before, left)
            if not left.w > doubt:
                return Walk(UNSURE, before, left)
        time += length
        z *= growth
        per_z *= decay
        growing, shrinking = grow * z, shrink * per_z
        right = at_cut(level, time, growing, shrinking, 1.0)
        right_doubt = MARGIN * (abs(growing) + abs(shrinking) + 1.0) + error * (z + per_z)
        last = end.time <= time
        if last:
            if ends_well:
                return Walk(CLEAR, left, end)
            right, right_doubt = end, MARGIN
        elif right.w < -right_doubt:
            return Walk(ZERO, left, right)
        elif not right.w > right_doubt:
            return Walk(UNSURE, left, right)
        held = k == 0 and (lifts or (under_way and held_up(p, level, before, cut)))
        if not held and may_dip(level, left, right, doubt, right_doubt):
            middle = bottom(p, arc, level, left, right, right_doubt)
            if middle.w < -right_doubt:
                return Walk(ZERO, left, middle)
            if not lasts(middle, right_doubt):
                return Walk(UNSURE, left, right)
        if last:
            return Walk(CLEAR, left, end)
        if min(growing, growing - abs(shrinking) + least) > right_doubt:
            return Walk(NEVER, left, right)
        before = right
        time += level.concave
        z *= p.turn_growth * level.decay
        per_z *= p.turn_decay * level.growth
        length, growth, decay = level.convex, level.growth, level.decay
    return Walk(UNSURE, left, left)
