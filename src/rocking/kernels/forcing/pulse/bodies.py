"""Bodies of ``forcing.contract`` and ``forcing.finite`` for a pulse."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit, provide
from rocking.kernels.event_kinds import FLIGHT
from rocking.kernels.forcing import contract, finite
from rocking.kernels.forcing.arc import (
    CROSSING,
    MAX_ARC_TIME,
    NO_EXTREMES,
    Extremes,
    Instant,
    error_of_arc,
    no_guess,
    unchanged,
)
from rocking.kernels.forcing.extrema import first_turn_sign
from rocking.kernels.forcing.harmonic import acceleration, extrema, first_zero
from rocking.kernels.forcing.harmonic import next_event as harmonic
from rocking.kernels.forcing.harmonic.solution import ROUNDING, exponentials
from rocking.kernels.forcing.pulse import solution
from rocking.kernels.forcing.pulse.parameters import PulseParameters, with_pulse
from rocking.kernels.forcing.pulse.solution import arc_at_time, drive_at, harmonic_arc, system_at
from rocking.kernels.forcing.settling import settling_by_change
from rocking.kernels.forcing.slender import SLENDER


@njit(**INTERNAL_INLINE)
def arc_at(p, side, cycle, start, angle, velocity):
    """Provide ``contract.arc_at``."""
    return arc_at_time(p, side, start, angle, velocity, cycle * p.clock.cycle_length + start)


@njit(**INTERNAL_INLINE)
def arc_after(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_after`` and ``contract.arc_renewed``."""
    return arc_at_time(p, side, start, angle, velocity, coming.drive.time)


