"""Certified first event of an arc under a cosine, at a fraction of the cost of ``first_zero_cosine``.

A steady motion repeats its arcs. So an earlier arc predicts the time of the next zero, and the ``Propagator``
of that time is available. From there a Taylor series reaches the zero. If the zero is further away, the
series gives a guess, and one new evaluation follows. It is the *first* zero if no sign interval before it
contains one; in most cases the order of the intervals proves that.

If the guess is not good enough, the zero is bracketed from u and u' at the sign changes of the forcing term
(``first_zero_cosine`` defines the sign intervals). There cos eta is known and e^t grows by known factors, so that
u and u' need no elementary function. A bracket contains one zero.

Between braces arcs are short. The series about their start predicts the event, and the cubic with the same
ends proves that nothing is met before. Results that are not certain by a wide margin are UNSURE and left to
``first_zero_cosine``.
"""

import math
from typing import NamedTuple

from rocking.kernels.arc.arc import MAX_ARC_TIME, Instant
from rocking.kernels.arc.slender_cosine import exponentials, propagate, propagator_of
from rocking.kernels.base.cosine import HarmonicDrive, first_sign_change, forcing_rates, harmonic_term
from rocking.kernels.library.kernel import kernel
from rocking.kernels.numerics.elementary import both_exponentials, fma
from rocking.kernels.numerics.taylor import reversion, series, velocity_after


@kernel(inline=True)
def corrected_step(w, dw, forcing):
    """Return Newton's step y, and the factor of ``taylor.reversion`` that corrects it."""
    f, df, ddf = forcing
    second, per = w + f, 1.0 / dw
    y = -w * per
    return y, reversion(y, second, dw + df, second + ddf, per)


@kernel(inline=True)
def step_to_zero(w, dw, forcing):
    """Return a step towards the zero of w; far from the zero it is Newton's step."""
    y, correction = corrected_step(w, dw, forcing)
    return y * correction if 0.5 < correction < 2.0 else y


@kernel(inline=True)
def grazes(amplitude, start_angle, start_velocity, t, velocity):
    """Return whether an arc arrives after a time t so slowly that rounding decides whether it arrives at all."""
    most = amplitude + 1.0
    return velocity * velocity <= MARGIN * most * fma(t, fma(t, most, abs(start_velocity)), start_angle)


@kernel(inline=True)
def outweighs(first, last, off):
    """Return whether the inner Bernstein terms of a cubic exceed its error bound everywhere between the ends.

    For every s in (0, 1): first s (1 - s)^2 + last s^2 (1 - s) > off s^2 (1 - s)^2.
    """
    least = min(first, last)
    return (least > 0.0) & (first + last + 2.0 * least > off)


@kernel(inline=True)
def stays_between(system, t, first, last):
    """Return whether an arc certainly meets neither base nor brace within a time t, from (u, u') at its ends.

    ``system`` is (A, Omega, brace angle).

    Between the ends u lies within t^4 s^2 (1 - s)^2 max|u''''|/24 of the cubic with the same end values and
    slopes. The Bernstein coefficients of this cubic show on which side of base and brace it stays. The fourth
    derivative is u'''' = u - 1 + A (Omega^2 - 1) cos eta. |u - 1| never exceeds the largest of A, 1 and its
    values at the ends, because u'' = u - 1 - A cos eta.
    """
    amplitude, frequency, brace_angle = system
    (angle, velocity), (end, arrival) = first, last
    left, right, square = t * velocity, t * arrival, t * t
    most = max(amplitude, 1.0, max(angle, end) - 1.0)
    most += amplitude * abs(fma(frequency, frequency, -1.0))
    off = (1.0 + MARGIN) / 24.0 * square * square * most + MARGIN * t
    to_brace, end_to_brace = brace_angle - angle, brace_angle - end
    above = outweighs(fma(3.0, angle, left), fma(3.0, end, -right), off)
    below = outweighs(fma(3.0, to_brace, -left), fma(3.0, end_to_brace, right), off)
    return above & below & (end >= 0.0) & (end_to_brace >= 0.0)


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


@kernel(inline=True)
def knot(p, arc, constant, s, time, now):
    """Return the jet of w = constant + s u at an instant.

    w is computed from its change since the start, so that it is accurate near a brace too.
    """
    f = harmonic_term(p, now.drive.cosine)
    df, _ = forcing_rates(p, now.drive.cosine, now.drive.sine)
    return Jet(time, (constant + s * arc.angle) + s * now.risen, s * now.velocity, s * f - constant, s * df)


