"""Certified first event of an arc under a sampled base acceleration.

The first intervals are decided by ``segment.first_zero`` on the local closed form, which keeps the digits of short arcs.
They are the rest of the interval of the start, and FIRST more. From there on u and u' go from sample to sample. Between two
samples u leaves its chord by at most h^2/8 max|u''|. With |u''| <= |u| + F, F = 1 + max|a|, and ``bend`` = q/(1 - q),
q = h^2/8,

    |u - chord| <= bend (max(|u|, |u|) + F),

so that most intervals contain no event. All others are decided by ``segment.first_zero``. A step of MAX_STEP or more is
decided interval by interval.
"""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE, IMPACT, NONE
from rocking.kernels.forcing.arc import MAX_ARC_TIME, NO_DIP, Dip, Next
from rocking.kernels.forcing.drives import SampledDrive
from rocking.kernels.forcing.sampled.segment import Piece, at, first_zero, minimum
from rocking.kernels.forcing.sampled.solution import (
    across_step,
    along_step,
    last_index,
    piece_from,
    time_between,
)
from rocking.kernels.numerics.elementary import hyperbolic

FIRST = 2
MAX_STEP = 2.0
# Samples between two attempts to prove that the block never returns.
WINDOW = 16


@njit(**INTERNAL_INLINE)
def nothing_more(side, drive):
    """Return that no event follows."""
    return Next(math.inf, NONE, side, 0.0, 0.0, drive, 0.0, 0.0)


@njit(**INTERNAL)
def arrival(p, arc, drive, at_brace, velocity):
    """Return the event at a place: impact or brace impact."""
    wait = time_between(p, arc.drive, drive)
    sinh, versinh, _, _ = hyperbolic(wait)
    kind, angle = (BRACE, p.block.brace_angle) if at_brace else (IMPACT, 0.0)
    return Next(wait, kind, arc.side, angle, velocity, drive, sinh, versinh)


@njit(**INTERNAL_INLINE)
def to_brace(p, piece):
    """Return the distance from the brace, as a ``Piece``."""
    brace = p.block.brace_angle
    return Piece(brace - piece.w, -piece.dw, -piece.force - brace, -piece.rate)


@njit(**INTERNAL)
def first_event_in(p, piece, length):
    """Return the first event in a segment.

    Returns
    -------
    tuple of (float, bool, float)
        Its time, infinite if there is none.
        Whether it is at the brace.
        u' there.
    """
    x, velocity = first_zero(piece, length)
    if p.block.brace_angle == math.inf:
        return x, False, velocity
    x_brace, approach = first_zero(to_brace(p, piece), min(length, x))
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
        return nothing_more(arc.side, drive)
    end = brace if at_brace else 0.0
    # the height above the end as a product: at a brace the speed of a short hop keeps its digits
    speed = math.sqrt(max(velocity * velocity + (angle - end) * (2.0 - angle - end), 0.0))
    arrive = speed if at_brace else -speed
    return arrival(p, arc, SampledDrive(drive.index, drive.offset + x), at_brace, arrive)


@njit(**INTERNAL_INLINE)
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


# Relative safety margin of bounds over rounding.
MARGIN = 1e-12


@njit(**INTERNAL)
def event_within(p, arc, place, piece, length, end, dip):
    """Return the first event on the rest of an interval, which starts at a place and ends in the state ``end``.

    Returns
    -------
    tuple of (Next, Dip)
        The event; NONE if there is none.
        The lower of ``dip`` and the minimum before the event.
    """
    coming, begun = nothing_more(arc.side, place), time_between(p, arc.drive, place)
    x, at_brace, arrive = first_event_in(p, piece, length)
    if x < math.inf:
        coming = arrival(p, arc, SampledDrive(place.index, place.offset + x), at_brace, arrive)
        length, end = x, (coming.angle, coming.velocity)
    angle, turn = minimum(piece, length, end)
    return coming, Dip(angle, begun + turn) if angle < dip.angle else dip


@njit(**INTERNAL)
def first_event(p, arc):
    """Return the first event of an arc, and the lowest dip before it.

    Returns
    -------
    tuple of (Next, Dip)
    """
    place, last, step, dip = arc.drive, last_index(p), p.forcing.tables.step, NO_DIP
    angle, velocity = arc.angle, arc.velocity
    far = last if step >= MAX_STEP else min(place.index + FIRST, last - 1)
    while place.index < last and place.index <= far:
        piece, rest = piece_from(p, arc.side, place, angle, velocity), step - place.offset
        angle, velocity = across_step(p, piece) if place.offset == 0.0 else at(piece, rest)
        coming, dip = event_within(p, arc, place, piece, rest, (angle, velocity), dip)
        if coming.event != NONE:
            return coming, dip
        place = SampledDrive(place.index + 1, 0.0)
    if place.index < last:
        angle, velocity, coming, dip = scan(p, arc, place.index, angle, velocity, dip)
        if coming.event != NONE or coming.wait == math.inf:
            return coming, dip
        place = coming.drive
    return free_event(p, arc, place, angle, velocity), dip


@njit(**INTERNAL)
def scan(p, arc, index, angle, velocity, dip):
    """Search from a sample to the last, with the lowest dip so far.

    Returns
    -------
    tuple of (float, float, Next, Dip)
        u and u' at the last sample, unless there is an event.
        The event, or the proof that none follows. NONE after a finite time: neither.
        The lowest dip.
    """
    side, last, tables, brace = arc.side, last_index(p), p.forcing.tables, p.block.brace_angle
    quarter = 0.125 * tables.step * tables.step
    bend = quarter / (1.0 - quarter) * (1.0 + MARGIN)
    force = 1.0 + abs(p.forcing.scale) * tables.largest
    total, difference = angle + velocity, angle - velocity
    while index < last:
        before = 0.5 * (total + difference)
        for k in range(index, min(index + WINDOW, last)):
            ahead, behind = along_step(p, side, k, total, difference)
            here = 0.5 * (ahead + behind)
            reach = bend * (max(abs(before), abs(here)) + force)
            near = not (min(before, here) > reach and brace - max(before, here) > reach)
            if near or (total < difference and ahead >= behind):
                place, end = SampledDrive(k, 0.0), (here, 0.5 * (ahead - behind))
                piece = piece_from(p, side, place, before, 0.5 * (total - difference))
                coming, dip = event_within(p, arc, place, piece, tables.step, end, dip)
                if coming.event != NONE:
                    return before, piece.dw, coming, dip
            total, difference, before = ahead, behind, here
        index = min(index + WINDOW, last)
        if brace == math.inf and never_returns(p, side, index, total, difference):
            return angle, velocity, nothing_more(side, arc.drive), dip
    angle, velocity = 0.5 * (total + difference), 0.5 * (total - difference)
    drive = SampledDrive(last, 0.0)
    return angle, velocity, Next(MAX_ARC_TIME, NONE, side, angle, velocity, drive, 0.0, 0.0), dip
