"""Certified first zero of an arc of the slender block under a cosine: which event comes first, and when.

``first_zero_samples`` is the same for samples, and ``first_zero_full`` for the full block. In flight ``fast_search_cosine`` comes first;
what it cannot prove by a wide margin is decided here.

The event function is w = constant + of_angle u + of_velocity u'. There are three:

* the base, w = u;
* a brace, w = brace_angle - u;
* an extremum of the angle, w = +-u'.

It obeys w'' - w = f_w with f_w = of_angle f + of_velocity f' - constant. A *sign interval* is a part of an
arc on which f_w keeps its sign. There y = w e^t is concave or convex in z = e^2t, because y_zz = f_w e^-3t/4.
Therefore

* a concave interval that starts with w >= 0 contains one zero if it ends with w < 0, else none;
* a convex interval contains one zero if it ends with w < 0;
* else it contains two or none, decided by the sign of w at its minimum, if there is one.

Nothing is sampled, and no zero above rounding can be missed. Sign intervals on which w is too large to reach
zero are skipped together.
"""

import math
from typing import NamedTuple

from rocking.kernels import contract
from rocking.kernels.arc.arc import CROSSING, LATER, MAX_ARC_TIME, NEVER, Next, growth_time
from rocking.kernels.arc.fast_search_cosine import NEVER as NEVER_MORE
from rocking.kernels.arc.fast_search_cosine import (
    ZERO,
    fast_first_event,
    fast_first_impact,
    grazes,
    step_to_zero,
)
from rocking.kernels.arc.slender_cosine import NONE_YET, evaluate, exponentials, propagate, propagator_or_none
from rocking.kernels.base.cosine import (
    Cosine,
    first_sign_change,
    forcing_rates,
    harmonic_term,
    next_sign_change,
)
from rocking.kernels.block.rest import UNKNOWN, held_event
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, NONE
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import exponential, logarithm
from rocking.kernels.system import Slender

ITERATIONS = 200
# After this number of steps every second one is a bisection.
MAX_STEPS = 10


class EventFunction(NamedTuple):
    """Event function whose first zero is sought, with the sign changes of its forcing term."""

    constant: float
    of_angle: float
    of_velocity: float
    centre: float  # sign changes at eta = centre +- half
    half: float
    convex_inside: bool  # f_w > 0 for |eta - centre| < half (everywhere if half is infinite)


@kernel(inline=True)
def base_event_function(p):
    """Return the event function of the base: w = u, f_w = -1 - A cos eta."""
    return EventFunction(0.0, 1.0, 0.0, 0.0, p.forcing.base_half, False)


@kernel(inline=True)
def brace_event_function(p):
    """Return the event function of the brace: w = brace_angle - u, f_w = 1 - brace_angle + A cos eta."""
    return EventFunction(
        p.block.brace_angle,
        -1.0,
        0.0,
        0.0,
        p.forcing.brace_half,
        p.forcing.brace_half < math.inf or p.block.brace_angle < 1.0,
    )


@kernel(inline=True)
def event_values(p, arc, event_function, now):
    """Return w and w' at an instant; w from its change since the start, so that it is accurate near a brace too."""
    acceleration = now.angle + harmonic_term(p, now.drive.cosine)
    at_start = event_function.constant + event_function.of_angle * arc.angle
    return (
        at_start + (event_function.of_angle * now.risen + event_function.of_velocity * now.velocity),
        event_function.of_angle * now.velocity + event_function.of_velocity * acceleration,
    )


@kernel(inline=True)
def event_forcing(p, event_function, now):
    """Return f_w, f_w' and f_w'' at an instant."""
    f = harmonic_term(p, now.drive.cosine)
    df, ddf = forcing_rates(p, now.drive.cosine, now.drive.sine)
    dddf = -p.forcing.frequency * p.forcing.frequency * df
    return (
        event_function.of_angle * f + event_function.of_velocity * df - event_function.constant,
        event_function.of_angle * df + event_function.of_velocity * ddf,
        event_function.of_angle * ddf + event_function.of_velocity * dddf,
    )


@kernel
def refine(p, arc, event_function, low, high, t):
    """Refine the only zero of w in [low, high] from the guess t, with w > 0 just after low and w <= 0 at high.

    Returns
    -------
    tuple of (float, Instant)
        Time of the zero and the state there.
    """
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


