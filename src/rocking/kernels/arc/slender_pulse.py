"""Arcs under a pulse: those of the harmonic forcing up to the end of the pulse, and free arcs afterwards.

An arc ends with the pulse at the latest: there the next one starts from its state.
"""

import math

from rocking.kernels import contract
from rocking.kernels.arc.arc import (
    CROSSING,
    MAX_ARC_TIME,
    NO_EXTREMES,
    UNIT_RATE,
    Arc,
    Instant,
    Next,
    error_of_arc,
    first_turn_sign,
    next_turn,
    with_dip,
)
from rocking.kernels.arc.slender_cosine import NONE_YET, ROUNDING, arc_from, exponentials
from rocking.kernels.base.cosine import (
    HarmonicDrive,
    Pulse,
    PulseDrive,
    change_of_cosine,
    harmonic_term,
    response_sensitivities,
)
from rocking.kernels.event_kinds import FLIGHT, LEAN, LEAVE, NONE, REST
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import exponential
from rocking.kernels.system import Slender

# Relative rounding error of a time, in which it may be that of the end of the pulse.
AT_END = 2.0**-50


@kernel(inline=True)
def system_at(p, time):
    """Return the system with harmonic forcing whose motion is that of this one from a time on."""
    return Slender(p.block, p.forcing.during if time < p.forcing.duration else p.forcing.after, p.clock)


@kernel(inline=True)
def harmonic_arc(arc):
    """Return an arc as one of the harmonic forcing."""
    drive = HarmonicDrive(arc.drive.cosine, arc.drive.sine)
    return Arc(arc.side, arc.start, arc.angle, arc.velocity, drive, arc.constants)


@kernel(inline=True)
def drive_at(time, drive):
    """Return the forcing at a time since the start of the pulse."""
    return PulseDrive(time, drive.cosine, drive.sine)


@kernel
def arc_at_time(p, side, start, angle, velocity, time):
    """Return the arc that starts at a time since the start of the pulse, ``start`` on the clock."""
    # after the end the forcing is 0 at any phase
    phase_time = time if time < p.forcing.duration else 0.0
    arc = arc_from(system_at(p, time), side, phase_time, angle, velocity)
    return Arc(side, start, angle, velocity, drive_at(time, arc.drive), arc.constants)


@body(contract.evaluate, Slender, Pulse)
def evaluate(p, arc, t):
    """Return the ``Instant`` of an arc at a time t >= 0 after its start."""
    now = contract.evaluate(system_at(p, arc.drive.time), harmonic_arc(arc), t)
    drive = drive_at(arc.drive.time + t, now.drive)
    return Instant(now.angle, now.risen, now.velocity, drive, now.sinh, now.versinh)


@kernel
def at_end(p, mode, arc, left):
    """Return what the end of the pulse, after the time ``left``, does to an arc without an event before."""
    end = PulseDrive(p.forcing.duration, 0.0, 0.0)
    if mode == FLIGHT:
        now = evaluate(p, arc, left)
        return Next(left, NONE, arc.side, now.angle, now.velocity, end, now.sinh, now.versinh)
    if mode == LEAN and p.block.brace_angle < 1.0:
        return Next(left, LEAVE, arc.side, p.block.brace_angle, 0.0, end, 0.0, 0.0)
    return Next(math.inf, NONE, arc.side, arc.angle, 0.0, end, 0.0, 0.0)


@kernel(inline=True)
def before_end(p, mode, arc, coming):
    """Return an event of the harmonic motion if it comes before the end of the pulse, else that end."""
    time, left = arc.drive.time, p.forcing.duration - arc.drive.time
    if left > 0.0 and not coming.wait < left:
        return at_end(p, mode, arc, left)
    drive = drive_at(time + coming.wait, coming.drive)
    return Next(
        coming.wait,
        coming.event,
        coming.side,
        coming.angle,
        coming.velocity,
        drive,
        coming.sinh,
        coming.versinh,
    )


@body(contract.held_event, Slender, Pulse)
def held_event(p, mode, arc):
    """Provide ``contract.held_event``."""
    return before_end(
        p, mode, arc, contract.held_event(system_at(p, arc.drive.time), mode, harmonic_arc(arc))
    )


@kernel
def next_event_or_end(p, mode, arc):
    """Find the next event of an arc: one of the harmonic motion before the end of the pulse, or that end."""
    coming, _ = contract.next_event(system_at(p, arc.drive.time), mode, harmonic_arc(arc), NONE_YET)
    return before_end(p, mode, arc, coming)


@body(contract.arc_at, Slender, Pulse, inline=True)
def arc_at(p, side, cycle, start, angle, velocity):
    """Provide ``contract.arc_at``; a start at the end of the pulse may have been rounded to before it."""
    time, end = cycle * p.clock.cycle_length + start, p.forcing.duration
    return arc_at_time(p, side, start, angle, velocity, end if abs(time - end) <= AT_END * end else time)


