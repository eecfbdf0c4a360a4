"""The certified first crossing of an arc: which event comes first, and exactly when.

What is watched is w = constant + of_angle u + of_velocity u': the base (w = u), a brace (w = brace_angle -
u) or a turn (w = +-u'). Each obeys w'' - w = f_w with f_w = of_angle f + of_velocity f' - constant, and on
a *stretch*, where f_w keeps its sign, y = w e^t is concave or convex in z = e^2t (y_zz = f_w e^-3t/4). So

* a concave stretch that starts with w >= 0 holds one zero if it ends with w < 0, else none;
* a convex one holds one zero if it ends with w < 0; else two or none, decided by the sign of w at the
  bottom of the dip, if there is a dip.

Nothing is sampled and nothing above rounding can be missed. Stretches far above w's possible oscillation
are skipped whole.
"""

import math
from enum import IntEnum
from typing import NamedTuple

from numba import njit

from rocking.kernels.arc.solution import evaluate, exponentials, propagate, propagator_or_none
from rocking.kernels.arc.taylor import reversion
from rocking.kernels.compile_options import INTERNAL, KERNEL, KERNEL_INLINE
from rocking.kernels.forcing.harmonic import first_sign_change, forcing_rates, forcing_term, next_sign_change

# An arc is renewed from its own state after this long: e^32 is where the closed form has used up double
# precision.
MAX_ARC_TIME = 32.0
ITERATIONS = 200
# A zero not reached in so many steps is halved in on as well.
MAX_STEPS = 10


class Found(IntEnum):
    """What a search for a crossing ended with."""

    CROSSING = 0
    NEVER = 1  # proved: no crossing, however long one waits
    LATER = 2  # none up to the limit


CROSSING, NEVER, LATER = (int(found) for found in Found)


class EventFunction(NamedTuple):
    """What is followed to its first zero, and where the sign of its forcing term changes."""

    constant: float
    of_angle: float
    of_velocity: float
    centre: float  # cuts at eta = centre +- half
    half: float
    convex_inside: bool  # f_w > 0 for |eta - centre| < half (everywhere, where half is infinite)


@njit(**KERNEL_INLINE)
def base_event_function(p):
    """The base: w = u, f_w = -1 - A cos eta."""
    return EventFunction(0.0, 1.0, 0.0, 0.0, p.base_half, False)


@njit(**KERNEL_INLINE)
def brace_event_function(p):
    """The brace: w = brace_angle - u, f_w = 1 - brace_angle + A cos eta."""
    return EventFunction(
        p.brace_angle, -1.0, 0.0, 0.0, p.brace_half, p.brace_half < math.inf or p.brace_angle < 1.0
    )


@njit(**KERNEL_INLINE)
def event_values(p, arc, event_function, now):
    """(w, w') at an instant; w from its change since the start, so that it is accurate near a brace too."""
    acceleration = now.angle + forcing_term(p, now.cosine)
    at_start = event_function.constant + event_function.of_angle * arc.angle
    return (
        at_start + (event_function.of_angle * now.risen + event_function.of_velocity * now.velocity),
        event_function.of_angle * now.velocity + event_function.of_velocity * acceleration,
    )


@njit(**KERNEL_INLINE)
def event_forcing(p, event_function, now):
    """(f_w, f_w', f_w'') at an instant."""
    f = forcing_term(p, now.cosine)
    df, ddf = forcing_rates(p, now.cosine, now.sine)
    dddf = -p.frequency * p.frequency * df
    return (
        event_function.of_angle * f + event_function.of_velocity * df - event_function.constant,
        event_function.of_angle * df + event_function.of_velocity * ddf,
        event_function.of_angle * ddf + event_function.of_velocity * dddf,
    )


@njit(**KERNEL_INLINE)
def corrected_step(w, dw, forcing):
    """(y, correction): Newton's step y, times ``taylor.reversion``."""
    f, df, ddf = forcing
    second, per = w + f, 1.0 / dw
    y = -w * per
    return y, reversion(y, second, dw + df, second + ddf, per)


@njit(**KERNEL_INLINE)
def step_to_zero(w, dw, forcing):
    """Return a step towards the zero of w; far away it is Newton's."""
    y, correction = corrected_step(w, dw, forcing)
    # The product must not be fused with a time that it is added to: the last digits of every motion would change.
    return y * correction if 0.5 < correction < 2.0 else y


@njit(**INTERNAL)
def refine(p, arc, event_function, low, high, t):
    """(time, instant) of the one zero in [low, high], w > 0 just after low and w <= 0 at high, from the guess t."""
    now = evaluate(p, arc, t)
    for k in range(ITERATIONS):
        w, dw = event_values(p, arc, event_function, now)
        if w > 0.0:
            low = t
        else:
            high = t
        ahead = t + step_to_zero(w, dw, event_forcing(p, event_function, now))
        stuck = k > MAX_STEPS and k % 2 == 0
        if stuck or not (dw < 0.0 and low <= ahead <= high):
            ahead = 0.5 * (low + high)
        converged = abs(ahead - t) <= 4.0 * 2.0**-53 * ahead
        t = ahead
        now = evaluate(p, arc, t)
        if converged:
            break
    return t, now


