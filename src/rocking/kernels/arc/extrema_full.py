"""Largest angle along an arc of the full block, step by step, and when it lies flat."""

import math

from rocking.kernels import contract
from rocking.kernels.arc.arc import Arc, with_dip, with_low, within_reach
from rocking.kernels.arc.first_zero_full import first_zero_of_step
from rocking.kernels.arc.full_series import bend_0, derivative, divided_1, jerk, negative
from rocking.kernels.arc.full_step import state_in, step_from
from rocking.kernels.contract import (
    acceleration_of,
    drive_later,
    largest_ahead,
    largest_within,
    lightest_ahead,
    parts_at_base,
    weight_of,
)
from rocking.kernels.event_kinds import BRACE
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import RIGHT_ANGLE
from rocking.kernels.system import Full, side_of

# Rounding error of u'', relative to its parts.
NOISE = 2.0**-49
# Part of a step by which the search for extrema advances at least.
SHORTEST_PART = 2.0**-30
# Relative safety margin of a bound over rounding.
MARGIN = 1e-12
# Lower bound of u that spares the search for its minima.
FAR_ABOVE = 1e-6
# Halvings of a step to find the time of a minimum: the angle there is known to their square.
HALVINGS = 26
# Part of a right angle from which the largest angle of a step is computed.
NEAR_FLAT = 0.9


@kernel
def first_turn(step, h, noise):
    """Return the time within h of a step at which u' first changes its sign, or infinity.

    At a lift-off u' and u'' vanish. There u'' is at most its rounding error, ``noise``, and the third derivative gives the sign.
    """
    half = step.series[0] if step.velocity != 0.0 or abs(step.series[0]) > noise else 0.0
    leading = step.velocity if step.velocity != 0.0 else half if half != 0.0 else step.series[1]
    sign = 1.0 if leading > 0.0 else -1.0
    slope, _, rest = derivative(step.velocity, step.series, sign)
    return first_zero_of_step(slope, sign * 2.0 * half, rest, h)


@kernel
def to_turn(step, h, noise):
    """Return the time up to the first turn within h of a step, or h, and the rise and u' there; u' = 0 at a turn.

    A turn within SHORTEST_PART h of the start is one that rounding finds again. Then the time is SHORTEST_PART h.
    """
    turn, least = first_turn(step, h, noise), SHORTEST_PART * h
    if least < turn < h:
        return turn, state_in(step, turn)[0], 0.0
    t = least if turn <= least else h
    rise, velocity = state_in(step, t)
    return t, rise, velocity


@kernel(inline=True)
def noise_at(p, side, drive):
    """Return the rounding error of u''."""
    parts = parts_at_base(p, side, abs(weight_of(p, drive)))
    return NOISE * (parts + abs(acceleration_of(p, drive)))


@kernel
def highest_possible(step, rise, bend, h):
    """Return a bound on the angle up to a time h, from the rise over it.

    The angle exceeds its chord by h^2/8 max|u''| at most.
    """
    return max(step.angle, step.angle + rise) + 0.125 * h * h * bend


@kernel(inline=True)
def may_turn_up(p, side, step, drive, h, end, velocity):
    """Return whether u may have a minimum within a time h of a step, from the state at its end.

    |u''| <= r^2 (max(s, u) + |a|), and u exceeds both ends by h^2/8 max|u''| at most.
    """
    own = side_of(p.block, side)
    largest = own.stiffness * (max(own.ratio, step.angle, end) + largest_within(p, drive, h))
    reach = h * largest * (1.0 + 0.25 * own.stiffness * h * h)
    return step.velocity < reach and velocity > -reach


@kernel
def least_between(step, low, high):
    """Return the angle where u' = 0, and its time in a step, between two times at which u' < 0 and u' > 0."""
    t = low
    for _ in range(HALVINGS):
        t = 0.5 * (low + high)
        if state_in(step, t)[1] < 0.0:
            low = t
        else:
            high = t
    return step.angle + state_in(step, t)[0], t


@kernel
def extreme_velocity(step, h):
    """Return u' and its time within h of a step, where u'' changes its sign; that is known to happen once, or not at all."""
    a, b, rest = derivative(step.velocity, step.series, 1.0)
    low, high, t, slope = 0.0, h, 0.0, b
    for _ in range(HALVINGS):
        t = 0.5 * (low + high)
        slope, bend = divided_1(a, b, rest, t)
        if (slope + bend * t) * b > 0.0:
            low = t
        else:
            high = t
    return a + slope * t, t


@kernel(seldom=True)
def with_minima(p, side, step, drive, h, elapsed, extremes):
    """Return the extremes with the minima within a time h of a step, from turn to turn; a new step starts at each."""
    left = h
    while left > 0.0:
        t, rise, velocity = to_turn(step, min(step.length, left), noise_at(p, side, drive))
        angle = step.angle + rise
        if step.velocity < 0.0 < velocity or (velocity == 0.0 and state_in(step, 0.5 * t)[1] < 0.0):
            extremes = with_dip(extremes, min(step.angle, angle), elapsed + t)
        elapsed, left = elapsed + t, left - t
        if left > 0.0:
            drive = drive_later(p, drive, t, step.to_corner and t == step.length)
            step = step_from(p, side, angle, velocity, drive)
    return extremes


