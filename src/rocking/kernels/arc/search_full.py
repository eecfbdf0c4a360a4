"""Certified next event of the full block, and its states, perturbations and turns, step by step; proof that it overturns.

With x = |theta| - alpha of a side, and times in units of its rate, x'' = W sin x - sigma a cos x, with the weight W, which is 1 on a base
that moves horizontally. From now on let l <= W <= h, with 0 < l <= 1 <= h, and a_m >= sigma a, where a_m >= 0. If x >= 0,
W sin x >= l sin x. If x0 <= x < 0, W sin x >= l sin x - (h - l) tan|x0| cos x. So with m = a_m + (h - l) tan(max(-x0, 0)),

    x'' >= l sin x - m cos x = r sin(x - beta) for x0 <= x <= pi/2, beta = arctan(m/l), r^2 = l^2 + m^2.

For q = x' + 2 sqrt(r) sin((x - beta)/2), q' >= sqrt(r) cos((x - beta)/2) q. So q >= 0 remains. Then x' > 0 wherever x < beta, so that x
never falls below the lower one of x0 and beta, and the bound holds for ever: the block never returns. If l <= 0, nothing is proved. It
also stays down once it lies flat, at |theta| = pi/2.
"""

import math
from typing import NamedTuple

from rocking.kernels import contract
from rocking.kernels.arc.arc import (
    CROSSING,
    LATER,
    MAX_ARC_TIME,
    NO_EXTREMES,
    UNIT_RATE,
    Arc,
    Drive,
    Instant,
    Next,
    Stretch,
    Transfer,
    with_reached,
)
from rocking.kernels.arc.extrema_full import lying_angle, may_turn_up, peak_in, with_minimum
from rocking.kernels.arc.first_zero_full import first_zero_of_step
from rocking.kernels.arc.full_series import derivative, negative
from rocking.kernels.arc.full_step import cannot_reach_base, state_in, step_from, transfer_in
from rocking.kernels.contract import (
    constants_at,
    drive_after_event,
    drive_later,
    drive_on_clock,
    flat_time,
    growth_of,
    heaviest_ahead,
    largest_ahead,
    lightest_ahead,
    limits_within,
)
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, NONE
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import (
    RIGHT_ANGLE,
    arctangent,
    hypotenuse,
    sine_of,
    tangent_of,
)
from rocking.kernels.system import Full, side_of

# Least mean of du''/du with which perturbations are followed.
SLOWEST_GROWTH = 0.01


@body(contract.never_returns, Full)
def never_returns(p, side, angle, velocity, drive):
    """Provide ``contract.never_returns`` by the bound of the module's text."""
    alpha, own = p.block.critical_angle, side_of(p.block, side)
    if alpha * angle >= RIGHT_ANGLE:
        return True
    x, slope = alpha * (angle - own.ratio), alpha * velocity / own.rate
    # Most blocks are far too slow, whatever the base does. With beta >= 0, r >= 1 and y = -x, 2 sin(y/2) >= y - y^3/24. If r < 1, a
    # proof may come later.
    if x < 0.0 and slope < -x * (1.0 - x * x / 24.0):
        return False
    largest, light, heavy = (
        alpha * largest_ahead(p, side, drive),
        lightest_ahead(p, drive),
        heaviest_ahead(p, drive),
    )
    if light <= 0.0:
        return False
    if heavy > light and x < 0.0:
        largest += (heavy - light) * tangent_of(-x)
    lean = x - arctangent(largest / light)
    return (
        lean > -math.pi and slope + 2.0 * math.sqrt(hypotenuse(light, largest)) * sine_of(0.5 * lean) >= 0.0
    )


@body(contract.arc_at, Full, inline=True)
def arc_at(p, side, cycle, start, angle, velocity):
    """Provide ``contract.arc_at``."""
    drive = drive_on_clock(p, cycle, start)
    return Arc(side, start, angle, velocity, drive, constants_at(p, start, drive))