@body(contract.arc_renewed, Slender, Pulse)
@body(contract.arc_after, Slender, Pulse, inline=True)
def arc_after(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_after`` and ``contract.arc_renewed``."""
    return arc_at_time(p, side, start, angle, velocity, coming.drive.time)


@body(contract.forcing_term, Slender, Pulse, inline=True)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``."""
    return harmonic_term(system_at(p, drive.time), drive.cosine)


@body(contract.next_event, Slender, Pulse, inline=True)
def next_event(p, mode, arc, guess):
    """Provide ``contract.next_event``."""
    return next_event_or_end(p, mode, arc), guess


@body(contract.no_return_time, Slender, Pulse, inline=True)
def no_return_time(p, arc):
    """Provide ``contract.no_return_time``: that nothing follows is only found after the end of the pulse."""
    return contract.no_return_time(system_at(p, arc.drive.time), harmonic_arc(arc))


@body(contract.side_above, Slender, Pulse, inline=True)
def side_above(p, start, drive, right_level, left_level):
    """Provide ``contract.side_above``."""
    return contract.side_above(system_at(p, drive.time), drive.time, drive, right_level, left_level)


@body(contract.lift_off, Slender, Pulse, inline=True)
def lift_off(p, arc, right_level, left_level):
    """Provide ``contract.lift_off``."""
    coming = contract.lift_off(system_at(p, arc.drive.time), harmonic_arc(arc), right_level, left_level)
    return before_end(p, REST, arc, coming)


@body(contract.stays_leaning, Slender, Pulse, inline=True)
def stays_leaning(p, arc):
    """Provide ``contract.stays_leaning``; after the pulse a block in balance stays, too."""
    if has_ended(p, arc.drive):
        return p.block.brace_angle >= 1.0
    return contract.stays_leaning(system_at(p, arc.drive.time), harmonic_arc(arc))


@body(contract.acceleration_size, None, Pulse, inline=True)
def acceleration_size(p, drive):
    """Provide ``contract.acceleration_size``."""
    return 0.0 if has_ended(p, drive) else p.forcing.during.amplitude * abs(drive.cosine)


@body(contract.acceleration_change_bound, None, Pulse)
def acceleration_change_bound(p, drive, time):
    """Provide ``contract.acceleration_change_bound``: at the end of the pulse the base acceleration vanishes."""
    if has_ended(p, drive):
        return 0.0
    changed = change_of_cosine(p.forcing.during, drive.sine, time)
    return max(changed, acceleration_size(p, drive)) if drive.time + time >= p.forcing.duration else changed


@body(contract.peak_with, Slender, Pulse, inline=True)
def peak_with(p, arc, coming, peak):
    """Provide ``contract.peak_with``."""
    return contract.peak_with(system_at(p, arc.drive.time), harmonic_arc(arc), coming, peak)


@body(contract.largest_on, Slender, Pulse, inline=True)
def largest_on(p, arc, until, peak):
    """Provide ``contract.largest_on``."""
    return contract.largest_on(system_at(p, arc.drive.time), harmonic_arc(arc), until, peak)


@body(contract.turn_from, Slender, Pulse)
def turn_from(p, arc, sign, start, until):
    """Provide ``contract.turn_from``."""
    found, at, now = contract.turn_from(system_at(p, arc.drive.time), harmonic_arc(arc), sign, start, until)
    drive = drive_at(arc.drive.time + at, now.drive)
    return found, at, Instant(now.angle, now.risen, now.velocity, drive, now.sinh, now.versinh)


@body(contract.sensitivities, Slender, Pulse, inline=True)
def sensitivities(p, arc, t, sinh, versinh, excess):
    """Provide ``contract.sensitivities``: those of the cosine; none after its end."""
    q = system_at(p, arc.drive.time)
    return response_sensitivities(q, arc.drive.cosine, arc.drive.sine, t, sinh, versinh, excess)


@body(contract.growth_constant, Slender, Pulse)
def growth_constant(p, arc):
    """Provide ``contract.growth_constant``: that of the whole cosine, less the part after the end of the pulse."""
    q = system_at(p, arc.drive.time)
    grow, _, error = exponentials(q, harmonic_arc(arc))
    left = p.forcing.duration - arc.drive.time
    missing = exponential(-left) * p.forcing.end_response if left > 0.0 else 0.0
    return 2.0 * grow + arc.side * missing, 2.0 * error + ROUNDING * abs(missing)


@body(contract.rounding_error, Slender, Pulse, inline=True)
def rounding_error(p, arc, wait, growth, steps):
    """Provide ``contract.rounding_error``: no terms cancel on an arc."""
    return error_of_arc(arc, wait, growth, 1.0 + p.forcing.during.amplitude)


@body(contract.next_event_and_extremes, Slender, Pulse)
def next_event_and_extremes(p, mode, arc, peak):
    """Provide ``contract.next_event_and_extremes``.

    After a lift-off u rises as long as f > 0; rounding may deny it at the very start.
    """
    coming, extremes = next_event_or_end(p, mode, arc), NO_EXTREMES
    if mode != FLIGHT:
        return coming, extremes, UNIT_RATE
    until = min(coming.wait, MAX_ARC_TIME)
    lifts = arc.angle == 0.0 and arc.velocity == 0.0
    sign = 1.0 if arc.angle == 0.0 else first_turn_sign(p, arc)
    t = 0.5 * system_at(p, arc.drive.time).forcing.base_outside if lifts else 0.0
    while True:
        found, t, now = next_turn(p, arc, sign, t, until)
        if found != CROSSING:
            return coming, extremes, UNIT_RATE
        if sign < 0.0:
            extremes = with_dip(extremes, now.angle, t)
        sign = -sign


@body(contract.largest_before, Slender, Pulse, inline=True)
def largest_before(p, arc, coming, reached):
    """Provide ``contract.largest_before``: unknown."""
    return math.inf


@body(contract.has_ended, None, Pulse, inline=True)
def has_ended(p, drive):
    """Provide ``contract.has_ended``."""
    return drive.time >= p.forcing.duration


@body(contract.elapsed_until, None, Pulse, inline=True)
def elapsed_until(p, arc, drive):
    """Provide ``contract.elapsed_until``."""
    return drive.time - arc.drive.time
