"""Extrema of the angle along an arc under a sampled base acceleration.

u' obeys w'' - w = f', and f' is constant between two samples. So each interval is decided by ``segment.first_zero``.
"""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE
from rocking.kernels.forcing.arc import CROSSING, LATER, within_reach
from rocking.kernels.forcing.drives import SampledDrive
from rocking.kernels.forcing.extrema import arc_peak, first_turn_sign
from rocking.kernels.forcing.sampled.bounds import largest_push, reach_over
from rocking.kernels.forcing.sampled.search import MAX_STEP
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
# Least (1 - u)^2 at a maximum: below it, rounding of the square exceeds the margin of its root.
BARELY = 1e-6
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
def highest_sample(p, arc, first, last):
    """Return the largest angle of an arc at the samples from ``first`` to ``last``, and the sample; -infinity if there is none."""
    growing, shrinking = at_first(p, arc)
    highest, place = -math.inf, first
    for index in range(first, last + 1):
        angle, _ = state_at_sample(p, arc.side, index, growing, shrinking)
        if angle > highest:
            highest, place = angle, index
        growing, shrinking = growing * p.forcing.tables.growth, shrinking * p.forcing.tables.decay
    return highest, place


@njit(**INTERNAL_INLINE)
def at_first(p, arc):
    """Return K+ e^t and K- e^-t at the first sample after the start of an arc."""
    grow = math.exp(p.forcing.tables.step - arc.drive.offset)
    return arc.constants.grow * grow, arc.constants.shrink / grow


@njit(**INTERNAL)
def largest_turn(p, arc, sign, begun, ended, peak):
    """Return the largest of ``peak`` and the maxima of the angle between two times; ``sign`` is that of u' at the first."""
    turn = begun
    if sign < 0.0:
        found, turn, _ = next_turn(p, arc, -1.0, begun, ended)
        if found != CROSSING:
            return peak
    found, _, now = next_turn(p, arc, 1.0, turn, ended)
    return max(peak, within_reach(p, now.angle)) if found == CROSSING else peak


@njit(**INTERNAL_INLINE)
def may_peak(rate, bend, later_rate, later_bend):
    """Return whether u may have a maximum between two instants of an interval, from u' and u'' at both.

    y = u'' obeys y'' = y, so that it changes its sign once at most, and u' twice.
    """
    if (rate > 0.0) == (later_rate > 0.0):
        return (bend > 0.0) != (later_bend > 0.0)
    return rate > 0.0


@njit(**INTERNAL)
def largest_on(p, arc, until, peak):
    """Return the largest of ``peak`` and the angles of an arc up to the time ``until``.

    Only the intervals are searched in which the angle may have a maximum, and exceed ``peak`` and all samples by the bound of
    ``search``.
    """
    last, tables, end = last_index(p), p.forcing.tables, evaluate(p, arc, until)
    if tables.step >= MAX_STEP or end.drive.index >= last:
        return min(arc_peak(p, arc, until, peak), p.block.brace_angle)
    peak = max(peak, within_reach(p, end.angle))
    first = arc.drive.index + 1
    highest, place = highest_sample(p, arc, first, end.drive.index)
    if highest > peak * (1.0 - MARGIN):
        now = evaluate(p, arc, time_between(p, arc.drive, SampledDrive(place, 0.0)))
        peak = max(peak, within_reach(p, now.angle))
    force = 1.0 + abs(p.forcing.scale) * tables.largest
    growing, shrinking = at_first(p, arc)
    place, angle, velocity = arc.drive, arc.angle, first_turn_sign(p, arc)
    for index in range(first, end.drive.index + 2):
        ended, after, rate = end.drive, end.angle, end.velocity
        if index <= end.drive.index:
            ended = SampledDrive(index, 0.0)
            after, rate = state_at_sample(p, arc.side, index, growing, shrinking)
        larger = max(angle, after)
        if larger + tables.single.bend * (larger + force) > peak * (1.0 - MARGIN):
            push, change = forcing_on(p, arc.side, place.index)
            bend, later_bend = angle + (push + change * place.offset), after + push
            later_bend += change * (tables.step if ended.index > place.index else ended.offset)
            if may_peak(velocity, bend, rate, later_bend):
                begun, over = time_between(p, arc.drive, place), time_between(p, arc.drive, ended)
                peak = largest_turn(p, arc, velocity, begun, over, peak)
        place, angle, velocity = ended, after, rate
        growing, shrinking = growing * tables.growth, shrinking * tables.decay
    return min(peak, p.block.brace_angle)


@njit(**INTERNAL_INLINE)
def free_top(arc):
    """Return a bound of u on an arc that starts after the last sample: (1 - u)^2 - u'^2 is constant. Infinite if it may overturn."""
    least = (1.0 - arc.angle) * (1.0 - arc.angle) - arc.velocity * arc.velocity
    if not (arc.velocity > 0.0 and arc.angle < 1.0 and least > BARELY):
        return math.inf
    return (
        (arc.angle * (2.0 - arc.angle) + arc.velocity * arc.velocity)
        / (1.0 + math.sqrt(least))
        * (1.0 + MARGIN)
    )


@njit(**INTERNAL_INLINE)
def largest_before(p, arc, coming, reached):
    """Provide ``finite.largest_before``: ``reached`` is the largest u of both ends of the arc and of the samples that were passed.

    Two of these are at most a stride apart, or as long as the arc if that is less. For times t within a stride, the bound of
    ``reach_over`` is convex in t^2 and 0 at 0.
    """
    tables, last = p.forcing.tables, last_index(p)
    if arc.drive.index >= last:
        return free_top(arc)
    if coming.drive.index >= last or tables.step >= MAX_STEP:
        return math.inf
    part = min(coming.wait / (tables.stride * tables.step), 1.0)
    return reached + part * part * reach_over(tables.several, reached, reached, largest_push(p))


@njit(**INTERNAL)
def peak_with(p, arc, coming, peak):
    """Return the largest of ``peak`` and the angles of an arc up to the event that ends it."""
    return p.block.brace_angle if coming.event == BRACE else largest_on(p, arc, coming.wait, peak)
