"""Rest and contact with a brace of the slender block: when they end, by a lift-off or a departure, under a cosine and under samples."""

import math
from typing import NamedTuple

from rocking.kernels import contract
from rocking.kernels.arc.arc import Next, nothing_more
from rocking.kernels.base.cosine import Cosine, HarmonicDrive, first_sign_change, next_sign_change
from rocking.kernels.base.samples import (
    BLOCK,
    SampledDrive,
    Samples,
    acceleration_at,
    interval,
    last_index,
    time_between,
)
from rocking.kernels.event_kinds import LEAVE, LIFT_OFF, NONE, REST
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import arccosine
from rocking.kernels.system import Slender

# Forcing at events that are computed from the clock again.
UNKNOWN = HarmonicDrive(0.0, 0.0)


@kernel(inline=True)
def until_window(p, side, psi, half, inside):
    """Return the time until eta next enters |eta| < half (``inside``) or leaves it.

    The time is 0 in the first half of that window. A block that is still held in the second half of a window
    came back at its very end, before the clock advanced. It waits for the next window.
    """
    sign_change, now_inside = first_sign_change(p, side, psi, 0.0, half)
    if now_inside != inside:
        return sign_change
    return (
        0.0
        if sign_change > 0.5 * next_sign_change(p, half, inside)
        else sign_change + next_sign_change(p, half, not inside)
    )


@kernel(inline=True)
def half_at(p, level):
    """Return the half width of the sign interval in which A cos eta > -level; infinite if that is always so."""
    if level == 1.0:
        return p.forcing.base_half
    return arccosine(-level / p.forcing.amplitude) if p.forcing.amplitude > level else math.inf


@kernel
def wait_at_rest(p, psi, left_level):
    """Return the time until a block at rest lifts off, when -A cos psi rises through 1 or A cos psi through ``left_level``.

    Returns
    -------
    tuple of (float, int)
        The time, infinite if neither happens, and the side of the lift-off.
    """
    right, left, left_half = math.inf, math.inf, half_at(p, left_level)
    if p.forcing.base_half < math.inf:
        right = until_window(p, 1, psi, p.forcing.base_half, False)
    if left_half < math.inf:
        left = until_window(p, -1, psi, left_half, False)
    return (right, 1) if right < left or left == math.inf else (left, -1)


@kernel
def wait_leaning(p, side, psi):
    """Return the time until a block leaves its brace, when brace_angle + f falls through 0; infinite if never."""
    if p.forcing.brace_half == math.inf:
        return math.inf
    return until_window(p, side, psi, p.forcing.brace_half, True)


@body(contract.resting, Slender, inline=True)
def resting(p):
    """Provide ``contract.resting``."""
    return p, 1.0


@kernel(inline=True)
def side_to_lift(p, start, drive):
    """Return the side to which a block at rest lifts now, where f > 0; 0 if it stays."""
    q, left_level = contract.resting(p)
    return contract.side_above(q, start, drive, left_level)


@body(contract.side_above, Slender, Cosine)
def side_above(p, start, drive, left_level):
    """Provide ``contract.side_above``."""
    psi = p.forcing.frequency * start + p.forcing.phase
    for side, level in ((1, 1.0), (-1, left_level)):
        half = half_at(p, level)
        if half < math.inf and not first_sign_change(p, side, psi, 0.0, half)[1]:
            return side
    return 0


@body(contract.lift_off, Slender, Cosine)
def lift_off(p, arc, left_level):
    """Provide ``contract.lift_off``."""
    wait, side = wait_at_rest(p, arc.constants.psi, left_level)
    return Next(wait, LIFT_OFF if wait < math.inf else NONE, side, 0.0, 0.0, UNKNOWN, 0.0, 0.0)


@body(contract.stays_leaning, Slender, Cosine)
def stays_leaning(p, arc):
    """Return whether a block at rest at the brace is pressed against it: brace_angle + f > 0."""
    if p.forcing.brace_half == math.inf:
        return p.block.brace_angle > 1.0
    return not first_sign_change(p, arc.side, arc.constants.psi, 0.0, p.forcing.brace_half)[1]


@body(contract.held_event, Slender, Cosine)
def held_event(p, mode, arc):
    """Provide ``contract.held_event``."""
    if mode == REST:
        return lift_off(p, arc, 1.0)
    wait = wait_leaning(p, arc.side, arc.constants.psi)
    event = LEAVE if wait < math.inf else NONE
    return Next(wait, event, arc.side, p.block.brace_angle, 0.0, UNKNOWN, 0.0, 0.0)


# Rounding error of the base acceleration between two samples, relative to its terms.
TOUCH = 2.0**-51


class Levels(NamedTuple):
    """Levels of a and of -a; infinite where only the other counts."""

    positive: float
    negative: float


@kernel(inline=True)
def side_beyond(levels, acceleration):
    """Return 1 if a exceeds its level, -1 if -a exceeds its own, else 0."""
    return 1 if acceleration > levels.positive else (-1 if -acceleration > levels.negative else 0)


