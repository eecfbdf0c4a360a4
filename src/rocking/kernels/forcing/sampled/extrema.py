"""Extrema of the angle along an arc under a sampled base acceleration.

u' obeys w'' - w = f', and f' is constant between two samples. So each interval is decided by ``segment.first_zero``.
"""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE
from rocking.kernels.forcing.arc import CROSSING, LATER, within_reach
from rocking.kernels.forcing.drives import SampledDrive
from rocking.kernels.forcing.extrema import arc_peak
from rocking.kernels.forcing.sampled.segment import Piece, at, first_zero
from rocking.kernels.forcing.sampled.solution import (
    evaluate,
    forcing_on,
    last_index,
    place_at,
    state_at_sample,
    state_in,
    time_between,
)

# After an extremum the search starts later by this fraction of the time, and by ever more, so that rounding cannot find the
# same extremum again.
PASSED = 2.0**-50
# Relative safety margin of a bound over rounding.
MARGIN = 1e-12


@njit(**INTERNAL)
def next_turn(p, arc, sign, t, until):
    """Find the next extremum of the angle after t, where sign u' falls through zero, one interval after another.

    Returns
    -------
    tuple of (int, float, Instant)
        Result, as in ``arc.Found``, with its time and the state there.
    """
    start, passed = t, PASSED * (1.0 + t)
    last, step = last_index(p), p.forcing.tables.step
    while True:
        drive = place_at(p, arc.drive.index, arc.drive.offset + start)
        at_time = start
        while at_time < until:
            angle, velocity = state_in(p, arc, drive, at_time)
            force, rate = forcing_on(p, arc.side, drive.index)
            second = angle + (force + rate * drive.offset)
            length = until - at_time
            if drive.index < last:
                length = min(step - drive.offset, length)
            # w = sign u': w' = sign u'' and w'' - w = sign f'
            w = sign * velocity
            if w < 0.0 and at_time == start:
                w = 0.0  # the extremum before, to rounding
            turn = Piece(w, sign * second, sign * rate, 0.0)
            x, _ = first_zero(turn, length, at(turn, length))
            if x < math.inf and at_time + x > t:
                return CROSSING, at_time + x, evaluate(p, arc, at_time + x)
            if x < math.inf:
                break
            if drive.index >= last:
                return LATER, until, evaluate(p, arc, until)
            drive = SampledDrive(drive.index + 1, 0.0)
            at_time = time_between(p, arc.drive, drive)
        if at_time >= until:
            return LATER, until, evaluate(p, arc, until)
        start += passed
        passed *= 2.0
        if start >= until:
            return LATER, until, evaluate(p, arc, until)


@njit(**INTERNAL)
def largest_on(p, arc, until, peak):
    """Return the largest of ``peak`` and the angles of an arc up to the time ``until``.

    If no sample comes within the possible rise between two samples, ``peak`` is the largest.
    """
    last, step, brace = last_index(p), p.forcing.tables.step, p.block.brace_angle
    end = evaluate(p, arc, until)
    peak = max(peak, within_reach(p, end.angle))
    largest, index = max(arc.angle, end.angle), arc.drive.index + 1
    force = 1.0 + abs(p.forcing.scale) * p.forcing.tables.largest
    grow = math.exp(step - arc.drive.offset)
    step_growth = math.exp(step)
    growing, shrinking = arc.constants.grow * grow, arc.constants.shrink / grow
    while index <= min(end.drive.index, last):
        angle, _ = state_at_sample(p, arc.side, index, growing, shrinking)
        largest = max(largest, angle)
        growing, shrinking = growing * step_growth, shrinking / step_growth
        index += 1
    quarter = 0.125 * step * step
    if quarter < 0.5 and end.drive.index < last and arc.drive.index + 1 < end.drive.index:
        rise = quarter / (1.0 - quarter) * (largest + force)
        if (largest + rise) * (1.0 + MARGIN) <= peak:
            return peak
    return min(arc_peak(p, arc, until, peak), brace)


@njit(**INTERNAL)
def peak_with(p, arc, coming, peak):
    """Return the largest of ``peak`` and the angles of an arc up to the event that ends it."""
    return p.block.brace_angle if coming.event == BRACE else largest_on(p, arc, coming.wait, peak)
