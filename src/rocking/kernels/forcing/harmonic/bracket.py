"""Bracket of the first zero of an arc without braces, from u and u' at the sign changes of the forcing term.

At a sign change (``first_zero`` defines the sign intervals) cos eta is known and e^t grows by known factors.
So u and u' need no elementary function there. A bracket contains one zero. If the result is not certain by a
wide margin, it is UNSURE and ``first_zero`` decides.
"""

import math
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL_INLINE, SELDOM
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.harmonic.acceleration import first_sign_change, forcing_rates, forcing_term
from rocking.kernels.forcing.harmonic.solution import exponentials, propagate, propagator_of
from rocking.kernels.numerics.elementary import fma

MAX_TURNS = 64
# Maximum number of trial points at a local minimum.
MAX_DIPS = 4
MARGIN = 1e-11
# Safety factor on the rounding error of c+ and c-.
WIDE = 16.0

# Result of the search: a bracket, proof that no zero follows, uncertainty, or no zero in this sign interval.
ZERO, NEVER, UNSURE, PASSED = range(4)


class Jet(NamedTuple):
    """w at one time, with all its derivatives: w'' = w + f, w''' = w' + df."""

    time: float
    w: float
    dw: float
    f: float
    df: float


class Walk(NamedTuple):
    """Result of the search along the sign intervals; for ZERO with the bracket."""

    answer: int
    low: Jet
    high: Jet


@njit(**INTERNAL_INLINE)
def knot(p, arc, constant, s, time, now):
    """Return the jet of w = constant + s u at an instant.

    w is computed from its change since the start, so that it is accurate near a brace too.
    """
    f = forcing_term(p, now.drive.cosine)
    df, _ = forcing_rates(p, now.drive.cosine, now.drive.sine)
    return Jet(time, (constant + s * arc.angle) + s * now.risen, s * now.velocity, s * f - constant, s * df)


@njit(**INTERNAL_INLINE)
def start_knot(p, arc, constant, s):
    """Return the jet of w = constant + s u at the start of the arc."""
    f = forcing_term(p, arc.drive.cosine)
    df, _ = forcing_rates(p, arc.drive.cosine, arc.drive.sine)
    return Jet(0.0, constant + s * arc.angle, s * arc.velocity, s * f - constant, s * df)


@njit(**INTERNAL_INLINE)
def first_interval(p, arc):
    """Return the first sign interval of an arc.

    Returns
    -------
    tuple of (float, bool)
        Time at which it ends.
        Whether it is convex.
    """
    sign_change, concave = first_sign_change(p, arc.side, arc.constants.psi, 0.0, p.forcing.base_half)
    return sign_change, not concave


@njit(**INTERNAL_INLINE)
def positive_ahead(w, dw):
    """Return whether w, positive here, stays positive for as long as f > 0.

    Then w lies above the free motion (w'' = w) from the same state.
    """
    return w + dw >= 0.0


@njit(**INTERNAL_INLINE)
def positive_throughout(here, doubt):
    """Return whether one jet proves that w is positive on its whole convex sign interval.

    In both directions of time w lies above the free motion through that jet.
    """
    return here.w - abs(here.dw) > doubt


@njit(**INTERNAL_INLINE)
def may_dip(w, dw, w_right, dw_right, tanh):
    """Return whether w, positive at both ends of a convex part of an arc, may reach zero inside.

    ``tanh`` is that of the length of the part. w stays positive if the free motions through both ends never
    reach zero, or reach it only after they have crossed.
    """
    crossed, enough = fma(w, dw_right, -w_right * dw), tanh * fma(w, w_right, -dw * dw_right)
    return (w + dw < 0.0) & (dw_right > w_right) & ((crossed >= enough) == False)  # noqa: E712


@njit(**INTERNAL_INLINE)
def may_dip_between(p, ends, doubts):
    """Return ``may_dip`` between two jets with the given error bounds."""
    (left, right), (left_doubt, right_doubt) = ends, doubts
    tanh = p.forcing.base_outside_tanh * (1.0 + MARGIN)
    w, dw = left.w - left_doubt, left.dw - left_doubt
    return may_dip(w, dw, right.w - right_doubt, right.dw + right_doubt, tanh)


