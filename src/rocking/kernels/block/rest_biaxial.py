"""Rest of a block on a base that moves in two directions: it lifts where the push exceeds the level of lift-off times the weight.

To the right that is -a > w, to the left a > L w, with the left level L and the weight w. Both a and w are linear between samples, and
so is the excess of one over the other. There are no braces.
"""

import math
from typing import NamedTuple

from rocking.kernels import contract
from rocking.kernels.arc.arc import Next, nothing_more
from rocking.kernels.base.biaxial import Biaxial
from rocking.kernels.base.samples import SampledDrive, last_index, time_between
from rocking.kernels.block.rest import LEVEL_ERROR, TOUCH
from rocking.kernels.event_kinds import LIFT_OFF
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.system import Slender


class Excess(NamedTuple):
    """By how much a push exceeds its level times the weight, and the size of its terms."""

    value: float
    size: float


@kernel(inline=True)
def excess_at(p, side, level, index):
    """Return the ``Excess`` of a side at a sample."""
    push, weight = -side * p.forcing.scale * p.forcing.tables.samples[index], p.forcing.weights[index]
    return Excess(push - level * weight, abs(push) + level * (1.0 + abs(weight - 1.0)))


@kernel
def excess_along(p, side, level, drive):
    """Return the ``Excess`` at a place before the last sample, and its rate."""
    start, end = excess_at(p, side, level, drive.index), excess_at(p, side, level, drive.index + 1)
    rate = (end.value - start.value) / p.forcing.tables.step
    return Excess(start.value + rate * drive.offset, max(start.size, end.size)), rate


@kernel
def first_excess(p, side, level, drive):
    """Return whether the block lifts to a side before the last sample or at it, and the first place where it does.

    Where the excess is 0 to rounding and does not grow, a block that lifts returns at once: it does not lift.
    """
    last, step = last_index(p), p.forcing.tables.step
    if level == math.inf or drive.index >= last:
        return False, drive
    here, rate = excess_along(p, side, level, drive)
    if here.value > 0.0 and (rate > 0.0 or here.value > TOUCH * here.size):
        return True, drive
    for index in range(drive.index, last):
        end = excess_at(p, side, level, index + 1)
        if end.value > TOUCH * end.size:
            start = excess_at(p, side, level, index)
            offset = -start.value * step / (end.value - start.value) if end.value > start.value else 0.0
            least = drive.offset if index == drive.index else 0.0
            return True, SampledDrive(index, min(max(offset, least), step))
    return False, drive


@body(contract.lift_off, Slender, Biaxial)
def lift_off(p, arc, left_level):
    """Provide ``contract.lift_off``."""
    lifts, drive = first_excess(p, 1, 1.0, arc.drive)
    also, other = first_excess(p, -1, left_level, arc.drive)
    side = 1
    if also and not (lifts and time_between(p, drive, other) >= 0.0):
        side, drive = -1, other
    if not (lifts or also):
        return nothing_more(arc.side, arc.drive)
    return Next(time_between(p, arc.drive, drive), LIFT_OFF, side, 0.0, 0.0, drive, 0.0, 0.0)


@body(contract.side_above, Slender, Biaxial)
def side_above(p, start, drive, left_level):
    """Provide ``contract.side_above``."""
    if drive.index >= last_index(p):
        return 0
    if excess_along(p, 1, 1.0, drive)[0].value > 0.0:
        return 1
    return -1 if left_level < math.inf and excess_along(p, -1, left_level, drive)[0].value > 0.0 else 0


@kernel(inline=True)
def is_at_level(p, side, level, index):
    """Return whether the excess of a side is 0 at a sample, up to rounding."""
    if level == math.inf:
        return False
    here = excess_at(p, side, level, index)
    return abs(here.value) <= LEVEL_ERROR * here.size


@body(contract.holds_level, Slender, Biaxial)
def holds_level(p, drive, coming, left_level):
    """Provide ``contract.holds_level``: two samples in turn are at the level."""
    last = last_index(p) - 1
    if coming.wait < math.inf:
        last = min(coming.drive.index, last)
    for index in range(drive.index, last + 1):
        for side, level in ((1, 1.0), (-1, left_level)):
            if is_at_level(p, side, level, index) and is_at_level(p, side, level, index + 1):
                return True
    return False


@body(contract.stays_leaning, Slender, Biaxial, inline=True)
def stays_leaning(p, arc):
    """Provide ``contract.stays_leaning``: there are no braces."""
    return False


@body(contract.held_event, Slender, Biaxial, inline=True)
def held_event(p, mode, arc):
    """Provide ``contract.held_event``: there are no braces."""
    return lift_off(p, arc, 1.0)
