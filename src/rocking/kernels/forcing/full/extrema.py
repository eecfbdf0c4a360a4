"""Largest angle along an arc of the full block, step by step."""

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE
from rocking.kernels.forcing.arc import Arc, within_reach
from rocking.kernels.forcing.full.base import acceleration_of, drive_later
from rocking.kernels.forcing.full.crossing import first_zero
from rocking.kernels.forcing.full.series import bend_0, derivative
from rocking.kernels.forcing.full.step import state_in, step_from

# Rounding error of u'', relative to its parts.
NOISE = 2.0**-49
# Part of a step by which the search for extrema advances at least.
SHORTEST = 2.0**-30


@njit(**INTERNAL)
def first_turn(step, h, noise):
    """Return the time within h of a step at which u' first changes its sign, or infinity.

    At a lift-off u' and u'' vanish. There u'' is at most its rounding error, ``noise``, and the third derivative gives the sign.
    """
    half = step.series[0] if step.velocity != 0.0 or abs(step.series[0]) > noise else 0.0
    leading = step.velocity if step.velocity != 0.0 else half if half != 0.0 else step.series[1]
    sign = 1.0 if leading > 0.0 else -1.0
    slope, _, rest = derivative(step.velocity, step.series, sign)
    return first_zero(slope, sign * 2.0 * half, rest, h)


@njit(**INTERNAL)
def highest_possible(step, rise, bend, h):
    """Return a bound on the angle up to a time h, from the rise over it.

    The angle exceeds its chord by h^2/8 max|u''| at most.
    """
    return max(step.angle, step.angle + rise) + 0.125 * h * h * bend


@njit(**INTERNAL)
def largest_on(p, arc, until, peak):
    """Provide ``contract.largest_on``: after an extremum that may count, a new step starts there with u' = 0."""
    angle, velocity, drive, left = arc.angle, arc.velocity, arc.drive, until
    while left > 0.0:
        step = step_from(p, arc.side, angle, velocity, drive)
        h = min(step.length, left)
        rise, velocity = state_in(step, h)
        bend = bend_0(angle, step.velocity, step.series, h)
        if highest_possible(step, rise, bend, h) > peak:
            noise = NOISE * (p.block.press + abs(acceleration_of(p, drive)))
            turn, least = first_turn(step, h, noise), SHORTEST * h
            if turn <= least:  # an extremum that rounding finds again
                h, (rise, velocity) = least, state_in(step, least)
            elif turn < h:
                h, velocity = turn, 0.0
                rise = state_in(step, h)[0]
        angle, left = angle + rise, left - h
        drive = drive_later(p, drive, h, step.to_corner and h == step.length)
        peak = max(peak, within_reach(p, angle))
    return peak


@njit(**INTERNAL)
def peak_in(p, arc, step, drive, h, peak):
    """Return the largest angle up to a time h of a step of an arc, and ``peak`` at least."""
    rise = state_in(step, h)[0]
    bend = bend_0(step.angle, step.velocity, step.series, h)
    if highest_possible(step, rise, bend, h) <= peak:
        return peak
    if step.velocity > h * bend:  # the angle only grows
        return max(peak, within_reach(p, step.angle + rise))
    return largest_on(p, Arc(arc.side, arc.start, step.angle, step.velocity, drive, arc.constants), h, peak)


@njit(**INTERNAL)
def peak_with(p, arc, coming, peak):
    """Provide ``contract.peak_with``."""
    if coming.event == BRACE:
        return p.block.brace_angle
    return largest_on(p, arc, coming.wait, peak)
