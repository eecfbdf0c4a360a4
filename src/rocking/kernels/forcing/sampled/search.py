"""Certified first event of an arc under a sampled base acceleration.

The first intervals are decided by ``segment.first_zero`` on the local closed form, which keeps the digits of short arcs.
They are the rest of the interval of the start, and FIRST more. From there on u and u' go from sample to sample, or over a
stride of several. Between two samples a time t apart u leaves its chord by at most t^2/8 max|u''|. With |u''| <= |u| + F,
F = 1 + max|a|, and ``bend`` = q/(1 - q), q = t^2/8,

    |u - chord| <= bend (max|u| + F),

with the larger |u| of both ends. So most strides contain no event. In the others each interval is decided by this bound, or
by ``segment.first_zero``. A step of MAX_STEP or more is decided interval by interval.
"""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE, IMPACT, NONE
from rocking.kernels.forcing.arc import MAX_ARC_TIME, NO_EXTREMES, Extremes, Next, with_low, with_reached
from rocking.kernels.forcing.drives import SampledDrive
from rocking.kernels.forcing.sampled.bounds import (
    is_clear,
    is_monotone,
    largest_push,
    never_returns,
    reach_over,
    rises_throughout,
)
from rocking.kernels.forcing.sampled.segment import Piece, at, first_zero, minimum
from rocking.kernels.forcing.sampled.solution import (
    across_step,
    along,
    last_index,
    piece_from,
    time_between,
)

FIRST = 2
MAX_STEP = 2.0


@njit(**INTERNAL_INLINE)
def nothing_more(side, drive):
    """Return that no event follows."""
    return Next(math.inf, NONE, side, 0.0, 0.0, drive, 0.0, 0.0)


@njit(**INTERNAL_INLINE)
def no_return(arc, drive):
    """Return that no event follows. The place is that where this is certain."""
    return Next(math.inf, NONE, arc.side, 0.0, 0.0, drive, 0.0, 0.0)


@njit(**INTERNAL)
def arrival(p, arc, drive, at_brace, velocity):
    """Return the event at a place: impact or brace impact."""
    kind, angle = (BRACE, p.block.brace_angle) if at_brace else (IMPACT, 0.0)
    return Next(time_between(p, arc.drive, drive), kind, arc.side, angle, velocity, drive, 0.0, 0.0)


@njit(**INTERNAL_INLINE)
def to_brace(p, piece):
    """Return the distance from the brace, as a ``Piece``."""
    brace = p.block.brace_angle
    return Piece(brace - piece.w, -piece.dw, -piece.force - brace, -piece.rate)


@njit(**INTERNAL)
def first_event_in(p, piece, length, end):
    """Return the first event in a segment, with (u, u') at its end.

    Returns
    -------
    tuple of (float, bool, float)
        Its time, infinite if there is none.
        Whether it is at the brace.
        u' there.
    """
    x, velocity = first_zero(piece, length, end)
    if p.block.brace_angle == math.inf:
        return x, False, velocity
    angle, rate = (0.0, velocity) if x < math.inf else end
    x_brace, approach = first_zero(to_brace(p, piece), min(length, x), (p.block.brace_angle - angle, -rate))
    return (x_brace, True, -approach) if x_brace < x else (x, False, velocity)


@njit(**INTERNAL)
def free_zero(w, dw, force):
    """Return the first time at which w falls through zero, with w'' - w = force from now on; infinity if there is none.

    With T = tanh(x/2), w(x) = 0 is (w + 2 force) T^2 + 2 w' T + w = 0.
    """
    a, under = w + 2.0 * force, dw * dw - w * (w + 2.0 * force)
    if w == 0.0 and dw == 0.0 and force >= 0.0:
        return math.inf
    if under < 0.0:
        return math.inf
    root = math.sqrt(under)
    if dw >= 0.0:
        # only the root (-dw - root)/a can be positive, if a < 0
        half = -(dw + root) / a if a < 0.0 else math.inf
    else:
        half = w / (root - dw)
    return 2.0 * math.atanh(half) if half < 1.0 else math.inf


@njit(**INTERNAL)
def free_event(p, arc, drive, angle, velocity):
    """Return the next event after the last sample, in closed form.

    At the end, u = b, u'^2 = v^2 + (u - b) (2 - u - b), because the energy is kept.
    """
    x, at_brace, brace = free_zero(angle, velocity, -1.0), False, p.block.brace_angle
    if brace < math.inf:
        x_brace = free_zero(brace - angle, -velocity, 1.0 - brace)
        at_brace = x_brace < x
        x = min(x, x_brace)
    if x == math.inf:
        return no_return(arc, drive)
    end = brace if at_brace else 0.0
    # the height above the end as a product: at a brace the speed of a short hop keeps its digits
    speed = math.sqrt(max(velocity * velocity + (angle - end) * (2.0 - angle - end), 0.0))
    arrive = speed if at_brace else -speed
    return arrival(p, arc, SampledDrive(drive.index, drive.offset + x), at_brace, arrive)