@kernel
def with_minimum(p, side, step, drive, h, end, velocity, elapsed, extremes):
    """Return the extremes with the minimum within a time h of a step, which starts at the time ``elapsed`` of its arc.

    If u'' keeps its sign, u' goes in one direction. If the third derivative keeps its sign, u' has one extremum at most. Otherwise
    a lower bound of u is known, and if it is small, the turns are found one by one.
    """
    c, before, low, high = step.series, step.velocity, 0.0, h
    bend = bend_0(step.angle, before, c, h) * (1.0 + MARGIN)
    turns = before < 0.0 < velocity
    if 4.0 * abs(c[0]) < bend:
        if 6.0 * abs(c[1]) < jerk(c, h) * (1.0 + MARGIN):
            lowest = min(step.angle, end) - 0.125 * h * h * bend
            if lowest > FAR_ABOVE:
                return with_low(extremes, min(extremes.low, lowest))
            return with_minima(p, side, step, drive, h, elapsed, extremes)
        if c[0] * c[1] < 0.0 and not turns and (velocity > 0.0 if before >= 0.0 else velocity <= 0.0):
            least, t = extreme_velocity(step, h)
            turns = least <= 0.0 if before >= 0.0 else least >= 0.0
            turns = turns and (c[1] > 0.0) == (before >= 0.0)
            low, high = (t, h) if before >= 0.0 else (0.0, t)
    if turns:
        dip, t = least_between(step, low, high)
        return with_dip(extremes, dip, elapsed + t)
    return extremes


@body(contract.largest_on, Full)
def largest_on(p, arc, until, peak):
    """Provide ``contract.largest_on``: after an extremum that may count, a new step starts there with u' = 0."""
    angle, velocity, drive, left = arc.angle, arc.velocity, arc.drive, until
    while left > 0.0:
        step = step_from(p, arc.side, angle, velocity, drive)
        h = min(step.length, left)
        rise, velocity = state_in(step, h)
        bend = bend_0(angle, step.velocity, step.series, h)
        if highest_possible(step, rise, bend, h) > peak:
            h, rise, velocity = to_turn(step, h, noise_at(p, arc.side, drive))
        angle, left = angle + rise, left - h
        drive = drive_later(p, drive, h, step.to_corner and h == step.length)
        peak = max(peak, within_reach(p, angle))
    return peak


@kernel
def peak_in(p, arc, step, drive, h, peak):
    """Return the largest angle up to a time h of a step of an arc, and ``peak`` at least."""
    rise = state_in(step, h)[0]
    bend = bend_0(step.angle, step.velocity, step.series, h)
    if highest_possible(step, rise, bend, h) <= peak:
        return peak
    if step.velocity > h * bend:  # the angle only grows
        return max(peak, within_reach(p, step.angle + rise))
    return largest_on(p, Arc(arc.side, arc.start, step.angle, step.velocity, drive, arc.constants), h, peak)


@kernel(inline=True)
def may_lie(p, side, step, drive):
    """Return whether a block may lie flat within a step, by a bound of u''."""
    alpha, h = p.block.critical_angle, step.length
    push = side_of(p.block, side).stiffness * (1.0 + alpha * largest_within(p, drive, h))
    return alpha * (step.angle + max(step.velocity, 0.0) * h) + 0.5 * push * h * h >= RIGHT_ANGLE


@kernel(inline=True)
def lying_angle(p):
    """Return the angle of a block that lies flat."""
    return RIGHT_ANGLE / p.block.critical_angle


@kernel
def lying_time(p, step):
    """Return the time in a step at which a block lies flat; infinity if it does not."""
    return first_zero_of_step(lying_angle(p) - step.angle, -step.velocity, negative(step.series), step.length)


@kernel
def short_of_flat(p, arc, step, drive, h, end):
    """Return a lower bound of the angle by which a block fails to lie flat within a time h of a step, at whose end is the angle ``end``."""
    flat = lying_angle(p)
    bend = bend_0(step.angle, step.velocity, step.series, h)
    top = highest_possible(step, end - step.angle, bend, h)
    if top > NEAR_FLAT * flat:
        top = peak_in(p, arc, step, drive, h, step.angle)
    return flat - top


@kernel(inline=True)
def may_be_raised(p, side, drive):
    """Return whether the base may still raise a block that lies flat on a side: sigma a sin theta_cr > W cos theta_cr."""
    own = side_of(p.block, side)
    push, light = p.block.critical_angle * largest_ahead(p, side, drive), lightest_ahead(p, drive)
    return push * own.sine > light * own.cosine


@body(contract.flat_time, Full, inline=True)
def flat_time(p, side, step, drive):
    """Provide ``contract.flat_time``."""
    if may_be_raised(p, side, drive) and may_lie(p, side, step, drive):
        return lying_time(p, step)
    return math.inf


@body(contract.limits_within, Full, inline=True)
def limits_within(p, arc, step, drive, h, end, extremes):
    """Provide ``contract.limits_within``: by how much the block fails to lie flat, if the base may raise it again."""
    if not (may_be_raised(p, arc.side, drive) and may_lie(p, arc.side, step, drive)):
        return extremes
    return with_low(extremes, min(extremes.low, short_of_flat(p, arc, step, drive, h, end)))


@body(contract.largest_before, Full, inline=True)
def largest_before(p, arc, coming, reached):
    """Provide ``contract.largest_before``: the search for the event has found the largest angle."""
    return reached


@body(contract.peak_with, Full)
def peak_with(p, arc, coming, peak):
    """Provide ``contract.peak_with``."""
    if coming.event == BRACE:
        return p.block.brace_angle
    return largest_on(p, arc, coming.wait, peak)
