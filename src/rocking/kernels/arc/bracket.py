"""The first zero of an arc without braces, bracketed by what is known where its stretches meet.

There (``first_zero`` says what a stretch is) cos eta is known and e^t grows by given factors, so that u and u' need no
elementary function. A bracket holds one zero; whatever is not certain by a wide margin is UNSURE and left
to ``first_zero``.
"""

import math
from typing import NamedTuple

from numba import njit

from rocking.kernels.arc.solution import exponentials, propagate, propagator_of
from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE, SIMD_INLINE
from rocking.kernels.forcing.harmonic import first_sign_change, forcing_rates, forcing_term
from rocking.kernels.numerics.elementary import fma

MAX_TURNS = 64
# Knots of a dip that are looked at.
MAX_DIPS = 4
MARGIN = 1e-11
# In units of the rounding error of c+ and c-.
WIDE = 16.0

# What a walk ends with: a bracket, none for ever, or a doubt; or that it goes on.
ZERO, NEVER, UNSURE, PASSED = range(4)


class Jet(NamedTuple):
    """w at one time, with what gives all its derivatives: w'' = w + f, w''' = w' + df."""

    time: float
    w: float
    dw: float
    f: float
    df: float


class Walk(NamedTuple):
    """How a walk ended; the bracket of ZERO."""

    answer: int
    low: Jet
    high: Jet


@njit(**INTERNAL_INLINE)
def knot(p, arc, constant, s, time, now):
    """The knot of w = constant + s u at an instant; w from its change since the start, so that it is accurate near a brace too."""
    f = forcing_term(p, now.cosine)
    df, _ = forcing_rates(p, now.cosine, now.sine)
    return Jet(time, (constant + s * arc.angle) + s * now.risen, s * now.velocity, s * f - constant, s * df)


@njit(**INTERNAL_INLINE)
def start_knot(p, arc, constant, s):
    """The knot of w = constant + s u at the arc's start."""
    f = forcing_term(p, arc.cosine)
    df, _ = forcing_rates(p, arc.cosine, arc.sine)
    return Jet(0.0, constant + s * arc.angle, s * arc.velocity, s * f - constant, s * df)


@njit(**INTERNAL_INLINE)
def first_interval(p, arc):
    """(when the first stretch ends, whether it is convex)."""
    sign_change, concave = first_sign_change(p, arc.side, arc.psi, 0.0, p.base_half)
    return sign_change, not concave


@njit(**INTERNAL_INLINE)
def positive_ahead(w, dw):
    """Whether w, positive here, stays so as long as f > 0 lasts from here on: it lies above the free motion (w'' = w)."""
    return w + dw >= 0.0


@njit(**INTERNAL_INLINE)
def positive_throughout(here, doubt):
    """Whether w is positive in all of a convex stretch, by one knot in it: it lies above the free motion through that, either way."""
    return here.w - abs(here.dw) > doubt


@njit(**SIMD_INLINE)
def may_dip(w, dw, w_right, dw_right, tanh):
    """Whether w, positive at both ends of a part of a convex stretch, may reach zero within; ``tanh`` of its length.

    It stays clear if the free motions through either end never reach zero, or only after passing each other.
    """
    crossed, enough = fma(w, dw_right, -w_right * dw), tanh * fma(w, w_right, -dw * dw_right)
    return (w + dw < 0.0) & (dw_right > w_right) & ((crossed >= enough) == False)  # noqa: E712


@njit(**INTERNAL_INLINE)
def may_dip_between(p, ends, doubts):
    """``may_dip`` between two knots that are in doubt by so much."""
    (left, right), (left_doubt, right_doubt) = ends, doubts
    tanh = p.base_outside_tanh * (1.0 + MARGIN)
    w, dw = left.w - left_doubt, left.dw - left_doubt
    return may_dip(w, dw, right.w - right_doubt, right.dw + right_doubt, tanh)


@njit(**INTERNAL)
def bottom(p, arc, left, right, doubt):
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
    for _ in range(MAX_DIPS):
        now = propagate(p, arc, propagator_of(p, time))
        here = knot(p, arc, 0.0, 1.0, time, now)
        if here.w < -doubt or positive_throughout(here, doubt):
            break
        time = min(max(time - here.dw / (here.w + here.f), left.time), right.time)
    return here


@njit(**INTERNAL_INLINE)
def at_sign_change(p, time, growing, shrinking, turned):
    """The knot at the beginning (``turned`` = -1) or end (1) of a convex stretch, from c+ e^t and c- e^-t."""
    angle, rate = (
        growing + shrinking + p.sign_change_displacement,
        growing - shrinking + turned * p.sign_change_velocity,
    )
    return Jet(time, angle, rate, 0.0, -turned * p.sign_change_velocity * (1.0 + p.frequency * p.frequency))


