"""Certified first event of an arc, at a fraction of the cost of ``first_zero``.

A steady motion repeats its arcs. So an earlier arc predicts the time of the next zero, and the ``Propagator``
of that time is available. From there a Taylor series reaches the zero. If the zero is further away, the
series gives a guess, and one new evaluation follows. It is the *first* zero if no sign interval before it
contains one; in most cases the order of the intervals proves that. If the guess is not good enough,
``bracket`` brackets the zero and provides another.

Between braces arcs are short. The series about their start predicts the event, and the cubic with the same
ends proves that nothing is met before. Results that are not certain by a wide margin are left to
``first_zero``.
"""

import math

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.arc import MAX_ARC_TIME, Instant
from rocking.kernels.forcing.drives import HarmonicDrive
from rocking.kernels.forcing.harmonic.acceleration import forcing_rates, forcing_term
from rocking.kernels.forcing.harmonic.bracket import (
    UNSURE,
    ZERO,
    Jet,
    bracket_first_zero,
    knot,
    start_knot,
    stays_clear,
)
from rocking.kernels.forcing.harmonic.enclosure import stays_between
from rocking.kernels.forcing.harmonic.first_zero import corrected_step, step_to_zero
from rocking.kernels.forcing.harmonic.solution import propagate, propagator_of
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.taylor import series, velocity_after

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


@njit(**INTERNAL_INLINE)
def taylor_step(p, now, step):
    """Advance an instant by a small step with its Taylor series, from the derivatives that u'' = u + f gives.

    The fields of the angle are 0: the caller sets the angle.
    """
    f = forcing_term(p, now.drive.cosine)
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


@njit(**INTERNAL_INLINE)
def close(p, now):
    """Return whether the zero of w is so near that one step of the series reaches it."""
    w, v = abs(now.w), -now.dw
    bend, twist = w * abs(now.w + now.f), w * w * abs(now.dw + now.df)
    return (
        w * max(1.0, p.forcing.frequency) < SMALL * v
        and bend < SMALL * v * v
        and twist < SMALL * SMALL * v * v * v
    )


@njit(**INTERNAL_INLINE)
def parabola_step(now):
    """Return a step towards a more distant zero of w: to the zero of the parabola, or infinity if there is none."""
    fall = now.w + now.f
    under = fma(now.dw, now.dw, -2.0 * now.w * fall)
    if fall < 0.0 and under > 0.0:
        return (now.dw + math.sqrt(under)) / -fall
    return -now.w / now.dw if now.dw < 0.0 else math.inf


@njit(**INTERNAL_INLINE)
def turned(p, steady, now):
    """Return f'' at a jet, where f is the sum of -steady and a part that oscillates with the forcing."""
    return -p.forcing.frequency * p.forcing.frequency * (now.f + steady)


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL_INLINE)
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