@njit(**INTERNAL)
def time_below_zero(p, arc, event_function, start, end):
    """Return a time in a convex stretch at which w <= 0, or infinity where w stays positive.

    ``start`` and ``end`` are (time, w, w') at its ends, where w > 0.
    The bottom of y = w e^t is where w + w' = 0, whose left side times e^-t only grows: one safeguarded
    Newton iteration finds it, and w there decides.
    """
    (left, w, dw), (right, w_right, dw_right) = start, end
    if w + dw >= 0.0 or dw_right - w_right <= 0.0 or dw_right + w_right <= 0.0:
        return math.inf
    low, high = left, right
    t = left - (w + dw) * (right - left) / ((dw_right + w_right) - (w + dw))
    for _ in range(ITERATIONS):
        now = evaluate(p, arc, t)
        w, dw = event_values(p, arc, event_function, now)
        if w <= 0.0:
            return t
        slope = w + dw
        if slope < 0.0:
            low = t
        else:
            high = t
        f, _, _ = event_forcing(p, event_function, now)
        ahead = t - slope / (slope + f)
        if not low <= ahead <= high:
            ahead = 0.5 * (low + high)
        # how much lower the bottom may be is no more than the tangent says
        if abs(ahead - t) <= 1e-9 * (high - left) and w > abs(slope * (ahead - t)):
            return math.inf
        t = ahead
    return math.inf


@njit(**KERNEL_INLINE)
def first_guess(p, event_function, now, w, dw, low, high):
    """Where to begin in (low, high), ``now`` at low: the parabola's return for a hop that starts at w = 0, else the middle."""
    middle = 0.5 * (low + high)
    f, _, _ = event_forcing(p, event_function, now)
    hop = 2.0 * dw
    return low - hop / f if w == 0.0 and hop > 0.0 and hop < -f * (middle - low) else middle


@njit(**INTERNAL)
def earliest_possible_zero(p, arc, event_function, t):
    """How long w certainly stays positive from t on: t where nothing is certain, infinity for ever.

    w lies within ``swing`` of m + a e^t + b e^-t; the earliest time after t at which that curve, lowered by
    its rounding error, comes down to the swing.
    """
    grow, shrink, error = exponentials(p, arc)
    m = event_function.constant + event_function.of_angle
    a = (event_function.of_angle + event_function.of_velocity) * grow - error
    b = (event_function.of_angle - event_function.of_velocity) * shrink - error
    swing = p.response * (abs(event_function.of_angle) + abs(event_function.of_velocity) * p.frequency)
    m -= swing + 1e-12 * (swing + abs(m))
    z = math.exp(t)
    if m + a * z + b / z <= 0.0:
        return t
    discriminant = m * m - 4.0 * a * b
    if discriminant <= 0.0:
        return math.inf
    root = math.sqrt(discriminant)
    q = -0.5 * (m + (root if m > 0.0 else -root))
    first = q / a if a != 0.0 else math.inf
    second = b / q if q != 0.0 else math.inf
    nearest = math.inf
    if first > z:
        nearest = first
    if z < second < nearest:
        nearest = second
    return max(t, math.log(nearest) * (1.0 - 1e-12)) if nearest < math.inf else math.inf


@njit(**INTERNAL)
def no_return_time(p, arc):
    """When an arc that never comes back first proves it: c+ e^t - |c-| e^-t + 1 - beta > 0 from then on."""
    grow, shrink, _ = exponentials(p, arc)
    m = 1.0 - p.response
    b = abs(shrink)
    root = math.sqrt(m * m + 4.0 * grow * b)
    z = 2.0 * b / (m + root) if m > 0.0 else (root - m) / (2.0 * grow)
    return math.log(z) if z > 1.0 else 0.0


@njit(**KERNEL_INLINE)
def interval_at(p, arc, event_function, t):
    """(when the stretch under way at the time t ends, whether it lies inside the window of ``EventFunction``)."""
    if not event_function.half < math.inf:
        return math.inf, True
    sign_change, inside = first_sign_change(p, arc.side, arc.psi, event_function.centre, event_function.half)
    while sign_change <= t:
        inside = not inside
        sign_change += next_sign_change(p, event_function.half, inside)
    return sign_change, inside


@njit(**KERNEL)
def first_zero(p, arc, event_function, t, limit):
    """(Found, time, instant): the first time after t, by ``limit``, at which w falls through zero.

    w >= 0 at t. Where w = w' = 0 at t (lift-off, leaving a brace) the first convex stretch begins there,
    and w rises through all of it.
    """
    now = propagate(p, arc, propagator_or_none(p, t))
    w, dw = event_values(p, arc, event_function, now)
    at_rest = w == 0.0 and dw == 0.0
    sign_change, inside = interval_at(p, arc, event_function, t)
    while True:
        right = min(sign_change, limit)
        then = evaluate(p, arc, right)
        w_right, dw_right = event_values(p, arc, event_function, then)
        low_end = right if w_right < 0.0 else math.inf
        convex = inside == event_function.convex_inside
        if at_rest:
            low_end = math.inf
        elif convex and w_right >= 0.0:
            low_end = time_below_zero(p, arc, event_function, (t, w, dw), (right, w_right, dw_right))
        if low_end < math.inf:
            t, now = refine(
                p, arc, event_function, t, low_end, first_guess(p, event_function, now, w, dw, t, low_end)
            )
            return CROSSING, t, now
        at_rest = at_rest and not convex
        t, w, dw, now = right, w_right, dw_right, then
        clear = earliest_possible_zero(p, arc, event_function, t)
        if clear == math.inf:
            return NEVER, t, then
        if t >= limit:
            return LATER, limit, then
        inside = not inside
        sign_change += next_sign_change(p, event_function.half, inside)
        if clear >= limit:
            return LATER, limit, evaluate(p, arc, limit)
        if clear > sign_change:
            cycles = math.floor((clear - t) / p.period) * p.period
            if cycles > 0.0:
                t += cycles
                sign_change += cycles
                now = evaluate(p, arc, t)
                w, dw = event_values(p, arc, event_function, now)
