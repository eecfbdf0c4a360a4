"""Certified first event of an arc under a sampled base acceleration.

The first intervals are decided by ``segment.first_zero`` on the local closed form, which keeps the digits of short arcs.
They are the rest of the interval of the start, and FIRST more. From there on the closed form of ``solution`` gives u at each
sample. Between two samples u leaves its chord by at most h^2/8 max|u''|. With |u''| <= |u| + F, F = 1 + max|a|, and
``bend`` = q/(1 - q), q = h^2/8,

    |u - chord| <= bend (max(|u|, |u|) + F),

so that most intervals contain no event. All others are decided by ``segment.first_zero``. A step of MAX_STEP or more is
decided interval by interval.
"""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE, IMPACT, NONE
from rocking.kernels.forcing.arc import MAX_ARC_TIME, Next
from rocking.kernels.forcing.drives import SampledDrive
from rocking.kernels.forcing.sampled.segment import Piece, at, first_zero
from rocking.kernels.forcing.sampled.solution import (
    across_step,
    constants_of,
    forcing_on,
    last_index,
    piece_from,
    state_at_sample,
    time_between,
)
from rocking.kernels.forcing.sampled.tables import WINDOW
from rocking.kernels.numerics.elementary import hyperbolic

FIRST = 2
MAX_STEP = 2.0


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
def never_returns(p, side, index, growing, shrinking):
    """Return whether u certainly stays positive from a sample on.

    u >= 1 + least P - (h^2/4) max|a| + (K+ e^t - |K-| e^-t)/2, because P leaves its chord by h^2/8 max|P''| <= h^2/4 max|a|.
    """
    tables, scale = p.forcing.tables, p.forcing.scale
    turned, knot = side * scale, tables.knots[index]
    least = turned * (knot.lowest if turned > 0.0 else knot.highest)
    bend = 0.25 * tables.step * tables.step * abs(scale) * tables.largest
    return growing > 0.0 and 2.0 * (1.0 + least - bend) + growing - abs(shrinking) > MARGIN * (
        growing + abs(shrinking)
    )


# Relative safety margin of bounds over rounding.
MARGIN = 1e-12


@njit(**INTERNAL)
def first_event(p, arc):
    """Return the first event of an arc."""
    side, place, last = arc.side, arc.drive, last_index(p)
    angle, velocity, step = arc.angle, arc.velocity, p.forcing.tables.step
    far = last if step >= MAX_STEP else min(place.index + FIRST, last - 1)
    while place.index < last and place.index <= far:
        piece = piece_from(p, side, place, angle, velocity)
        rest = step - place.offset
        x, at_brace, arrive = first_event_in(p, piece, rest)
        if x < math.inf:
            return arrival(p, arc, SampledDrive(place.index, place.offset + x), at_brace, arrive)
        angle, velocity = across_step(p, piece) if place.offset == 0.0 else at(piece, rest)
        place = SampledDrive(place.index + 1, 0.0)
    if place.index < last:
        place, angle, velocity, coming = scan(p, arc, place.index, angle, velocity)
        if coming.event != NONE or coming.wait == math.inf:
            return coming
    return free_event(p, arc, place, angle, velocity)


@njit(**INTERNAL)
def scan(p, arc, index, angle, velocity):
    """Search from a sample to the last, in windows.

    Returns
    -------
    tuple of (SampledDrive, float, float, Next)
        The last sample, with u and u' there, unless there is an event.
        The event, or the proof that none follows. NONE after a finite time: neither.
    """
    side, last, tables, brace = arc.side, last_index(p), p.forcing.tables, p.block.brace_angle
    knots, powers, turned = tables.knots, tables.powers, side * p.forcing.scale
    quarter = 0.125 * tables.step * tables.step
    bend = quarter / (1.0 - quarter) * (1.0 + MARGIN)
    force = 1.0 + abs(p.forcing.scale) * tables.largest
    constants = constants_of(p, side, SampledDrive(index, 0.0), angle, velocity)
    growing, shrinking = constants.grow, constants.shrink
    while index < last:
        count = min(WINDOW, last - index)
        before = 1.0 + (turned * knots[index].mean + 0.5 * (growing + shrinking))
        for k in range(count):
            up, down = growing * powers[k + 1], shrinking * powers[WINDOW + 2 + k]
            here = 1.0 + (turned * knots[index + k + 1].mean + 0.5 * (up + down))
            reach = bend * (max(abs(before), abs(here)) + force)
            if not (min(before, here) > reach and brace - max(before, here) > reach):
                angle, velocity = state_at_sample(
                    p, side, index + k, growing * powers[k], shrinking * powers[WINDOW + 1 + k]
                )
                f, rate = forcing_on(p, side, index + k)
                x, at_brace, arrive = first_event_in(p, Piece(angle, velocity, f, rate), tables.step)
                if x < math.inf:
                    drive = SampledDrive(index + k, x)
                    return drive, angle, velocity, arrival(p, arc, drive, at_brace, arrive)
            before = here
        growing, shrinking = growing * powers[count], shrinking * powers[WINDOW + 1 + count]
        index += count
        if brace == math.inf and never_returns(p, side, index, growing, shrinking):
            return arc.drive, 0.0, 0.0, nothing_more(side, arc.drive)
    angle, velocity = state_at_sample(p, side, last, growing, shrinking)
    drive = SampledDrive(last, 0.0)
    return drive, angle, velocity, Next(MAX_ARC_TIME, NONE, side, angle, velocity, drive, 0.0, 0.0)
