"""Extrema of the angle along an arc under a sampled base acceleration.

u' obeys w'' - w = f', and f' is constant between two samples. So each interval is decided by ``first_zero_samples.first_zero``.
"""

import math

from rocking.kernels import contract
from rocking.kernels.arc.arc import CROSSING, LATER, arc_peak, first_turn_sign, next_turn, within_reach
from rocking.kernels.arc.first_zero_samples import Piece, at, first_zero
from rocking.kernels.arc.search_samples import MAX_STEP, largest_push, reach_over
from rocking.kernels.arc.slender_samples import evaluate, forcing_on, state_at_sample, state_in
from rocking.kernels.base.samples import SampledDrive, Samples, last_index, place_at, time_between
from rocking.kernels.event_kinds import BRACE
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import exponential
from rocking.kernels.system import Slender

# Least (1 - u)^2 at a maximum: below it, rounding of the square exceeds the margin of its root.
BARELY = 1e-6
# Relative safety margin of a bound over rounding.
MARGIN = 1e-12


@body(contract.turn_from, Slender, Samples)
def turn_from(p, arc, sign, start, until):
    """Provide ``contract.turn_from``, one interval after another."""
    last, step, t = last_index(p), p.forcing.tables.step, start
    drive = place_at(p, arc.drive.index, arc.drive.offset + start)
    while t < until:
        angle, velocity = state_in(p, arc, drive, t)
        force, rate = forcing_on(p, arc.side, drive.index)
        second, length = angle + (force + rate * drive.offset), until - t
        if drive.index < last:
            length = min(step - drive.offset, length)
        # w = sign u': w' = sign u'' and w'' - w = sign f'
        w = sign * velocity
        if w < 0.0 and t == start:
            w = 0.0  # the extremum before, to rounding
        turn = Piece(w, sign * second, sign * rate, 0.0)
        x, _ = first_zero(turn, length, at(turn, length))
        if x < math.inf:
            return CROSSING, t + x, evaluate(p, arc, t + x)
        if drive.index >= last:
            break
        drive = SampledDrive(drive.index + 1, 0.0)
        t = time_between(p, arc.drive, drive)
    return LATER, until, evaluate(p, arc, until)


@kernel
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


@kernel(inline=True)
def at_first(p, arc):
    """Return K+ e^t and K- e^-t at the first sample after the start of an arc."""
    grow = exponential(p.forcing.tables.step - arc.drive.offset)
    return arc.constants.grow * grow, arc.constants.shrink / grow


@kernel
def largest_turn(p, arc, sign, begun, ended, peak):
    """Return the largest of ``peak`` and the maxima of the angle between two times; ``sign`` is that of u' at the first."""
    turn = begun
    if sign < 0.0:
        found, turn, _ = next_turn(p, arc, -1.0, begun, ended)
        if found != CROSSING:
            return peak
    found, _, now = next_turn(p, arc, 1.0, turn, ended)
    return max(peak, within_reach(p, now.angle)) if found == CROSSING else peak


@kernel(inline=True)
def may_peak(rate, bend, later_rate, later_bend):
    """Return whether u may have a maximum between two instants of an interval, from u' and u'' at both.

    y = u'' obeys y'' = y, so that it changes its sign once at most, and u' twice.
    """
    if (rate > 0.0) == (later_rate > 0.0):
        return (bend > 0.0) != (later_bend > 0.0)
    return rate > 0.0


@body(contract.largest_on, Slender, Samples)
def largest_on(p, arc, until, peak):
    """Return the largest of ``peak`` and the angles of an arc up to the time ``until``.

    Only the intervals are searched in which the angle may have a maximum, and exceed ``peak`` and all samples by the bound of
    ``search_samples``.
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


@kernel(inline=True)
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


@body(contract.largest_before, Slender, Samples, inline=True)
def largest_before(p, arc, coming, reached):
    """Provide ``contract.largest_before``: ``reached`` is the largest u of both ends of the arc and of the samples that were passed.

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


@body(contract.peak_with, Slender, Samples)
def peak_with(p, arc, coming, peak):
    """Return the largest of ``peak`` and the angles of an arc up to the event that ends it."""
    return p.block.brace_angle if coming.event == BRACE else largest_on(p, arc, coming.wait, peak)