@kernel
def time_below_zero(p, arc, event_function, start, end):
    """Return a time in a convex sign interval at which w <= 0, or infinity if w stays positive.

    ``start`` and ``end`` are (time, w, w') at its ends, where w > 0. The minimum of y = w e^t is the zero of
    w + w'. The product (w + w') e^-t only grows, so that one safeguarded Newton iteration finds this zero.
    The sign of w there decides.
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
        # the tangent bounds how much lower the minimum may be
        if abs(ahead - t) <= 1e-9 * (high - left) and w > abs(slope * (ahead - t)):
            return math.inf
        t = ahead
    return math.inf


@kernel(inline=True)
def first_guess(p, event_function, now, w, dw, low, high):
    """Return a first guess of the zero in (low, high), where ``now`` is the state at low.

    For a short arc that starts at w = 0 it is the zero of the parabola, else the middle.
    """
    middle = 0.5 * (low + high)
    f, _, _ = event_forcing(p, event_function, now)
    hop = 2.0 * dw
    return low - hop / f if w == 0.0 and hop > 0.0 and hop < -f * (middle - low) else middle


@kernel
def earliest_possible_zero(p, arc, event_function, t):
    """Return the time until which w certainly stays positive, searched from t on.

    The result is t if nothing is certain, and infinity if w stays positive permanently. w lies within
    ``swing`` of m + a e^t + b e^-t. The result is the earliest time after t at which that curve, lowered by
    its rounding error, falls to ``swing``.
    """
    grow, shrink, error = exponentials(p, arc)
    m = event_function.constant + event_function.of_angle
    a = (event_function.of_angle + event_function.of_velocity) * grow - error
    b = (event_function.of_angle - event_function.of_velocity) * shrink - error
    swing = p.forcing.response * (
        abs(event_function.of_angle) + abs(event_function.of_velocity) * p.forcing.frequency
    )
    m -= swing + 1e-12 * (swing + abs(m))
    z = exponential(t)
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
    return max(t, logarithm(nearest) * (1.0 - 1e-12)) if nearest < math.inf else math.inf


@body(contract.no_return_time, Slender, Cosine)
def no_return_time(p, arc):
    """Return the time from which c+ e^t - |c-| e^-t + 1 - beta > 0 proves that an arc never comes back."""
    grow, shrink, _ = exponentials(p, arc)
    return growth_time(1.0 - p.forcing.response, grow, shrink)


@kernel(inline=True)
def interval_at(p, arc, event_function, t):
    """Return the sign interval that contains the time t.

    Returns
    -------
    tuple of (float, bool)
        Time at which it ends.
        Whether eta lies within ``half`` of the centre of the ``EventFunction``.
    """
    if not event_function.half < math.inf:
        return math.inf, True
    sign_change, inside = first_sign_change(
        p, arc.side, arc.constants.psi, event_function.centre, event_function.half
    )
    while sign_change <= t:
        inside = not inside
        sign_change += next_sign_change(p, event_function.half, inside)
    return sign_change, inside


@kernel
def first_zero(p, arc, event_function, t, limit):
    """Find the first time after t, up to ``limit``, at which w falls through zero, certified.

    w >= 0 at t. If w = w' = 0 at t (lift-off, departure from a brace), the first convex sign interval begins
    there, and w rises through all of it.

    Returns
    -------
    tuple of (int, float, Instant)
        Result, as in ``Found``.
        Time of the zero, or time up to which there is none.
        State at that time.
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
            cycles = math.floor((clear - t) / p.forcing.period) * p.forcing.period
            if cycles > 0.0:
                t += cycles
                sign_change += cycles
                now = evaluate(p, arc, t)
                w, dw = event_values(p, arc, event_function, now)


@kernel(inline=True)
def nothing_more(side):
    """Return that no event follows."""
    return Next(math.inf, NONE, side, 0.0, 0.0, UNKNOWN, 0.0, 0.0)


@body(contract.next_event, Slender, Cosine, inline=True)
def next_event(p, mode, arc, guess):
    """Find the next event, starting from the propagator ``guess`` of the time until it.

    There is no guess between braces. NONE after a finite time only restarts an arc that has grown long.

    Returns
    -------
    tuple of (Next, Propagator)
        The next event.
        The propagator from which to guess the event after the next.
    """
    if mode == FLIGHT and p.forcing.base_half < math.inf:
        at_brace, propagator = False, NONE_YET
        if p.block.brace_angle == math.inf:
            answer, t, now, propagator = fast_first_impact(p, arc, guess)
        else:
            answer, at_brace, t, now = fast_first_event(p, arc)
        if answer == NEVER_MORE:
            return nothing_more(arc.side), guess
        grazing = grazes(p.forcing.amplitude, arc.angle, arc.velocity, t, now.velocity)
        if answer == ZERO and not grazing:
            event, angle = (BRACE, p.block.brace_angle) if at_brace else (IMPACT, 0.0)
            return Next(t, event, arc.side, angle, now.velocity, now.drive, now.sinh, now.versinh), propagator
    coming = any_event(p, mode, arc)
    if mode != FLIGHT or p.block.brace_angle < math.inf:
        return coming, guess
    return coming, propagator_or_none(p, min(coming.wait, MAX_ARC_TIME))


@kernel(seldom=True)
def any_event(p, mode, arc):
    """Find the next event without a guess."""
    if mode != FLIGHT:
        return held_event(p, mode, arc)
    event = IMPACT
    found, t, now = first_zero(p, arc, base_event_function(p), 0.0, MAX_ARC_TIME)
    if found != CROSSING:
        event, t = NONE, MAX_ARC_TIME
    if p.block.brace_angle < math.inf:
        hit, t_hit, now_hit = first_zero(p, arc, brace_event_function(p), 0.0, t)
        if hit == CROSSING:
            event, t, now = BRACE, t_hit, now_hit
    elif found == NEVER:
        return nothing_more(arc.side)
    if event == NONE:
        now = evaluate(p, arc, t)
    return Next(t, event, arc.side, now.angle, now.velocity, now.drive, now.sinh, now.versinh)
