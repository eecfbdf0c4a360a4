"""Base motion of the full block that is a piece of a cosine, and nothing afterwards.

Up to the end the functions are those of ``cosine_base``. From then on cos psi and sin psi of the drive are 0, and so is the base
acceleration. A step ends with the pulse at the latest.
"""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit, provide
from rocking.kernels.event_kinds import LEAVE, NONE
from rocking.kernels.forcing.arc import Arc, Next
from rocking.kernels.forcing.drives import FullHarmonicConstants, FullPulseConstants, FullPulseDrive
from rocking.kernels.forcing.full import base, cosine_base
from rocking.kernels.forcing.full.parameters import FullPulseParameters
from rocking.kernels.forcing.harmonic import next_event


@njit(**INTERNAL_INLINE)
def drive_at(p, time):
    """Return the drive at a time since the start of the pulse."""
    left = p.forcing.duration - time
    if left <= 0.0:
        return FullPulseDrive(left, 0.0, 0.0)
    whole = cosine_base.drive_on_clock(p, 0, time)
    return FullPulseDrive(left, whole.cosine, whole.sine)


@njit(**INTERNAL_INLINE)
def smooth_time(p, drive):
    """Provide ``base.smooth_time``: to the end of the pulse."""
    return drive.left if drive.left > 0.0 else math.inf


@njit(**INTERNAL_INLINE)
def drive_later(p, drive, time, to_corner):
    """Provide ``base.drive_later``."""
    left = 0.0 if to_corner else drive.left - time
    if left <= 0.0:
        return FullPulseDrive(left, 0.0, 0.0)
    whole = cosine_base.drive_later(p, drive, time, to_corner)
    return FullPulseDrive(left, whole.cosine, whole.sine)


@njit(**INTERNAL_INLINE)
def drive_on_clock(p, cycle, start):
    """Provide ``base.drive_on_clock``."""
    return drive_at(p, cycle * p.clock.cycle_length + start)


@njit(**INTERNAL)
def largest_ahead(p, side, drive):
    """Provide ``base.largest_ahead``: the amplitude if a crest is still to come, else the present or the last value."""
    if drive.left <= 0.0:
        return 0.0
    turn = p.forcing.frequency * drive.left
    to_crest = -math.atan2(side * drive.sine, side * drive.cosine)
    if (to_crest if to_crest >= 0.0 else to_crest + 2.0 * math.pi) <= turn:
        return p.forcing.amplitude
    last = drive.cosine * math.cos(turn) - drive.sine * math.sin(turn)
    return p.forcing.amplitude * max(side * drive.cosine, side * last, 0.0)


@njit(**INTERNAL_INLINE)
def largest_near(p, drive, radius):
    """Provide ``base.largest_near``."""
    return cosine_base.largest_near(p, drive, radius) if drive.left > 0.0 else 0.0


@njit(**INTERNAL_INLINE)
def whole_arc(p, arc):
    """Return the arc with its start on the clock of the whole cosine."""
    time = p.forcing.duration - arc.drive.left
    phase = FullHarmonicConstants(cosine_base.phase_at(p, time))
    return Arc(arc.side, time, arc.angle, arc.velocity, arc.drive, phase)


@njit(**INTERNAL)
def lift_off(p, arc):
    """Provide ``base.lift_off``: that of the whole cosine, if it comes before the end."""
    begun = whole_arc(p, arc)
    whole = cosine_base.lift_off(p, begun)
    if whole.wait < arc.drive.left:
        drive = drive_at(p, begun.start + whole.wait)
        return Next(whole.wait, whole.event, whole.side, 0.0, 0.0, drive, 0.0, 0.0)
    return Next(math.inf, NONE, arc.side, 0.0, 0.0, arc.drive, 0.0, 0.0)


@njit(**INTERNAL)
def departure(p, arc):
    """Provide ``base.departure``: that under the whole cosine, if it comes before the end; at the end, if the brace is below balance."""
    brace, left = p.block.brace_angle, max(arc.drive.left, 0.0)
    whole = whole_arc(p, arc)
    found = cosine_base.departure(p, whole)
    wait, falls = found.wait, brace < 1.0
    if not wait < left:
        wait = left if falls else math.inf
    if wait == math.inf:
        return Next(wait, NONE, arc.side, brace, 0.0, arc.drive, 0.0, 0.0)
    drive = FullPulseDrive(0.0, 0.0, 0.0) if wait == left else drive_at(p, whole.start + wait)
    return Next(wait, LEAVE, arc.side, brace, 0.0, drive, 0.0, 0.0)


@njit(**INTERNAL_INLINE)
def stays_at_brace(p, arc):
    """Provide ``base.stays_at_brace``; after the pulse a block in balance stays, too."""
    if arc.drive.left <= 0.0:
        return p.block.brace_angle >= 1.0
    return next_event.stays_leaning(p.forcing.resting, whole_arc(p, arc))


@njit(**INTERNAL_INLINE)
def side_to_lift_at(p, start, drive):
    """Provide ``base.side_to_lift_at``."""
    time = p.forcing.duration - drive.left
    return cosine_base.side_to_lift_at(p, time, drive) if drive.left > 0.0 else 0


@njit(**INTERNAL)
def change_within(p, drive, time):
    """Provide ``base.change_within``: at the end of the pulse the base acceleration vanishes."""
    if drive.left <= 0.0:
        return 0.0
    changed = cosine_base.change_within(p, drive, time)
    return changed if time < drive.left else max(changed, abs(cosine_base.acceleration_of(p, drive)))


@njit(**INTERNAL_INLINE)
def drive_after_event(p, start, coming):
    """Provide ``base.drive_after_event``: from the clock, whose whole cycles follow from the time of the event."""
    length = p.clock.cycle_length
    cycle = round((p.forcing.duration - coming.drive.left - start) / length)
    return drive_on_clock(p, cycle, start)


@njit(**INTERNAL_INLINE)
def constants_at(p, start, drive):
    """Provide ``base.constants_at``."""
    return FullPulseConstants(cosine_base.acceleration_of(p, drive))


@njit(**INTERNAL_INLINE)
def has_ended(p, drive):
    """Provide ``finite.has_ended``."""
    return drive.left <= 0.0


provide(
    FullPulseParameters,
    {
        base.series_from: cosine_base.series_from,
        base.transfer_series: cosine_base.transfer_series,
        base.acceleration_of: cosine_base.acceleration_of,
        base.smooth_time: smooth_time,
        base.drive_later: drive_later,
        base.drive_on_clock: drive_on_clock,
        base.largest_ahead: largest_ahead,
        base.largest_within: cosine_base.largest_within,
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