@njit(**INTERNAL_INLINE)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``."""
    return acceleration.forcing_term(system_at(p, drive.time), drive.cosine)


@njit(**INTERNAL_INLINE)
def next_event(p, mode, arc, guess):
    """Provide ``contract.next_event``."""
    return solution.next_event(p, mode, arc), guess


@njit(**INTERNAL_INLINE)
def no_return_time(p, arc):
    """Provide ``contract.no_return_time``: that nothing follows is only found after the end of the pulse."""
    return first_zero.no_return_time(system_at(p, arc.drive.time), harmonic_arc(arc))


@njit(**INTERNAL_INLINE)
def side_to_lift(p, start, drive):
    """Provide ``contract.side_to_lift``."""
    return harmonic.side_to_lift(system_at(p, drive.time), drive.time, drive)


@njit(**INTERNAL_INLINE)
def stays_leaning(p, arc):
    """Provide ``contract.stays_leaning``."""
    return harmonic.stays_leaning(system_at(p, arc.drive.time), harmonic_arc(arc))


@njit(**INTERNAL_INLINE)
def acceleration_size(p, drive):
    """Provide ``contract.acceleration_size``."""
    return system_at(p, drive.time).forcing.amplitude * abs(drive.cosine)


@njit(**INTERNAL)
def acceleration_change_bound(p, drive, time):
    """Provide ``contract.acceleration_change_bound``: at the end of the pulse the base acceleration vanishes."""
    changed = acceleration.acceleration_change_bound(system_at(p, drive.time), drive.sine, time)
    return max(changed, acceleration_size(p, drive)) if drive.time + time >= p.forcing.duration else changed


@njit(**INTERNAL_INLINE)
def peak_with(p, arc, coming, peak):
    """Provide ``contract.peak_with``."""
    return extrema.peak_with(system_at(p, arc.drive.time), harmonic_arc(arc), coming, peak)


@njit(**INTERNAL_INLINE)
def largest_on(p, arc, until, peak):
    """Provide ``contract.largest_on``."""
    return extrema.largest_on(system_at(p, arc.drive.time), harmonic_arc(arc), until, peak)


@njit(**INTERNAL)
def next_turn(p, arc, sign, t, until):
    """Provide ``contract.next_turn``."""
    found, at, now = extrema.next_turn(system_at(p, arc.drive.time), harmonic_arc(arc), sign, t, until)
    drive = drive_at(arc.drive.time + at, now.drive)
    return found, at, Instant(now.angle, now.risen, now.velocity, drive, now.sinh, now.versinh)


@njit(**INTERNAL_INLINE)
def sensitivities(p, arc, t, sinh, versinh, excess):
    """Provide ``contract.sensitivities``: those of the cosine; none after its end."""
    q = system_at(p, arc.drive.time)
    return acceleration.sensitivities(q, arc.drive.cosine, arc.drive.sine, t, sinh, versinh, excess)


@njit(**INTERNAL)
def growth_constant(p, arc):
    """Provide ``finite.growth_constant``: that of the whole cosine, less the part after the end of the pulse."""
    q = system_at(p, arc.drive.time)
    grow, _, error = exponentials(q, harmonic_arc(arc))
    left = p.forcing.duration - arc.drive.time
    missing = math.exp(-left) * p.forcing.end_response if left > 0.0 else 0.0
    return 2.0 * grow + arc.side * missing, 2.0 * error + ROUNDING * abs(missing)


@njit(**INTERNAL_INLINE)
def rounding_error(p, arc, wait, growth):
    """Provide ``finite.rounding_error``: no terms cancel on an arc."""
    return error_of_arc(arc, wait, growth, 1.0 + p.forcing.during.forcing.amplitude)


@njit(**INTERNAL)
def next_event_and_extremes(p, mode, arc):
    """Provide ``finite.next_event_and_extremes``.

    After a lift-off u rises as long as f > 0; rounding may deny it at the very start.
    """
    coming, extremes = solution.next_event(p, mode, arc), NO_EXTREMES
    if mode != FLIGHT:
        return coming, extremes
    until = min(coming.wait, MAX_ARC_TIME)
    lifts = arc.angle == 0.0 and arc.velocity == 0.0
    sign = 1.0 if arc.angle == 0.0 else first_turn_sign(p, arc)
    t = 0.5 * system_at(p, arc.drive.time).forcing.base_outside if lifts else 0.0
    while True:
        found, t, now = next_turn(p, arc, sign, t, until)
        if found != CROSSING:
            return coming, extremes
        if sign < 0.0 and now.angle < extremes.dip:
            extremes = Extremes(now.angle, t, math.inf, 0.0)
        sign = -sign


@njit(**INTERNAL_INLINE)
def largest_before(p, arc, coming, reached):
    """Provide ``finite.largest_before``: unknown."""
    return math.inf


@njit(**INTERNAL_INLINE)
def has_ended(p, drive):
    """Provide ``finite.has_ended``."""
    return drive.time >= p.forcing.duration


@njit(**INTERNAL_INLINE)
def elapsed_until(p, arc, drive):
    """Provide ``finite.elapsed_until``."""
    return drive.time - arc.drive.time


provide(
    PulseParameters,
    {
        **SLENDER,
        contract.arc_at: arc_at,
        contract.arc_renewed: arc_after,
        contract.arc_after: arc_after,
        contract.resynchronise: unchanged,
        contract.evaluate: solution.evaluate,
        contract.forcing_term: forcing_term,
        contract.guess_from: no_guess,
        contract.next_event: next_event,
        contract.no_return_time: no_return_time,
        contract.side_to_lift: side_to_lift,
        contract.stays_leaning: stays_leaning,
        contract.acceleration_size: acceleration_size,
        contract.acceleration_change_bound: acceleration_change_bound,
        contract.settling: settling_by_change,
        contract.peak_with: peak_with,
        contract.largest_on: largest_on,
        contract.next_turn: next_turn,
        contract.sensitivities: sensitivities,
        finite.elapsed_until: elapsed_until,
        finite.growth_constant: growth_constant,
        finite.has_ended: has_ended,
        finite.largest_before: largest_before,
        finite.next_event_and_extremes: next_event_and_extremes,
        finite.rounding_error: rounding_error,
        finite.with_pulse: with_pulse,
    },
)