@njit(**INTERNAL_INLINE)
def stays_clear(p, arc, end):
    """Whether w certainly stays positive on (0, end), where it does not fall below zero.

    Most often the order of the stretches alone proves it: that leaves the convex ones which the arc passes from end to end,
    and those in which it begins falling or ends rising.
    """
    start, (sign_change, convex) = start_knot(p, arc, 0.0, 1.0), first_interval(p, arc)
    begins_well, ends_well = positive_ahead(start.w, start.dw), positive_ahead(end.w, -end.dw)
    time = sign_change + p.base_inside if convex else sign_change
    if not (start.w > 0.0 or start.dw > 0.0):
        return False
    if convex and not begins_well:
        return ends_well and end.time <= sign_change
    if end.time <= time or (ends_well and end.time <= time + p.base_outside):
        return True
    grow, shrink, error = exponentials(p, arc)
    error *= WIDE
    z = math.exp(time)
    per_z = 1.0 / z
    for _ in range(MAX_TURNS):
        growing, shrinking = grow * z, shrink * per_z
        left = at_sign_change(p, time, growing, shrinking, -1.0)
        doubt = MARGIN * (abs(growing) + abs(shrinking) + 1.0) + error * (z + per_z)
        growing, shrinking = growing * p.base_outside_growth, shrinking * p.base_outside_decay
        right = at_sign_change(p, time, growing, shrinking, 1.0)
        doubt = p.base_outside_growth * doubt + MARGIN * abs(growing)
        if not (left.w > doubt and right.w > doubt) or may_dip_between(p, (left, right), (doubt, doubt)):
            return False
        time += p.period
        if end.time <= time or (ends_well and end.time <= time + p.base_outside):
            return True
        z *= p.turn_growth
        per_z *= p.turn_decay
    return False


class CutKnot(NamedTuple):
    """A knot, c+ e^t and c- e^-t there, and how much is in doubt of it."""

    jet: Jet
    growing: float
    shrinking: float
    doubt: float


@njit(**INTERNAL_INLINE)
def cut_knot(p, arc_exponentials, time, z, per_z, turned):
    """Return the ``CutKnot`` at a time, e^t = z, as ``at_sign_change`` gives the knot."""
    grow, shrink, error = arc_exponentials
    growing, shrinking = grow * z, shrink * per_z
    doubt = MARGIN * (abs(growing) + abs(shrinking) + 1.0) + (WIDE * error) * (z + per_z)
    return CutKnot(at_sign_change(p, time, growing, shrinking, turned), growing, shrinking, doubt)


@njit(**INTERNAL_INLINE)
def cross(p, arc, start, end, lifts):
    """Return how the walk across a convex stretch between two knots ends: PASSED where no zero is there.

    ``lifts`` says that u rises through all of it.
    """
    left, right, doubt = start.jet, end.jet, end.doubt
    if right.w < -doubt:
        return Walk(ZERO, left, right)
    if not right.w > doubt:
        return Walk(UNSURE, left, right)
    if not lifts and may_dip_between(p, (left, right), (start.doubt, doubt)):
        middle = bottom(p, arc, left, right, doubt)
        if middle.w < -doubt:
            return Walk(ZERO, left, middle)
        if not positive_throughout(middle, doubt):
            return Walk(UNSURE, left, right)
    return Walk(PASSED, left, right)


@njit(**INTERNAL_INLINE)
def bracket_first_zero(p, arc):
    """Walk from turn to turn to the first zero of u.

    A concave stretch that begins with u >= 0 holds one zero if it ends with u < 0, else none; a convex one that begins
    with u > 0, or rising from 0, likewise, but for a dip. None will ever come as soon as what grows outweighs all else.
    """
    before, (sign_change, convex) = start_knot(p, arc, 0.0, 1.0), first_interval(p, arc)
    # a convex stretch under way in which u rises holds no zero; else it is looked at like a whole one, and so is that of a
    # lift-off, through all of which u rises: from where it ends u is known to be positive, or all is in doubt
    lifts = before.w == 0.0 == before.dw
    if not (before.w > 0.0 or before.dw > 0.0 or (convex and lifts)):
        return Walk(UNSURE, before, before)
    under_way = convex and (lifts or not positive_ahead(before.w, before.dw))
    time = 0.0 if under_way else sign_change + p.base_inside if convex else sign_change
    # how long the stretch is, and e^+-length
    interval = p.base_outside, p.base_outside_growth, p.base_outside_decay
    z, per_z, left, c = 1.0, 1.0, CutKnot(before, 0.0, 0.0, MARGIN), exponentials(p, arc)
    if under_way:
        growth = math.exp(sign_change)
        interval = sign_change, growth, 1.0 / growth
    else:
        z = math.exp(time)
        per_z = 1.0 / z
    for k in range(MAX_TURNS):
        if k > 0 or not under_way:
            left = cut_knot(p, c, time, z, per_z, -1.0)
            if left.jet.w < -left.doubt:
                return Walk(ZERO, before, left.jet)
            if not left.jet.w > left.doubt:
                return Walk(UNSURE, before, left.jet)
        time += interval[0]
        z *= interval[1]
        per_z *= interval[2]
        right = cut_knot(p, c, time, z, per_z, 1.0)
        end = cross(p, arc, left, right, k == 0 and lifts)
        if end.answer != PASSED:
            return end
        if min(right.growing, right.growing - abs(right.shrinking) + (1.0 - p.response)) > right.doubt:
            return Walk(NEVER, left.jet, right.jet)
        before = right.jet
        time += p.base_inside
        z *= p.turn_growth * p.base_outside_decay
        per_z *= p.turn_decay * p.base_outside_growth
        interval = p.base_outside, p.base_outside_growth, p.base_outside_decay
    return Walk(UNSURE, left.jet, left.jet)