@njit(**INTERNAL)
def event_within(p, arc, place, piece, length, end, extremes):
    """Return the first event on the rest of an interval, which starts at a place and ends in the state ``end``.

    Returns
    -------
    tuple of (Next, Extremes)
        The event; NONE if there is none.
        The extremes so far, with the minimum before the event.
    """
    coming, begun = nothing_more(arc.side, place), time_between(p, arc.drive, place)
    x, at_brace, arrive = first_event_in(p, piece, length, end)
    if x < math.inf:
        coming = arrival(p, arc, SampledDrive(place.index, place.offset + x), at_brace, arrive)
        length, end = x, (coming.angle, coming.velocity)
    angle, turn = minimum(piece, length, end)
    if angle < extremes.dip:
        extremes = Extremes(angle, begun + turn, extremes.low, 0.0)
    return coming, extremes


@njit(**INTERNAL)
def first_event(p, arc):
    """Return the first event of an arc, and its extremes before it.

    Returns
    -------
    tuple of (Next, Extremes)
    """
    coming, extremes, reached = event_and_dip(p, arc)
    return coming, with_reached(extremes, reached)


@njit(**INTERNAL)
def event_and_dip(p, arc):
    """Return the first event of an arc, its lowest dip before, and the largest u of its start, its end and all samples."""
    place, last, step, extremes = arc.drive, last_index(p), p.forcing.tables.step, NO_EXTREMES
    angle, velocity, top, force = arc.angle, arc.velocity, arc.angle, largest_push(p)
    far = last if step >= MAX_STEP else min(place.index + FIRST, last - 1)
    while place.index < last and place.index <= far:
        piece, rest = piece_from(p, arc.side, place, angle, velocity), step - place.offset
        before, fell = angle, velocity
        angle, velocity = across_step(p, piece) if place.offset == 0.0 else at(piece, rest)
        quiet = rises_throughout(piece, rest) and angle < p.block.brace_angle
        if not quiet and place.offset == 0.0 and not fell < 0.0 <= velocity:
            reach = reach_over(p.forcing.tables.single, before, angle, force)
            quiet = step < MAX_STEP and is_clear(p, before, angle, reach)
        if not quiet:
            coming, extremes = event_within(p, arc, place, piece, rest, (angle, velocity), extremes)
            if coming.event != NONE:
                return coming, extremes, max(top, coming.angle)
        place, top = SampledDrive(place.index + 1, 0.0), max(top, angle)
    if place.index < last:
        angle, velocity, coming, extremes, top = scan(p, arc, place.index, (angle, velocity), extremes, top)
        if coming.event != NONE or coming.wait == math.inf:
            return coming, extremes, top
        place = coming.drive
    return free_event(p, arc, place, angle, velocity), extremes, top


@njit(**INTERNAL_INLINE)
def over_stride(p, side, index, total, difference, force):
    """Pass a stride from a sample, from u + u' and u - u' there.

    Returns
    -------
    tuple of (bool, float, float, float)
        Whether the stride certainly contains no event.
        u + u' and u - u' at its end.
        A lower bound of the minimum that it may contain; infinite if it contains none.
    """
    tables, before = p.forcing.tables, 0.5 * (total + difference)
    ahead, behind = along(p, side, tables.several, tables.strides[index], total, difference)
    here, low = 0.5 * (ahead + behind), math.inf
    reach = reach_over(tables.several, before, here, force)
    clear = is_clear(p, before, here, reach)
    speeds = 0.5 * (total - difference), 0.5 * (ahead - behind)
    if clear and not is_monotone(speeds, tables.stride * tables.step, max(before, here) + reach + force):
        low = min(before, here) - reach
    return clear, ahead, behind, low


@njit(**INTERNAL)
def scan(p, arc, index, start, extremes, top):
    """Search from a sample, where (u, u') is ``start``, to the last, with the extremes so far.

    Returns
    -------
    tuple of (float, float, Next, Extremes, float)
        u and u' at the last sample, unless there is an event.
        The event, or the proof that none follows. NONE after a finite time: neither.
        The extremes.
        The largest u of all samples so far.
    """
    side, last, tables, force = arc.side, last_index(p), p.forcing.tables, largest_push(p)
    total, difference = start[0] + start[1], start[0] - start[1]
    while index < last:
        end, before, clear = index + tables.stride, 0.5 * (total + difference), False
        if end <= last:
            clear, ahead, behind, low = over_stride(p, side, index, total, difference, force)
        if clear:
            total, difference, top = ahead, behind, max(top, 0.5 * (ahead + behind))
            extremes = with_low(extremes, min(extremes.low, low))
        else:
            for k in range(index, min(end, last)):
                ahead, behind = along(p, side, tables.single, tables.intervals[k], total, difference)
                here = 0.5 * (ahead + behind)
                reach = reach_over(tables.single, before, here, force)
                if not is_clear(p, before, here, reach) or (total < difference and ahead >= behind):
                    place, ended = SampledDrive(k, 0.0), (here, 0.5 * (ahead - behind))
                    piece = piece_from(p, side, place, before, 0.5 * (total - difference))
                    coming, extremes = event_within(p, arc, place, piece, tables.step, ended, extremes)
                    if coming.event != NONE:
                        return before, piece.dw, coming, extremes, max(top, coming.angle)
                total, difference, before, top = ahead, behind, here, max(top, here)
        index = min(end, last)
        if p.block.brace_angle == math.inf and never_returns(p, side, index, total, difference):
            return before, 0.0, no_return(arc, SampledDrive(index, 0.0)), extremes, math.inf
    drive = SampledDrive(last, 0.0)
    coming = Next(MAX_ARC_TIME, NONE, side, 0.0, 0.0, drive, 0.0, 0.0)
    return 0.5 * (total + difference), 0.5 * (total - difference), coming, extremes, top
