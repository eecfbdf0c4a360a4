"""Certified first event of an arc under a sampled base acceleration.

The first intervals are decided by ``first_zero_samples.first_zero`` on the local closed form, which keeps the digits of short arcs.
They are the rest of the interval of the start, and FIRST more. From there on u and u' go from sample to sample, or over a
stride of several. Between two samples a time t apart u leaves its chord by at most t^2/8 max|u''|. With |u''| <= |u| + F,
F = 1 + max|a|, and ``bend`` = q/(1 - q), q = t^2/8,

    |u - chord| <= bend (max|u| + F),

with the larger |u| of both ends. So most strides contain no event. In the others each interval is decided by this bound, or
by ``first_zero_samples.first_zero``. A step of MAX_STEP or more is decided interval by interval.
"""

import math

from rocking.kernels import contract
from rocking.kernels.arc.arc import (
    MAX_ARC_TIME,
    NO_EXTREMES,
    UNIT_RATE,
    Next,
    error_of_arc,
    growth_time,
    nothing_more,
    with_dip,
    with_low,
    with_reached,
)
from rocking.kernels.arc.first_zero_samples import ROUNDING, Piece, at, first_zero, minimum
from rocking.kernels.arc.slender_samples import across_step, along, piece_from
from rocking.kernels.base.samples import SampledDrive, Samples, last_index, time_between
from rocking.kernels.block.rest import held_event_under_samples
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, NONE
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import artanh
from rocking.kernels.system import Slender

# Relative safety margin of bounds over rounding.
MARGIN = 1e-12


@kernel(inline=True)
def largest_push(p):
    """Return F, a bound of |f|, with the margin over rounding of the bound that it serves."""
    return (1.0 + abs(p.forcing.scale) * p.forcing.tables.largest) * (1.0 + MARGIN)


@kernel(inline=True)
def rises_throughout(piece, length):
    """Return whether u' > 0 on a part of a segment: |u''| <= u + |f|, and u stays below the bound that this gives.

    With q = length^2/2 that bound is (u + u' length + |f| q)/(1 - q), where u' >= 0 at the start.
    """
    force = max(abs(piece.force), abs(piece.force + piece.rate * length))
    half = 0.5 * length * length
    largest = force + piece.w + piece.dw * length  # times 1 - q
    return piece.dw > 0.0 and half < 0.5 and piece.dw * (1.0 - half) > length * largest * (1.0 + MARGIN)


@kernel(inline=True)
def reach_over(passage, before, here, force):
    """Return the bound on how far u leaves its chord, from u at both ends."""
    return passage.bend * (max(abs(before), abs(here)) + force)


@kernel(inline=True)
def is_clear(p, before, here, reach):
    """Return whether there is no event between two samples by the bound ``reach``, from u at both ends."""
    return min(before, here) > reach and p.block.brace_angle - max(before, here) > reach


@kernel(inline=True)
def is_monotone(speeds, time, push):
    """Return whether u' certainly keeps its sign over a time, from its values at both ends and a bound of |u''|."""
    return speeds[0] * speeds[1] > 0.0 and max(abs(speeds[0]), abs(speeds[1])) > time * push * (1.0 + MARGIN)


@kernel(inline=True)
def never_returns(p, side, index, total, difference):
    """Return whether u certainly stays positive from a sample on, from u + u' and u - u' there.

    u >= 1 + least P - (h^2/4) max|a| + (K+ e^t - |K-| e^-t)/2, because P leaves its chord by h^2/8 max|P''| <= h^2/4 max|a|.
    A quarter of K+ e^t must suffice, so that u keeps a distance from 0 that grows with its rounding error.
    """
    tables, scale = p.forcing.tables, p.forcing.scale
    turned, knot = side * scale, tables.knots[index]
    growing = total - 1.0 - turned * (knot.mean + knot.rate)
    shrinking = difference - 1.0 - turned * (knot.mean - knot.rate)
    least = turned * (knot.lowest if turned > 0.0 else knot.highest)
    bend = 0.25 * tables.step * tables.step * abs(scale) * tables.largest
    return growing > 0.0 and 2.0 * (1.0 + least - bend) + 0.25 * growing - abs(shrinking) > MARGIN * (
        growing + abs(shrinking)
    )


FIRST = 2
MAX_STEP = 2.0


@kernel(inline=True)
def no_return(arc, drive):
    """Return that no event follows. The place is that where this is certain."""
    return Next(math.inf, NONE, arc.side, 0.0, 0.0, drive, 0.0, 0.0)


@kernel
def arrival(p, arc, drive, at_brace, velocity):
    """Return the event at a place: impact or brace impact."""
    kind, angle = (BRACE, p.block.brace_angle) if at_brace else (IMPACT, 0.0)
    return Next(time_between(p, arc.drive, drive), kind, arc.side, angle, velocity, drive, 0.0, 0.0)


@kernel(inline=True)
def to_brace(p, piece):
    """Return the distance from the brace, as a ``Piece``."""
    brace = p.block.brace_angle
    return Piece(brace - piece.w, -piece.dw, -piece.force - brace, -piece.rate)


@kernel
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


@kernel
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
    return 2.0 * artanh(half) if half < 1.0 else math.inf


@kernel
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


@kernel
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
    if angle < math.inf:
        extremes = with_dip(extremes, angle, begun + turn)
    return coming, extremes


@kernel
def first_event(p, arc):
    """Return the first event of an arc, and its extremes before it.

    Returns
    -------
    tuple of (Next, Extremes)
    """
    coming, extremes, reached = event_and_dip(p, arc)
    return coming, with_reached(extremes, reached)


@kernel
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


@kernel(inline=True)
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


@kernel
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


@body(contract.rounding_error, Slender, Samples)
def rounding_error(p, arc, wait, growth, steps):
    """Provide ``contract.rounding_error``.

    The first intervals are computed from the state at the start. Later u + u' and u - u' go from sample to sample, and each step
    adds its own error.
    """
    step, force = p.forcing.tables.step, 1.0 + abs(p.forcing.scale) * p.forcing.tables.largest
    if wait <= FIRST * step:
        return error_of_arc(arc, wait, growth, force)
    short = min(wait, 1.0)
    terms = arc.angle + abs(arc.velocity) + force * short
    return ROUNDING * math.sqrt(1.0 + short / step) * growth * terms


@body(contract.next_event, Slender, Samples)
def next_event(p, mode, arc, guess):
    """Provide ``contract.next_event``."""
    coming, _, _ = next_event_and_extremes(p, mode, arc, math.inf)
    return coming, guess


@body(contract.next_event_and_extremes, Slender, Samples)
def next_event_and_extremes(p, mode, arc, peak):
    """Provide ``contract.next_event_and_extremes``."""
    if mode == FLIGHT:
        coming, extremes = first_event(p, arc)
        return coming, extremes, UNIT_RATE
    return held_event_under_samples(p, mode, arc), NO_EXTREMES, UNIT_RATE


@body(contract.no_return_time, Slender, Samples)
def no_return_time(p, arc):
    """Provide ``contract.no_return_time``: from then on the bound of ``never_returns`` is positive."""
    tables, scale = p.forcing.tables, p.forcing.scale
    turned, knot = arc.side * scale, tables.knots[min(arc.drive.index, last_index(p))]
    least = turned * (knot.lowest if turned > 0.0 else knot.highest)
    m = 2.0 * (1.0 + least - 0.25 * tables.step * tables.step * abs(scale) * tables.largest)
    return growth_time(m, arc.constants.grow, arc.constants.shrink) if arc.constants.grow > 0.0 else 0.0
