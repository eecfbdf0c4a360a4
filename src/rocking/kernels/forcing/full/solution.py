"""Arcs of the full block, step by step: states, the next event, and extremes of the angle."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import FLIGHT, IMPACT, NONE
from rocking.kernels.forcing.arc import CROSSING, LATER, MAX_ARC_TIME, Arc, Instant, Next
from rocking.kernels.forcing.full.base import (
    acceleration_of,
    constants_at,
    drive_after_event,
    drive_later,
    drive_on_clock,
    lift_off,
)
from rocking.kernels.forcing.full.crossing import first_zero
from rocking.kernels.forcing.full.overturning import never_returns
from rocking.kernels.forcing.full.series import derivative
from rocking.kernels.forcing.full.step import state_in, step_from

# After an extremum the search starts later by this fraction of the time, so that rounding cannot find it again.
PASSED = 2.0**-50


@njit(**INTERNAL_INLINE)
def arc_at(p, side, cycle, start, angle, velocity):
    """Provide ``contract.arc_at``."""
    drive = drive_on_clock(p, cycle, start)
    return Arc(side, start, angle, velocity, drive, constants_at(p, start, drive))


@njit(**INTERNAL_INLINE)
def arc_after(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_after`` and ``contract.arc_renewed``."""
    drive = drive_after_event(p, start, coming)
    return Arc(side, start, angle, velocity, drive, constants_at(p, start, drive))


@njit(**INTERNAL_INLINE)
def acceleration(p, side, angle, drive):
    """Provide ``contract.acceleration``: u'' = -sin(w)/alpha - sigma A cos(w), w = alpha (1 - u)."""
    alpha = p.block.critical_angle
    w = alpha * (1.0 - angle)
    return -math.sin(w) / alpha - side * acceleration_of(p, drive) * math.cos(w)


@njit(**INTERNAL)
def evaluate(p, arc, t):
    """Provide ``contract.evaluate``."""
    angle, velocity, drive, risen, left = arc.angle, arc.velocity, arc.drive, 0.0, t
    step = step_from(p, arc.side, angle, velocity, drive)
    while left > step.length and math.isfinite(angle):
        rise, velocity = state_in(step, step.length)
        angle, risen, left = angle + rise, risen + rise, left - step.length
        drive = drive_later(p, drive, step.length, step.to_corner)
        step = step_from(p, arc.side, angle, velocity, drive)
    rise, velocity = state_in(step, left)
    return Instant(angle + rise, risen + rise, velocity, drive_later(p, drive, left, False), 0.0, 0.0)


@njit(**INTERNAL)
def first_event(p, arc):
    """Return the first event of an arc: an impact, the proof that none follows, or a restart after a long time."""
    angle, velocity, drive, elapsed = arc.angle, arc.velocity, arc.drive, 0.0
    while elapsed < MAX_ARC_TIME:
        step = step_from(p, arc.side, angle, velocity, drive)
        t = first_zero(step.angle, step.velocity, step.series, step.length)
        if t < math.inf:
            _, velocity = state_in(step, t)
            drive = drive_later(p, drive, t, False)
            return Next(elapsed + t, IMPACT, arc.side, 0.0, velocity, drive, 0.0, 0.0)
        rise, velocity = state_in(step, step.length)
        angle, elapsed = angle + rise, elapsed + step.length
        drive = drive_later(p, drive, step.length, step.to_corner)
        if never_returns(p, arc.side, angle, velocity, drive):
            return Next(math.inf, NONE, arc.side, 0.0, 0.0, drive, 0.0, 0.0)
    return Next(elapsed, NONE, arc.side, angle, velocity, drive, 0.0, 0.0)


@njit(**INTERNAL)
def next_event(p, mode, arc, guess):
    """Provide ``contract.next_event``; there are no braces."""
    return (first_event(p, arc) if mode == FLIGHT else lift_off(p, arc)), guess


@njit(**INTERNAL)
def no_return_time(p, arc):
    """Provide ``contract.no_return_time``: the end of the first step after which overturning is proved."""
    angle, velocity, drive, elapsed = arc.angle, arc.velocity, arc.drive, 0.0
    while not never_returns(p, arc.side, angle, velocity, drive):
        step = step_from(p, arc.side, angle, velocity, drive)
        rise, velocity = state_in(step, step.length)
        angle, elapsed = angle + rise, elapsed + step.length
        drive = drive_later(p, drive, step.length, step.to_corner)
    return elapsed


@njit(**INTERNAL)
def next_turn(p, arc, sign, t, until):
    """Provide ``contract.next_turn``."""
    start, passed = t, PASSED * (1.0 + t)
    while start < until:
        now = evaluate(p, arc, start)
        angle, velocity, drive, elapsed, found = now.angle, now.velocity, now.drive, start, math.inf
        while elapsed < until and found == math.inf:
            step = step_from(p, arc.side, angle, velocity, drive)
            slope, bend, rest = derivative(step.velocity, step.series, sign)
            if elapsed == start:
                slope = max(slope, 0.0)  # just after an extremum u' may have the other sign to rounding
            found = elapsed + first_zero(slope, bend, rest, min(step.length, until - elapsed))
            rise, velocity = state_in(step, step.length)
            angle, elapsed = angle + rise, elapsed + step.length
            drive = drive_later(p, drive, step.length, step.to_corner)
        if found > until:
            return LATER, until, evaluate(p, arc, until)
        if found > t:
            return CROSSING, found, evaluate(p, arc, found)
        start, passed = start + passed, 2.0 * passed
    return LATER, until, evaluate(p, arc, until)
