"""Arcs of the full block, step by step: states, perturbations and the next event."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, LEAN, NONE
from rocking.kernels.forcing.arc import MAX_ARC_TIME, Arc, Instant, Next, Transfer
from rocking.kernels.forcing.full.base import (
    acceleration_of,
    constants_at,
    departure,
    drive_after_event,
    drive_later,
    drive_on_clock,
    lift_off,
)
from rocking.kernels.forcing.full.crossing import first_zero
from rocking.kernels.forcing.full.extrema import peak_in
from rocking.kernels.forcing.full.overturning import never_returns
from rocking.kernels.forcing.full.series import negative
from rocking.kernels.forcing.full.step import cannot_reach_base, state_in, step_from, transfer_in


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


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL)
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


@njit(**INTERNAL)
def transfer_to_event(p, arc, coming):
    """Provide ``contract.transfer_to_event``."""
    return transfer(p, arc, 0.0, coming.wait)


@njit(**INTERNAL)
def first_event(p, arc, peak):
    """Return the first event of an arc: an impact, the proof that none follows, or a restart after a long time.

    The second result is the largest angle until then, and ``peak`` at least. An infinite ``peak`` spares the search for it.
    """
    angle, velocity, drive, elapsed = arc.angle, arc.velocity, arc.drive, 0.0
    brace = p.block.brace_angle
    while elapsed < MAX_ARC_TIME:
        step = step_from(p, arc.side, angle, velocity, drive)
        t = math.inf
        if not cannot_reach_base(p, step, drive):
            t = first_zero(step.angle, step.velocity, step.series, step.length)
        if brace < math.inf:
            hit = first_zero(brace - angle, -velocity, negative(step.series), step.length)
            if hit < t:
                _, velocity = state_in(step, hit)
                drive = drive_later(p, drive, hit, False)
                return Next(elapsed + hit, BRACE, arc.side, brace, velocity, drive, 0.0, 0.0), brace
        if peak < math.inf:
            peak = peak_in(p, arc, step, drive, min(t, step.length), peak)
        if t < math.inf:
            _, velocity = state_in(step, t)
            drive = drive_later(p, drive, t, False)
            return Next(elapsed + t, IMPACT, arc.side, 0.0, velocity, drive, 0.0, 0.0), peak
        rise, velocity = state_in(step, step.length)
        angle, elapsed = angle + rise, elapsed + step.length
        drive = drive_later(p, drive, step.length, step.to_corner)
        if brace == math.inf and never_returns(p, arc.side, angle, velocity, drive):
            return Next(math.inf, NONE, arc.side, 0.0, 0.0, drive, 0.0, 0.0), peak
    return Next(elapsed, NONE, arc.side, angle, velocity, drive, 0.0, 0.0), peak


@njit(**INTERNAL)
def event_and_peak(p, mode, arc, peak):
    """Return the next event, and the largest angle until then, ``peak`` at least."""
    if mode == FLIGHT:
        return first_event(p, arc, peak)
    return (departure(p, arc) if mode == LEAN else lift_off(p, arc)), peak


@njit(**INTERNAL)
def next_event(p, mode, arc, guess):
    """Provide ``contract.next_event``."""
    return event_and_peak(p, mode, arc, math.inf)[0], guess


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