@kernel(inline=True)
def start_knot(p, arc, constant, s):
    """Return the jet of w = constant + s u at the start of the arc."""
    f = harmonic_term(p, arc.drive.cosine)
    df, _ = forcing_rates(p, arc.drive.cosine, arc.drive.sine)
    return Jet(0.0, constant + s * arc.angle, s * arc.velocity, s * f - constant, s * df)


@kernel(inline=True)
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


@kernel(inline=True)
def positive_ahead(w, dw):
    """Return whether w, positive here, stays positive for as long as f > 0.

    Then w lies above the free motion (w'' = w) from the same state.
    """
    return w + dw >= 0.0


@kernel(inline=True)
def positive_throughout(here, doubt):
    """Return whether one jet proves that w is positive on its whole convex sign interval.

    In both directions of time w lies above the free motion through that jet.
    """
    return here.w - abs(here.dw) > doubt


@kernel(inline=True)
def may_dip(w, dw, w_right, dw_right, tanh):
    """Return whether w, positive at both ends of a convex part of an arc, may reach zero inside.

    ``tanh`` is that of the length of the part. w stays positive if the free motions through both ends never
    reach zero, or reach it only after they have crossed.
    """
    crossed, enough = fma(w, dw_right, -w_right * dw), tanh * fma(w, w_right, -dw * dw_right)
    return (w + dw < 0.0) & (dw_right > w_right) & ((crossed >= enough) == False)  # noqa: E712


@kernel(inline=True)
def may_dip_between(p, ends, doubts):
    """Return ``may_dip`` between two jets with the given error bounds."""
    (left, right), (left_doubt, right_doubt) = ends, doubts
    tanh = p.forcing.base_outside_tanh * (1.0 + MARGIN)
    w, dw = left.w - left_doubt, left.dw - left_doubt
    return may_dip(w, dw, right.w - right_doubt, right.dw + right_doubt, tanh)


@kernel(seldom=True)
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


@kernel(inline=True)
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


@kernel(inline=True)
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
    z, per_z = both_exponentials(time)
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


@kernel(inline=True)
def cut_knot(p, arc_exponentials, time, z, per_z, turned):
    """Return the ``CutKnot`` at a sign change, where e^t = z."""
    grow, shrink, error = arc_exponentials
    growing, shrinking = grow * z, shrink * per_z
    doubt = MARGIN * (abs(growing) + abs(shrinking) + 1.0) + (WIDE * error) * (z + per_z)
    return CutKnot(at_sign_change(p, time, growing, shrinking, turned), growing, shrinking, doubt)


@kernel(inline=True)
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


@kernel(inline=True)
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
        growth, decay = both_exponentials(sign_change)
        interval = sign_change, growth, decay
    else:
        z, per_z = both_exponentials(time)
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


TRIES = 6
# Maximum number of expansion points of the series on the way to an event.
LOOKS = 8
NOWHERE = Instant(0.0, 0.0, 0.0, HarmonicDrive(0.0, 0.0), 0.0, 0.0)
# Steps below this need no further correction: the reverted series and the Taylor series after it are exact to
# rounding. The units are 1/max(1, Omega), w'/w'' and the root of w'/w'''.
SMALL = 2e-4
# A longer step is refined if it is shorter than REACH, in units of 1/max(1, Omega), in at most ROUNDS rounds.
# Below BEND one more round has no effect.
REACH, ROUNDS, BEND = 1.8, 3, 0.25
# Below this length, and below BEND, a step needs no refinement.
NEAR = 0.25


@kernel(inline=True)
def taylor_step(p, now, step):
    """Advance an instant by a small step with its Taylor series, from the derivatives that u'' = u + f gives.

    The fields of the angle are 0: the caller sets the angle.
    """
    f = harmonic_term(p, now.drive.cosine)
    df, ddf = forcing_rates(p, now.drive.cosine, now.drive.sine)
    second = now.angle + f
    third = now.velocity + df
    fourth = second + ddf
    fifth = fma(-p.forcing.frequency * p.forcing.frequency, df, third)
    velocity = velocity_after((now.velocity, second, third, fourth, fifth), step)
    x = p.forcing.frequency * step
    q, z = x * x, step * step
    sin_x = x * fma(-q, fma(-q, 1.0 / 120.0, 1.0 / 6.0), 1.0)
    versine = q * fma(-q, 1.0 / 24.0, 0.5)
    cosine = now.drive.cosine - fma(now.drive.cosine, versine, now.drive.sine * sin_x)
    sine = now.drive.sine - fma(now.drive.sine, versine, -now.drive.cosine * sin_x)
    h = step * fma(z, 1.0 / 6.0, 1.0)
    v = z * fma(z, 1.0 / 24.0, 0.5)
    sinh = now.sinh + fma(now.sinh, v, fma(now.versinh, h, h))
    versinh = now.versinh + fma(now.versinh, v, fma(now.sinh, h, v))
    return Instant(0.0, 0.0, velocity, HarmonicDrive(cosine, sine), sinh, versinh)


