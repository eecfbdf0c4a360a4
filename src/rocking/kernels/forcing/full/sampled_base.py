"""Sampled base motion of the full block."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit, provide
from rocking.kernels.forcing.arc import Arc, Next
from rocking.kernels.forcing.drives import (
    FullSampledConstants,
    FullSampledDrive,
    SampledConstants,
    SampledDrive,
)
from rocking.kernels.forcing.full import base
from rocking.kernels.forcing.full.parameters import FullSampledParameters
from rocking.kernels.forcing.full.series import linear_series, linear_transfer, short_linear_series
from rocking.kernels.forcing.sampled import held
from rocking.kernels.forcing.sampled.solution import (
    acceleration_at,
    interval,
    last_index,
    place_at,
)


@njit(**INTERNAL_INLINE)
def series_from(p, side, slope, sine, cosine, drive, short):
    """Provide ``base.series_from``."""
    alpha = p.block.critical_angle
    start, rate = interval(p, drive.index)
    size, scale = side * alpha, -1.0 / alpha
    now, change = size * (start + rate * drive.offset), size * rate
    if short:
        return short_linear_series(slope, sine, cosine, scale, now, change)
    return linear_series(slope, sine, cosine, scale, now, change)


@njit(**INTERNAL_INLINE)
def transfer_series(p, side, slope, sine, cosine, drive):
    """Provide ``base.transfer_series``."""
    start, rate = interval(p, drive.index)
    size = side * p.block.critical_angle
    return linear_transfer(slope, sine, cosine, size * (start + rate * drive.offset), size * rate)


@njit(**INTERNAL_INLINE)
def acceleration_of(p, drive):
    """Provide ``base.acceleration_of``."""
    return acceleration_at(p, drive)


@njit(**INTERNAL_INLINE)
def smooth_time(p, drive):
    """Provide ``base.smooth_time``: to the next sample."""
    return max(p.forcing.tables.step - drive.offset, 0.0) if drive.index < last_index(p) else math.inf


@njit(**INTERNAL_INLINE)
def drive_later(p, drive, time, to_corner):
    """Provide ``base.drive_later``."""
    if to_corner:
        return FullSampledDrive(drive.index + 1, 0.0)
    return FullSampledDrive(drive.index, drive.offset + time)


@njit(**INTERNAL_INLINE)
def drive_on_clock(p, cycle, start):
    """Provide ``base.drive_on_clock``."""
    place = place_at(p, 0, max(cycle * p.clock.cycle_length + start, 0.0))
    return FullSampledDrive(place.index, place.offset)


@njit(**INTERNAL_INLINE)
def largest_ahead(p, side, drive):
    """Provide ``base.largest_ahead``: the largest of all samples, 0 after the last."""
    return abs(p.forcing.scale) * p.forcing.tables.largest if drive.index < last_index(p) else 0.0


@njit(**INTERNAL_INLINE)
def largest_within(p, drive, time):
    """Provide ``base.largest_within``."""
    start, rate = interval(p, drive.index)
    return abs(start + rate * drive.offset) + abs(rate) * time


@njit(**INTERNAL_INLINE)
def largest_near(p, drive, radius):
    """Provide ``base.largest_near``: the bound on a line is that on a circle, too."""
    return largest_within(p, drive, radius)


@njit(**INTERNAL_INLINE)
def resting_arc(arc):
    """Return the arc of the slender block that rests, or stays at its brace, as long as the full one does."""
    place = SampledDrive(arc.drive.index, arc.drive.offset)
    return Arc(arc.side, arc.start, arc.angle, arc.velocity, place, SampledConstants(0.0, 0.0))


@njit(**INTERNAL)
def lift_off(p, arc):
    """Provide ``base.lift_off``: that of the slender block which rests as long."""
    found = held.lift_off(p.forcing.resting, resting_arc(arc))
    drive = FullSampledDrive(found.drive.index, found.drive.offset)
    return Next(found.wait, found.event, found.side, 0.0, 0.0, drive, 0.0, 0.0)


@njit(**INTERNAL)
def departure(p, arc):
    """Provide ``base.departure``: that of the slender block which stays as long."""
    found = held.departure(p.forcing.resting, resting_arc(arc))
    drive = FullSampledDrive(found.drive.index, found.drive.offset)
    return Next(found.wait, found.event, arc.side, p.block.brace_angle, 0.0, drive, 0.0, 0.0)


@njit(**INTERNAL_INLINE)
def stays_at_brace(p, arc):
    """Provide ``base.stays_at_brace``."""
    return held.stays_leaning(p.forcing.resting, resting_arc(arc))


@njit(**INTERNAL_INLINE)
def side_to_lift_at(p, start, drive):
    """Provide ``base.side_to_lift_at``."""
    return held.side_to_lift(p.forcing.resting, start, drive)


@njit(**INTERNAL_INLINE)
def change_within(p, drive, time):
    """Provide ``base.change_within``."""
    return held.change_bound(p, drive, time)


@njit(**INTERNAL_INLINE)
def drive_after_event(p, start, coming):
    """Provide ``base.drive_after_event``."""
    return coming.drive


@njit(**INTERNAL_INLINE)
def constants_at(p, start, drive):
    """Provide ``base.constants_at``."""
    return FullSampledConstants(acceleration_at(p, drive))


provide(
    FullSampledParameters,
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
