"""Harmonic base motion of the full block."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit, provide
from rocking.kernels.event_kinds import LEAVE, LIFT_OFF, NONE
from rocking.kernels.forcing.arc import Next
from rocking.kernels.forcing.drives import FullHarmonicConstants, FullHarmonicDrive
from rocking.kernels.forcing.full import base
from rocking.kernels.forcing.full.parameters import FullHarmonicParameters
from rocking.kernels.forcing.full.series import cosine_series, cosine_transfer, short_cosine_series
from rocking.kernels.forcing.harmonic import next_event
from rocking.kernels.numerics.elementary import circular, exponential_bound


@njit(**INTERNAL_INLINE)
def series_from(p, side, slope, sine, cosine, drive, short):
    """Provide ``base.series_from``."""
    size, scale = side * p.block.critical_angle * p.forcing.amplitude, -1.0 / p.block.critical_angle
    g, h, frequency = size * drive.cosine, size * drive.sine, p.forcing.frequency
    if short:
        return short_cosine_series(slope, sine, cosine, scale, g, h, frequency)
    return cosine_series(slope, sine, cosine, scale, g, h, frequency)


@njit(**INTERNAL_INLINE)
def transfer_series(p, side, slope, sine, cosine, drive):
    """Provide ``base.transfer_series``."""
    size = side * p.block.critical_angle * p.forcing.amplitude
    return cosine_transfer(slope, sine, cosine, size * drive.cosine, size * drive.sine, p.forcing.frequency)


@njit(**INTERNAL_INLINE)
def acceleration_of(p, drive):
    """Provide ``base.acceleration_of``."""
    return p.forcing.amplitude * drive.cosine


@njit(**INTERNAL_INLINE)
def smooth_time(p, drive):
    """Provide ``base.smooth_time``."""
    return math.inf


@njit(**INTERNAL_INLINE)
def drive_later(p, drive, time, to_corner):
    """Provide ``base.drive_later``."""
    sine, versine, _, _ = circular(p.forcing.frequency, time)
    cosine = 1.0 - versine
    return FullHarmonicDrive(
        drive.cosine * cosine - drive.sine * sine, drive.sine * cosine + drive.cosine * sine
    )


@njit(**INTERNAL_INLINE)
def phase_at(p, start):
    """Return the forcing phase at a time within a cycle."""
    return p.forcing.frequency * start + p.forcing.phase


@njit(**INTERNAL_INLINE)
def drive_on_clock(p, cycle, start):
    """Provide ``base.drive_on_clock``."""
    psi = phase_at(p, start)
    return FullHarmonicDrive(math.cos(psi), math.sin(psi))


@njit(**INTERNAL_INLINE)
def largest_ahead(p, side, drive):
    """Provide ``base.largest_ahead``."""
    return p.forcing.amplitude


@njit(**INTERNAL_INLINE)
def largest_within(p, drive, time):
    """Provide ``base.largest_within``."""
    return p.forcing.amplitude


@njit(**INTERNAL_INLINE)
def largest_near(p, drive, radius):
    """Provide ``base.largest_near``."""
    amplitude = p.forcing.amplitude
    return amplitude * exponential_bound(p.forcing.frequency * radius) if amplitude > 0.0 else 0.0


@njit(**INTERNAL)
def lift_off(p, arc):
    """Provide ``base.lift_off``."""
    wait, side = next_event.wait_at_rest(p.forcing.resting, phase_at(p, arc.start))
    event = LIFT_OFF if wait < math.inf else NONE
    return Next(wait, event, side, 0.0, 0.0, arc.drive, 0.0, 0.0)


@njit(**INTERNAL)
def departure(p, arc):
    """Provide ``base.departure``: that of the slender block which stays as long."""
    wait = next_event.wait_leaning(p.forcing.resting, arc.side, phase_at(p, arc.start))
    event = LEAVE if wait < math.inf else NONE
    return Next(wait, event, arc.side, p.block.brace_angle, 0.0, arc.drive, 0.0, 0.0)


@njit(**INTERNAL_INLINE)
def stays_at_brace(p, arc):
    """Provide ``base.stays_at_brace``."""
    return next_event.stays_leaning(p.forcing.resting, arc)


@njit(**INTERNAL_INLINE)
def side_to_lift_at(p, start, drive):
    """Provide ``base.side_to_lift_at``."""
    return next_event.side_to_lift(p.forcing.resting, start, drive)


@njit(**INTERNAL_INLINE)
def change_within(p, drive, time):
    """Provide ``base.change_within``: |A cos(psi + x) - A cos psi| <= A (|sin psi| x + x^2/2)."""
    x = p.forcing.frequency * time
    return p.forcing.amplitude * (abs(drive.sine) * x + 0.5 * x * x)


@njit(**INTERNAL_INLINE)
def drive_after_event(p, start, coming):
    """Provide ``base.drive_after_event``."""
    return drive_on_clock(p, 0, start)


@njit(**INTERNAL_INLINE)
def constants_at(p, start, drive):
    """Provide ``base.constants_at``."""
    return FullHarmonicConstants(phase_at(p, start))


provide(
    FullHarmonicParameters,
    {
        base.series_from: series_from,
        base.transfer_series: transfer_series,
        base.acceleration_of: acceleration_of,
        base.smooth_time: smooth_time,
        base.drive_later: drive_later,
        base.drive_on_clock: drive_on_clock,
        base.largest_ahead: largest_ahead,
        base.largest_within: largest_within,
        base.largest_near: largest_near,
        base.lift_off: lift_off,
        base.departure: departure,
        base.stays_at_brace: stays_at_brace,
        base.side_to_lift_at: side_to_lift_at,
        base.change_within: change_within,
        base.drive_after_event: drive_after_event,
        base.constants_at: constants_at,
    },
)