@kernel
def next_sample_beyond(p, levels, index):
    """Return the first sample from ``index`` on that is beyond a level; the number of samples if there is none.

    Blocks whose largest |a| does not exceed the lower level are skipped.
    """
    tables, scale, least = p.forcing.tables, p.forcing.scale, min(levels.positive, levels.negative)
    count = tables.knots.shape[0]
    while index < count:
        if index % BLOCK == 0 and abs(scale) * tables.blocks[index // BLOCK] <= least:
            index += BLOCK
            continue
        if side_beyond(levels, scale * tables.samples[index]) != 0:
            return index
        index += 1
    return count


@kernel(inline=True)
def only_touches(p, side, level, drive):
    """Return whether side * a is the level to rounding, and does not grow: a block that lifts here returns at once."""
    start, rate = interval(p, drive.index)
    moved = rate * drive.offset
    beyond = side * (start + moved) - level
    return not side * rate > 0.0 and beyond <= TOUCH * (abs(start) + abs(moved) + abs(level))


@kernel
def rises_beyond(p, levels, drive):
    """Return the first place from ``drive`` on where the base acceleration is beyond one of the levels.

    Returns
    -------
    tuple of (int, SampledDrive)
        The sign of a there; 0 if there is no such place before the last sample or at it.
        The place.
    """
    last, step, (positive, negative) = last_index(p), p.forcing.tables.step, levels
    if drive.index >= last:
        return 0, drive
    side = side_beyond(levels, acceleration_at(p, drive))
    if side != 0 and not only_touches(p, side, positive if side > 0 else negative, drive):
        return side, drive
    clear = Levels(positive + TOUCH * abs(positive), negative + TOUCH * abs(negative))
    after = next_sample_beyond(p, clear, drive.index + 1)
    if after > last:
        return 0, drive
    side = side_beyond(clear, p.forcing.scale * p.forcing.tables.samples[after])
    start, rate = interval(p, after - 1)
    offset = (side * (positive if side > 0 else negative) - start) / rate
    least = drive.offset if after - 1 == drive.index else 0.0
    return side, SampledDrive(after - 1, min(max(offset, least), step))


@body(contract.lift_off, Slender, Samples)
def lift_off_under_samples(p, arc, left_level):
    """Provide ``contract.lift_off``."""
    side, drive = rises_beyond(p, Levels(left_level, 1.0), arc.drive)
    if side == 0:
        return nothing_more(arc.side, arc.drive)
    return Next(time_between(p, arc.drive, drive), LIFT_OFF, -side, 0.0, 0.0, drive, 0.0, 0.0)


@kernel
def departure(p, arc):
    """Return the departure that ends a contact with a brace, when brace_angle + f falls through 0."""
    level, brace = p.block.brace_angle - 1.0, p.block.brace_angle
    levels = Levels(level, math.inf) if arc.side > 0 else Levels(math.inf, level)
    side, drive = rises_beyond(p, levels, arc.drive)
    if side == 0:
        if level >= 0.0:
            return Next(math.inf, NONE, arc.side, brace, 0.0, arc.drive, 0.0, 0.0)
        last = last_index(p)
        drive = SampledDrive(last, 0.0) if arc.drive.index < last else arc.drive
    return Next(time_between(p, arc.drive, drive), LEAVE, arc.side, brace, 0.0, drive, 0.0, 0.0)


@body(contract.side_above, Slender, Samples)
def side_above_under_samples(p, start, drive, left_level):
    """Provide ``contract.side_above``."""
    return -side_beyond(Levels(left_level, 1.0), acceleration_at(p, drive))


@body(contract.stays_leaning, Slender, Samples)
def stays_leaning_under_samples(p, arc):
    """Return whether a block at rest at the brace is pressed against it."""
    return arc.side * acceleration_at(p, arc.drive) < p.block.brace_angle - 1.0 or (
        p.block.brace_angle == 1.0 and arc.drive.index >= last_index(p)
    )


@body(contract.held_event, Slender, Samples)
def held_event_under_samples(p, mode, arc):
    """Provide ``contract.held_event``."""
    return lift_off_under_samples(p, arc, 1.0) if mode == REST else departure(p, arc)


# Relative error of a level of lift-off and of the base acceleration, that of their conversions included.
LEVEL_ERROR = 2.0**-49
# Within this time at a level the angle does not exceed LEVEL_ERROR times its square, and the block returns to rest.
SHORT = 2.0**-20


@kernel(inline=True)
def is_at(level, value):
    """Return whether a value equals a level up to rounding."""
    return (1.0 - LEVEL_ERROR) * level <= value <= (1.0 + LEVEL_ERROR) * level


@body(contract.holds_level, Slender, Cosine)
def cosine_holds_level(p, drive, coming, left_level):
    """Provide ``contract.holds_level``: a crest that exceeds a level by d is above it for sqrt(8 d / level) / frequency at most."""
    amplitude = abs(p.forcing.amplitude)
    is_slow = 4.0 * math.sqrt(LEVEL_ERROR) > SHORT * p.forcing.frequency
    return is_slow and (is_at(1.0, amplitude) or is_at(left_level, amplitude))


@body(contract.holds_level, Slender, Samples)
def samples_hold_level(p, drive, coming, left_level):
    """Provide ``contract.holds_level``: two samples in turn are at the level."""
    tables, scale, least = p.forcing.tables, p.forcing.scale, (1.0 - LEVEL_ERROR) * min(1.0, left_level)
    last = last_index(p) - 1
    if coming.wait < math.inf:
        last = min(coming.drive.index, last)
    index = drive.index
    while index <= last:
        if abs(scale) * tables.blocks[index // BLOCK] < least:
            index += BLOCK - index % BLOCK
            continue
        a, b = scale * tables.samples[index], scale * tables.samples[index + 1]
        if (is_at(1.0, -a) and is_at(1.0, -b)) or (is_at(left_level, a) and is_at(left_level, b)):
            return True
        index += 1
    return False


@kernel(seldom=True)
def rest_is_sure(p, arc, coming):
    """Return whether the end of a rest is the same, however the base acceleration and the levels of lift-off were rounded."""
    q, left_level = contract.resting(p)
    return not contract.holds_level(q, arc.drive, coming, left_level)


@kernel
def start_is_sure(p, arc):
    """Return whether a block at rest lifts off at the start of an arc, or not, however these were rounded."""
    return rest_is_sure(p, arc, Next(0.0, LIFT_OFF, arc.side, 0.0, 0.0, arc.drive, 0.0, 0.0))
