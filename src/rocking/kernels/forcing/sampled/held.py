"""Rest and contact with a brace under a sampled base acceleration: how long they last, and how fast a change may end them."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import LEAVE, LIFT_OFF, NONE
from rocking.kernels.forcing.arc import Next
from rocking.kernels.forcing.drives import SampledDrive
from rocking.kernels.forcing.sampled.search import nothing_more
from rocking.kernels.forcing.sampled.solution import (
    acceleration_at,
    interval,
    last_index,
    place_at,
    time_between,
)
from rocking.kernels.forcing.sampled.tables import BLOCK

# Rounding error of the base acceleration between two samples, relative to its terms.
TOUCH = 2.0**-51


@njit(**INTERNAL_INLINE)
def push(p, side, acceleration):
    """Return side * a; for ``side`` 0, |a|."""
    return abs(acceleration) if side == 0 else side * acceleration


@njit(**INTERNAL)
def next_sample_above(p, side, level, index):
    """Return the first sample from ``index`` on where ``push`` exceeds a level; the number of samples if there is none.

    Blocks whose largest |a| does not exceed the level are skipped.
    """
    tables, scale = p.forcing.tables, p.forcing.scale
    count = tables.knots.shape[0]
    while index < count:
        if index % BLOCK == 0 and abs(scale) * tables.blocks[index // BLOCK] <= level:
            index += BLOCK
            continue
        if push(p, side, scale * tables.samples[index]) > level:
            return index
        index += 1
    return count


@njit(**INTERNAL_INLINE)
def only_touches(p, side, level, drive):
    """Return whether ``push`` is that of the level to rounding, and does not grow: a block that lifts here returns at once."""
    start, rate = interval(p, drive.index)
    moved = rate * drive.offset
    now = start + moved
    grows = (now if side == 0 else side) * rate > 0.0
    return not grows and push(p, side, now) - level <= TOUCH * (abs(start) + abs(moved) + abs(level))


@njit(**INTERNAL)
def rises_above(p, side, level, drive):
    """Return the first place from ``drive`` on where ``push`` exceeds a level.

    Returns
    -------
    tuple of (bool, SampledDrive)
        Whether there is one, before the last sample or at it.
        The place.
    """
    last, step = last_index(p), p.forcing.tables.step
    if drive.index >= last:
        return False, drive
    if push(p, side, acceleration_at(p, drive)) > level and not only_touches(p, side, level, drive):
        return True, drive
    after = next_sample_above(p, side, level + TOUCH * abs(level), drive.index + 1)
    if after > last:
        return False, drive
    start, rate = interval(p, after - 1)
    turned = side if side != 0 else (1 if start + rate * step > 0.0 else -1)
    offset = (turned * level - start) / rate
    least = drive.offset if after - 1 == drive.index else 0.0
    return True, SampledDrive(after - 1, min(max(offset, least), step))


@njit(**INTERNAL)
def lift_off(p, arc):
    """Return the lift-off that ends a rest, when |a| rises through 1."""
    found, drive = rises_above(p, 0, 1.0, arc.drive)
    if not found:
        return nothing_more(arc.side, arc.drive)
    side = -1 if acceleration_at(p, drive) > 0.0 else 1
    return Next(time_between(p, arc.drive, drive), LIFT_OFF, side, 0.0, 0.0, drive, 0.0, 0.0)


@njit(**INTERNAL)
def departure(p, arc):
    """Return the departure that ends a contact with a brace, when brace_angle + f falls through 0."""
    level, brace = p.block.brace_angle - 1.0, p.block.brace_angle
    found, drive = rises_above(p, arc.side, level, arc.drive)
    if not found:
        if level >= 0.0:
            return Next(math.inf, NONE, arc.side, brace, 0.0, arc.drive, 0.0, 0.0)
        last = last_index(p)
        drive = SampledDrive(last, 0.0) if arc.drive.index < last else arc.drive
    return Next(time_between(p, arc.drive, drive), LEAVE, arc.side, brace, 0.0, drive, 0.0, 0.0)


@njit(**INTERNAL)
def side_to_lift(p, start, drive):
    """Return the side to which a block at rest lifts now, where f > 0; 0 if it stays."""
    acceleration = acceleration_at(p, drive)
    return 0 if abs(acceleration) <= 1.0 else (-1 if acceleration > 0.0 else 1)


@njit(**INTERNAL)
def stays_leaning(p, arc):
    """Return whether a block at rest at the brace is pressed against it."""
    return arc.side * acceleration_at(p, arc.drive) < p.block.brace_angle - 1.0 or (
        p.block.brace_angle == 1.0 and arc.drive.index >= last_index(p)
    )


@njit(**INTERNAL)
def change_bound(p, drive, time):
    """Provide ``contract.acceleration_change_bound``: the largest change at samples and at the end."""
    here, last, change = acceleration_at(p, drive), last_index(p), 0.0
    if drive.index >= last:
        return change
    end = place_at(p, drive.index, drive.offset + time)
    for index in range(drive.index + 1, end.index + 1):
        change = max(change, abs(p.forcing.scale * p.forcing.tables.samples[index] - here))
    return max(change, abs(acceleration_at(p, end) - here))