@body(contract.arc_renewed, Full)
@body(contract.arc_after, Full, inline=True)
def arc_after(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_after`` and ``contract.arc_renewed``."""
    drive = drive_after_event(p, start, coming)
    return Arc(side, start, angle, velocity, drive, constants_at(p, start, drive))


class Place(NamedTuple):
    """Start of a step of an arc: the time since the start of the arc, u, u - u0 and u', and the forcing there."""

    elapsed: float
    angle: float
    risen: float
    velocity: float
    drive: Drive


@body(contract.place_at_start, Full)
def place_at_start(p, arc):
    """Provide ``contract.place_at_start``."""
    return Place(0.0, arc.angle, 0.0, arc.velocity, arc.drive)


@body(contract.evaluate_onward, Full)
def evaluate_onward(p, arc, place, t):
    """Provide ``contract.evaluate_onward``."""
    left = t - place.elapsed
    step = step_from(p, arc.side, place.angle, place.velocity, place.drive)
    while left > step.length and math.isfinite(place.angle):
        rise, velocity = state_in(step, step.length)
        place = Place(
            place.elapsed + step.length,
            place.angle + rise,
            place.risen + rise,
            velocity,
            drive_later(p, place.drive, step.length, step.to_corner),
        )
        left -= step.length
        step = step_from(p, arc.side, place.angle, place.velocity, place.drive)
    rise, velocity = state_in(step, left)
    drive = drive_later(p, place.drive, left, False)
    return Instant(place.angle + rise, place.risen + rise, velocity, drive, 0.0, 0.0), place


@body(contract.evaluate, Full)
def evaluate(p, arc, t):
    """Provide ``contract.evaluate``."""
    return evaluate_onward(p, arc, place_at_start(p, arc), t)[0]


@kernel(inline=True)
def product(later, earlier):
    """Return the transfer over two times, one after the other."""
    return Transfer(
        later.angle_by_angle * earlier.angle_by_angle + later.angle_by_velocity * earlier.velocity_by_angle,
        later.angle_by_angle * earlier.angle_by_velocity
        + later.angle_by_velocity * earlier.velocity_by_velocity,
        later.velocity_by_angle * earlier.angle_by_angle
        + later.velocity_by_velocity * earlier.velocity_by_angle,
        later.velocity_by_angle * earlier.angle_by_velocity
        + later.velocity_by_velocity * earlier.velocity_by_velocity,
    )


@body(contract.transfer, Full)
def transfer(p, arc, start, time):
    """Provide ``contract.transfer``."""
    now = evaluate(p, arc, start)
    angle, velocity, drive, left = now.angle, now.velocity, now.drive, time
    done = Transfer(1.0, 0.0, 0.0, 1.0)
    while left > 0.0:
        step = step_from(p, arc.side, angle, velocity, drive)
        t = min(left, step.length)
        done = product(transfer_in(p, arc.side, step, drive, t), done)
        rise, velocity = state_in(step, t)
        drive = drive_later(p, drive, t, step.to_corner and t == step.length)
        angle, left = angle + rise, left - t
    return done


@body(contract.transfer_to_event, Full)
def transfer_to_event(p, arc, coming):
    """Provide ``contract.transfer_to_event``."""
    return transfer(p, arc, 0.0, coming.wait)


@kernel
def first_event(p, arc, peak, with_lows):
    """Return the first event of an arc: an impact, the proof that none follows, or a restart after a long time.

    The other results are the ``Extremes`` and the ``Stretch`` until then. The largest angle is ``peak`` at least. An infinite
    ``peak`` spares the search for it. Minima are searched for ``with_lows`` only. Where no event follows, the state is that at which
    this is proved.
    """
    angle, velocity, drive, elapsed = arc.angle, arc.velocity, arc.drive, 0.0
    brace, seen, growth, steps = p.block.brace_angle, NO_EXTREMES, 0.0, 0.0
    while elapsed < MAX_ARC_TIME:
        step = step_from(p, arc.side, angle, velocity, drive)
        t = math.inf
        if not cannot_reach_base(p, arc.side, step, drive):
            t = first_zero_of_step(step.angle, step.velocity, step.series, step.length)
        if brace < math.inf:
            hit = first_zero_of_step(brace - angle, -velocity, negative(step.series), step.length)
            if hit < t:
                _, velocity = state_in(step, hit)
                drive = drive_later(p, drive, hit, False)
                coming = Next(elapsed + hit, BRACE, arc.side, brace, velocity, drive, 0.0, 0.0)
                return coming, with_reached(seen, brace), stretch_of(growth, elapsed, steps)
        flat = flat_time(p, arc.side, step, drive)
        lies = flat < t
        t = math.inf if lies else t
        h = min(t, flat, step.length)
        if peak < math.inf:
            peak = peak_in(p, arc, step, drive, h, peak)
        stiffness = growth_of(p, contract.stiffness(p, arc.side, step.sine, step.cosine, drive))
        growth, part = growth + h * stiffness, (h / step.length) ** 4
        steps += part * part
        rise, velocity = state_in(step, h)
        end = 0.0 if t < math.inf else lying_angle(p) if lies else angle + rise
        if with_lows and may_turn_up(p, arc.side, step, drive, h, end, velocity):
            seen = with_minimum(p, arc.side, step, drive, h, end, velocity, elapsed, seen)
        if with_lows and not lies:
            seen = limits_within(p, arc, step, drive, h, end, seen)
        elapsed += h
        if lies:
            drive = drive_later(p, drive, flat, False)
            coming = Next(math.inf, NONE, arc.side, end, velocity, drive, 0.0, 0.0)
            return coming, with_reached(seen, peak), stretch_of(growth, elapsed, steps)
        if t < math.inf:
            drive = drive_later(p, drive, t, False)
            coming = Next(elapsed, IMPACT, arc.side, 0.0, velocity, drive, 0.0, 0.0)
            return coming, with_reached(seen, peak), stretch_of(growth, elapsed, steps)
        angle, drive = end, drive_later(p, drive, step.length, step.to_corner)
        if brace == math.inf and contract.never_returns(p, arc.side, angle, velocity, drive):
            coming = Next(math.inf, NONE, arc.side, angle, velocity, drive, 0.0, 0.0)
            return coming, with_reached(seen, peak), stretch_of(growth, elapsed, steps)
    coming = Next(elapsed, NONE, arc.side, angle, velocity, drive, 0.0, 0.0)
    return coming, with_reached(seen, peak), stretch_of(growth, elapsed, steps)


@kernel(inline=True)
def stretch_of(growth, time, steps):
    """Return the ``Stretch`` from the integral of du''/du over a time."""
    return Stretch(math.sqrt(max(growth / time, SLOWEST_GROWTH)) if time > 0.0 else 1.0, steps)


@body(contract.next_event_and_extremes, Full)
def next_event_and_extremes(p, mode, arc, peak):
    """Provide ``contract.next_event_and_extremes``: the largest angle is found with the event."""
    if mode == FLIGHT:
        return first_event(p, arc, peak, True)
    return contract.held_event(p, mode, arc), NO_EXTREMES, UNIT_RATE


@body(contract.next_event, Full)
def next_event(p, mode, arc, guess):
    """Provide ``contract.next_event``."""
    if mode == FLIGHT:
        return first_event(p, arc, math.inf, False)[0], guess
    return contract.held_event(p, mode, arc), guess


@body(contract.no_return_time, Full)
def no_return_time(p, arc):
    """Provide ``contract.no_return_time``: the end of the first step after which overturning is proved."""
    angle, velocity, drive, elapsed = arc.angle, arc.velocity, arc.drive, 0.0
    while not contract.never_returns(p, arc.side, angle, velocity, drive):
        step = step_from(p, arc.side, angle, velocity, drive)
        flat = flat_time(p, arc.side, step, drive)
        if flat < math.inf:
            return elapsed + flat
        rise, velocity = state_in(step, step.length)
        angle, elapsed = angle + rise, elapsed + step.length
        drive = drive_later(p, drive, step.length, step.to_corner)
    return elapsed


@body(contract.turn_from, Full)
def turn_from(p, arc, sign, start, until):
    """Provide ``contract.turn_from``."""
    now = evaluate(p, arc, start)
    angle, velocity, drive, elapsed, found = now.angle, now.velocity, now.drive, start, math.inf
    while elapsed < until and found == math.inf:
        step = step_from(p, arc.side, angle, velocity, drive)
        slope, bend, rest = derivative(step.velocity, step.series, sign)
        if elapsed == start:
            slope = max(slope, 0.0)  # just after an extremum u' may have the other sign to rounding
        found = elapsed + first_zero_of_step(slope, bend, rest, min(step.length, until - elapsed))
        rise, velocity = state_in(step, step.length)
        angle, elapsed = angle + rise, elapsed + step.length
        drive = drive_later(p, drive, step.length, step.to_corner)
    if found > until:
        return LATER, until, evaluate(p, arc, until)
    return CROSSING, found, evaluate(p, arc, found)
