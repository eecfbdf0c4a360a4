"""Arcs under a pulse: those of the harmonic forcing up to the end of the pulse, and free arcs afterwards.

An arc ends with the pulse at the latest: there the next one starts from its state.
"""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import FLIGHT, LEAN, LEAVE, NONE
from rocking.kernels.forcing.arc import Arc, Instant, Next
from rocking.kernels.forcing.drives import HarmonicConstants, HarmonicDrive, PulseConstants, PulseDrive
from rocking.kernels.forcing.harmonic import next_event as harmonic
from rocking.kernels.forcing.harmonic import solution
from rocking.kernels.forcing.harmonic.solution import NONE_YET


@njit(**INTERNAL_INLINE)
def system_at(p, time):
    """Return the system with harmonic forcing whose motion is that of this one from a time on."""
    return p.forcing.during if time < p.forcing.duration else p.forcing.after


@njit(**INTERNAL_INLINE)
def harmonic_arc(arc):
    """Return an arc as one of the harmonic forcing."""
    drive = HarmonicDrive(arc.drive.cosine, arc.drive.sine)
    constants = HarmonicConstants(arc.constants.psi, arc.constants.acceleration)
    return Arc(arc.side, arc.start, arc.angle, arc.velocity, drive, constants)


@njit(**INTERNAL_INLINE)
def drive_at(time, drive):
    """Return the forcing at a time since the start of the pulse."""
    return PulseDrive(time, drive.cosine, drive.sine)


@njit(**INTERNAL)
def arc_at_time(p, side, start, angle, velocity, time):
    """Return the arc that starts at a time since the start of the pulse, ``start`` on the clock."""
    # after the end the forcing is 0 at any phase
    phase_time = time if time < p.forcing.duration else 0.0
    arc = solution.arc_from(system_at(p, time), side, phase_time, angle, velocity)
    constants = PulseConstants(arc.constants.psi, arc.constants.acceleration)
    return Arc(side, start, angle, velocity, drive_at(time, arc.drive), constants)


@njit(**INTERNAL)
def evaluate(p, arc, t):
    """Return the ``Instant`` of an arc at a time t >= 0 after its start."""
    now = solution.evaluate(system_at(p, arc.drive.time), harmonic_arc(arc), t)
    drive = drive_at(arc.drive.time + t, now.drive)
    return Instant(now.angle, now.risen, now.velocity, drive, now.sinh, now.versinh)


@njit(**INTERNAL)
def at_end(p, mode, arc, left):
    """Return what the end of the pulse, after the time ``left``, does to an arc without an event before."""
    end = PulseDrive(p.forcing.duration, 0.0, 0.0)
    if mode == FLIGHT:
        now = evaluate(p, arc, left)
        return Next(left, NONE, arc.side, now.angle, now.velocity, end, now.sinh, now.versinh)
    if mode == LEAN and p.block.brace_angle <= 1.0:
        return Next(left, LEAVE, arc.side, p.block.brace_angle, 0.0, end, 0.0, 0.0)
    return Next(math.inf, NONE, arc.side, arc.angle, 0.0, end, 0.0, 0.0)


@njit(**INTERNAL)
def next_event(p, mode, arc):
    """Find the next event of an arc: one of the harmonic motion before the end of the pulse, or that end."""
    time, left = arc.drive.time, p.forcing.duration - arc.drive.time
    coming, _ = harmonic.next_event(system_at(p, time), mode, harmonic_arc(arc), NONE_YET)
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