@kernel(inline=True)
def close(p, now):
    """Return whether the zero of w is so near that one step of the series reaches it."""
    w, v = abs(now.w), -now.dw
    bend, twist = w * abs(now.w + now.f), w * w * abs(now.dw + now.df)
    return (
        w * max(1.0, p.forcing.frequency) < SMALL * v
        and bend < SMALL * v * v
        and twist < SMALL * SMALL * v * v * v
    )


@kernel(inline=True)
def parabola_step(now):
    """Return a step towards a more distant zero of w: to the zero of the parabola, or infinity if there is none."""
    fall = now.w + now.f
    under = fma(now.dw, now.dw, -2.0 * now.w * fall)
    if fall < 0.0 and under > 0.0:
        return (now.dw + math.sqrt(under)) / -fall
    return -now.w / now.dw if now.dw < 0.0 else math.inf


@kernel(inline=True)
def turned(p, steady, now):
    """Return f'' at a jet, where f is the sum of -steady and a part that oscillates with the forcing."""
    return -p.forcing.frequency * p.forcing.frequency * (now.f + steady)


@kernel(inline=True)
def polished(p, steady, now, rough):
    """Refine a rough step to the zero of w by the Taylor series about ``now``, without new elementary functions.

    c_k are the derivatives of w there, w_k those at the end of the step.

    Returns
    -------
    tuple of (bool, float)
        Whether w falls at the end of the step.
        The step.
    """
    square = -p.forcing.frequency * p.forcing.frequency
    df, ddf = now.df, turned(p, steady, now)
    c0, c1 = now.w, now.dw
    c2, c3 = c0 + now.f, c1 + df
    c4, c5 = c2 + ddf, fma(square, df, c3)
    c6, c7 = fma(square, ddf, c4), fma(square * square, df, c5)
    c8 = fma(square * square, ddf, c6)
    c, s = (c0, c1, c2, c3, c4, c5, c6, c7, c8), rough
    for _ in range(ROUNDS):
        w0, w1, w2, w3, w4 = series(c, s)
        if not w1 < 0.0:
            return False, rough
        s += step_to_zero(w0, w1, (w2 - w0, w3 - w1, w4 - w2))
        if abs(w0 * w2) < BEND * w1 * w1:
            break
    return True, s


@kernel(inline=True)
def taylor_zero(p, steady, here):
    """Predict the zero of w from the Taylor series about a jet.

    Returns
    -------
    tuple of (bool, float)
        Whether the series is valid as far as the zero.
        The step to the zero.
    """
    scale, rough = max(1.0, p.forcing.frequency), math.inf
    if abs(here.w * (here.w + here.f)) < BEND * here.dw * here.dw and here.dw < 0.0:
        rough = step_to_zero(here.w, here.dw, (here.f, here.df, turned(p, steady, here)))
        if scale * abs(rough) < NEAR:
            return True, rough
    else:
        rough = parabola_step(here)
    if scale * abs(rough) <= REACH:
        return True, polished(p, steady, here, rough)[1]
    return False, rough


@kernel(inline=True)
def refine_prediction(p, arc, constant, s, propagator, low, high):
    """Refine a zero of w = constant + s u between two times, starting from a propagator close to it.

    Returns
    -------
    tuple of (bool, float, Instant, Propagator)
        Whether the zero was reached.
        Its time and the state there.
        A propagator close to it.
    """
    now = propagate(p, arc, propagator)
    for _ in range(TRIES):
        here = knot(p, arc, constant, s, propagator.time, now)
        if close(p, here):
            y, correction = corrected_step(here.w, here.dw, (here.f, here.df, turned(p, constant + s, here)))
            step = y * correction
            t = propagator.time + step
            return low < t < high, t, taylor_step(p, now, step), propagator
        valid, step = taylor_zero(p, constant + s, here)
        t = propagator.time + step
        if not (valid and low < t < high):
            break
        propagator = propagator_of(p, t)
        now = propagate(p, arc, propagator)
    return False, propagator.time, now, propagator