@njit(**SELDOM)
def bottom(p, arc, left, right, doubt):
    """Find the minimum of w between two jets, as far as needed to decide whether w reaches zero.

    The first trial is the zero of the slope, taken as a cubic through its values and derivatives at both
    ends. Newton's method follows. Returns a jet that decides, or the last one after MAX_DIPS trials.
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
    """Return the jet at one end of a convex sign interval, from c+ e^t and c- e^-t.

    ``turned`` is -1 at its start and 1 at its end.
    """
    angle, rate = (
        growing + shrinking + p.forcing.sign_change_displacement,
        growing - shrinking + turned * p.forcing.sign_change_velocity,
    )
    return Jet(
        time,
        angle,
        rate,
        0.0,
        -turned * p.forcing.sign_change_velocity * (1.0 + p.forcing.frequency * p.forcing.frequency),
    )


@njit(**INTERNAL_INLINE)
def stays_clear(p, arc, end):
    """Return whether w certainly stays positive on (0, end), where ``end`` is a jet with w >= 0.

    In most cases the order of the sign intervals is sufficient proof. Otherwise some convex intervals need a
    check: those that the arc crosses completely, and those in which it starts falling or ends rising.
    """
    start, (sign_change, convex) = start_knot(p, arc, 0.0, 1.0), first_interval(p, arc)
    begins_well, ends_well = positive_ahead(start.w, start.dw), positive_ahead(end.w, -end.dw)
    time = sign_change + p.forcing.base_inside if convex else sign_change
    if not (start.w > 0.0 or start.dw > 0.0):
        return False
    if convex and not begins_well:
        return ends_well and end.time <= sign_change
    if end.time <= time or (ends_well and end.time <= time + p.forcing.base_outside):
        return True
    grow, shrink, error = exponentials(p, arc)
    error *= WIDE
    z = math.exp(time)
    per_z = 1.0 / z
    for _ in range(MAX_TURNS):
        growing, shrinking = grow * z, shrink * per_z
        left = at_sign_change(p, time, growing, shrinking, -1.0)
        doubt = MARGIN * (abs(growing) + abs(shrinking) + 1.0) + error * (z + per_z)
        growing, shrinking = growing * p.forcing.base_outside_growth, shrinking * p.forcing.base_outside_decay
        right = at_sign_change(p, time, growing, shrinking, 1.0)
        doubt = p.forcing.base_outside_growth * doubt + MARGIN * abs(growing)
        if not (left.w > doubt and right.w > doubt) or may_dip_between(p, (left, right), (doubt, doubt)):
            return False
        time += p.forcing.period
        if end.time <= time or (ends_well and end.time <= time + p.forcing.base_outside):
            return True
        z *= p.forcing.turn_growth
        per_z *= p.forcing.turn_decay
    return False


class CutKnot(NamedTuple):
    """Jet at a sign change, with c+ e^t and c- e^-t there, and an error bound."""

    jet: Jet
    growing: float
    shrinking: float
    doubt: float


@njit(**INTERNAL_INLINE)
def cut_knot(p, arc_exponentials, time, z, per_z, turned):
    """Return the ``CutKnot`` at a sign change, where e^t = z."""
    grow, shrink, error = arc_exponentials
    growing, shrinking = grow * z, shrink * per_z
    doubt = MARGIN * (abs(growing) + abs(shrinking) + 1.0) + (WIDE * error) * (z + per_z)
    return CutKnot(at_sign_change(p, time, growing, shrinking, turned), growing, shrinking, doubt)


@njit(**INTERNAL_INLINE)
def cross(p, arc, start, end, lifts):
    """Search a convex sign interval between two jets; PASSED if it contains no zero.

    ``lifts`` says that u rises through the whole interval.
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
    """Search for the first zero of u, one forcing period after another.

    A concave sign interval that begins with u >= 0 contains one zero if it ends with u < 0, else none. The
    same holds for a convex interval that begins with u > 0, or rising from 0, unless it contains a minimum
    below zero. No zero follows as soon as the growing exponential outweighs all other terms.
    """
    before, (sign_change, convex) = start_knot(p, arc, 0.0, 1.0), first_interval(p, arc)
    # A convex sign interval in which the arc starts and u rises contains no zero. Otherwise it is examined
    # like a complete interval. So is the interval of a lift-off, through which u rises: at its end u is
    # positive, or the result is UNSURE.
    lifts = before.w == 0.0 == before.dw
    if not (before.w > 0.0 or before.dw > 0.0 or (convex and lifts)):
        return Walk(UNSURE, before, before)
    under_way = convex and (lifts or not positive_ahead(before.w, before.dw))
    time = 0.0 if under_way else sign_change + p.forcing.base_inside if convex else sign_change
    # length of the interval, and e^+-length
    interval = p.forcing.base_outside, p.forcing.base_outside_growth, p.forcing.base_outside_decay
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
        if (
            min(right.growing, right.growing - abs(right.shrinking) + (1.0 - p.forcing.response))
            > right.doubt
        ):
            return Walk(NEVER, left.jet, right.jet)
        before = right.jet
        time += p.forcing.base_inside
        z *= p.forcing.turn_growth * p.forcing.base_outside_decay
        per_z *= p.forcing.turn_decay * p.forcing.base_outside_growth
        interval = p.forcing.base_outside, p.forcing.base_outside_growth, p.forcing.base_outside_decay
    return Walk(UNSURE, left.jet, left.jet)