@kernel(inline=True)
def seek_in(p, arc, bracket):
    """Refine the zero of u in a bracket with ``refine_prediction``.

    The search starts at the zero that the series about the nearer end predicts, or in the middle.
    """
    low, high = bracket.low, bracket.high
    valid, step = taylor_zero(p, 1.0, low)
    t = low.time + step
    if not (valid and low.time < t < high.time):
        valid, step = taylor_zero(p, 1.0, high)
        t = high.time + step
        if not (valid and low.time < t < high.time):
            t = 0.5 * (low.time + high.time)
    return refine_prediction(p, arc, 0.0, 1.0, propagator_of(p, t), low.time, min(high.time, MAX_ARC_TIME))


@kernel(inline=True)
def fast_first_impact(p, arc, guess):
    """Find the first event of an arc without braces.

    The search starts from the propagator ``guess`` if that leads to an impact that is certainly the first,
    else from ``bracket_first_zero``.

    Returns
    -------
    tuple of (int, float, Instant, Propagator)
        ZERO, NEVER or UNSURE.
        Time of the event and the state there.
        A propagator close to it.
    """
    if guess.time > 0.0:
        reached, t, now, propagator = refine_prediction(p, arc, 0.0, 1.0, guess, 0.0, MAX_ARC_TIME)
        if reached and stays_clear(p, arc, Jet(t, 0.0, now.velocity, 0.0, 0.0)):
            return ZERO, t, now, propagator
    bracket = bracket_first_zero(p, arc)
    reached, t, now, propagator = seek_in(p, arc, bracket)
    return (bracket.answer if bracket.answer != ZERO or reached else UNSURE), t, now, propagator


@kernel(inline=True)
def predict_next_event(p, base, brace):
    """Predict the next event from the Taylor series at an instant.

    Returns
    -------
    tuple of (bool, bool, float)
        Whether an event is predicted.
        Whether it is at a brace.
        The step to the event, or the validity radius of the series if none is predicted.
    """
    to_base, to_brace = parabola_step(base), parabola_step(brace)
    at_brace = to_brace < to_base
    here, rough = (brace, to_brace) if at_brace else (base, to_base)
    farthest = REACH / max(1.0, p.forcing.frequency)
    rough = min(rough, farthest)
    valid, step = polished(p, p.block.brace_angle - 1.0 if at_brace else 1.0, here, rough)
    valid = valid and 0.0 < step <= farthest
    return valid, at_brace, step if valid else rough


@kernel(inline=True)
def fast_first_event(p, arc):
    """Find the first event of an arc between braces.

    The guess comes from the start of the arc, because in chaotic motion an earlier arc is seldom similar. If
    the series predicts no event, it is expanded again further on. If that point lies beyond an event, the
    event is sought from there. A step that is not certain is tried again with half its length.

    Returns
    -------
    tuple of (int, bool, float, Instant)
        ZERO or UNSURE.
        Whether the event is at a brace.
        Time of the event and the state there.
    """
    system = p.forcing.amplitude, p.forcing.frequency, p.block.brace_angle
    base, brace = start_knot(p, arc, 0.0, 1.0), start_knot(p, arc, p.block.brace_angle, -1.0)
    valid, at_brace, step = predict_next_event(p, base, brace)
    for _ in range(LOOKS):
        propagator = propagator_of(p, base.time + step)
        now = propagate(p, arc, propagator)
        if not valid:
            if stays_between(system, step, (base.w, base.dw), (now.angle, now.velocity)):
                base, brace = (
                    knot(p, arc, 0.0, 1.0, propagator.time, now),
                    knot(p, arc, p.block.brace_angle, -1.0, propagator.time, now),
                )
                valid, at_brace, step = predict_next_event(p, base, brace)
                continue
            at_brace = now.angle > p.block.brace_angle
            valid = at_brace or now.angle < 0.0
        if valid:
            place, s = (p.block.brace_angle, -1.0) if at_brace else (0.0, 1.0)
            reached, t, now, _ = refine_prediction(p, arc, place, s, propagator, base.time, MAX_ARC_TIME)
            if reached and stays_between(system, t - base.time, (base.w, base.dw), (place, now.velocity)):
                return ZERO, at_brace, t, now
        valid, step = False, 0.5 * step
    return UNSURE, False, 0.0, NOWHERE
