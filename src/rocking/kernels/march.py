"""The march of one block: from event to event, in constant memory, recording what is asked for.

Time is kept as an integer cycle and the time within it, so that no phase is lost however long the run. Sections lie inside arcs and do not break them.
"""

import math
from enum import IntEnum
from typing import NamedTuple

from numba import njit

from .arc import Arc, arc_from, earlier, evaluate
from .crossing import CROSSING, LONGEST, NEVER, base_watch, brace_watch, first_turn_sign, first_zero, no_return_time, turn_watch
from .elementary import COMPILED
from .events import (
    BRACE,
    FLIGHT,
    IMPACT,
    LEAN,
    LEANS,
    LEAVE,
    LIFT_OFF,
    NONE,
    REST,
    RESTS,
    SLOWEST,
    base_settling_time,
    brace_settling_time,
    side_to_lift,
    wait_at_rest,
    wait_leaning,
)
from .tangent import (
    SENSITIVITIES,
    carry_brace,
    carry_forcing,
    carry_free,
    carry_free_orthonormal,
    carry_impact,
    forget,
    forget_leaning,
    orthonormalise,
)

MOST_EVENTS = 10_000_000


class Status(IntEnum):
    """How a march ended; the text of the last one is the remedy that the caller prints."""

    DONE = 0
    OVERTURNED = 1
    STILL = 2  # at rest, or leaning, for ever
    FULL = 3  # the event buffer is full: make room and go on
    CROWDED = 4  # more than MOST_EVENTS events in one cycle


DONE, OVERTURNED, STILL, FULL, CROWDED = (int(status) for status in Status)


class Progress(NamedTuple):
    """A block under way, and what it has met so far."""

    mode: int
    cycle: int
    arc: Arc
    pending: bool  # this cycle's section is still to come
    impacts: int
    brace_hits: int
    peak: float
    no_return: float  # time within the cycle at which overturning was proved; infinite before


class Next(NamedTuple):
    """The coming event of an arc, a rest or a lean: after how long, what, and the instant itself."""

    wait: float
    event: int
    side: int
    angle: float
    velocity: float
    cosine: float


@njit(**COMPILED)
def next_event(p, mode, arc):
    """What comes next, and when; NONE after a finite wait only renews an arc grown long."""
    if mode == REST:
        wait, side = wait_at_rest(p, arc.psi)
        return Next(wait, LIFT_OFF if wait < math.inf else NONE, side, 0.0, 0.0, 0.0)
    if mode == LEAN:
        wait = wait_leaning(p, arc.side, arc.psi)
        return Next(wait, LEAVE if wait < math.inf else NONE, arc.side, p.brace_angle, 0.0, 0.0)
    event = IMPACT
    found, t, now = first_zero(p, arc, base_watch(p), 0.0, LONGEST)
    if found != CROSSING:
        event, t = NONE, LONGEST
    if p.brace_angle < math.inf:
        hit, t_hit, now_hit = first_zero(p, arc, brace_watch(p), 0.0, t)
        if hit == CROSSING:
            event, t, now = BRACE, t_hit, now_hit
    elif found == NEVER:
        return Next(math.inf, NONE, arc.side, 0.0, 0.0, 0.0)
    if event == NONE:
        now = evaluate(p, arc, t)
    return Next(t, event, arc.side, now.angle, now.velocity, now.cosine)


@njit(**COMPILED)
def arc_peak(p, arc, until, peak):
    """The largest of ``peak`` and |Theta| on the arc up to ``until``."""
    now = evaluate(p, arc, until)
    peak = max(peak, arc.angle, now.angle)
    t = 0.0
    sign = first_turn_sign(p, arc)
    while True:
        found, t, now = first_zero(p, arc, turn_watch(p, sign), t, until)
        if found != CROSSING:
            return peak
        peak = max(peak, now.angle)
        sign = -sign


@njit(**COMPILED)
def state_at(p, mode, arc, t):
    """(Theta, Theta') a time t into an arc, a rest or a lean."""
    if mode == REST:
        return 0.0, 0.0
    if mode == LEAN:
        return arc.side * p.brace_angle, 0.0
    now = evaluate(p, arc, t)
    return arc.side * max(now.angle, 0.0), arc.side * now.velocity


@njit(**COMPILED)
def begin_march(p, angle, velocity):
    """The block just after any event at the start, and whether a brace was hit there."""
    side = 1 if angle > 0.0 or (angle == 0.0 and velocity > 0.0) else -1
    hit = abs(angle) == p.brace_angle and side * velocity > 0.0
    u, v = abs(angle), side * velocity
    if hit:
        v = -p.brace_restitution * v
    mode = FLIGHT
    arc = arc_from(p, side, 0.0, u, v)
    if u == 0.0 and v == 0.0:
        wait, lifting = wait_at_rest(p, arc.psi)
        mode = REST if wait > 0.0 else FLIGHT
        arc = arc_from(p, lifting, 0.0, 0.0, 0.0)
    elif u == p.brace_angle and v == 0.0 and wait_leaning(p, side, arc.psi) > 0.0:
        mode = LEAN
    return Progress(mode, 0, arc, True, 0, 1 if hit else 0, u, math.inf), hit


@njit(**COMPILED)
def carry(p, mode, arc, t, elapsed, columns, growth):
    """The differences along an arc of length t; at rest and leaning they stay."""
    if columns.shape[0] == 0 or mode != FLIGHT:
        return
    if growth.shape[0] > 0:
        carry_free_orthonormal(columns, growth, t)
        return
    now = evaluate(p, arc, t)
    carry_free(columns, now.sinh, now.versinh)
    if columns.shape[0] == SENSITIVITIES:
        carry_forcing(p, arc, columns, t, elapsed)


@njit(**COMPILED)
def after_impact(p, arc, time, coming, quiet, columns):
    """(mode, arc) after an impact at the base; ``quiet`` is the time in which nothing is asked for, so that accumulating impacts may be cut short."""
    speed = p.restitution * max(-coming.velocity, 0.0)
    cosine_psi = arc.side * coming.cosine
    swing = p.amplitude * abs(cosine_psi)
    side = -arc.side
    mode = FLIGHT
    if speed == 0.0:
        if swing <= 1.0:
            mode = REST
        else:
            side = side_to_lift(cosine_psi)
    if columns.shape[0] > 0 and coming.velocity < 0.0:
        carry_impact(p, columns, coming.cosine, arc.side, arc.side * coming.velocity, side)
    after = arc_from(p, side, time, 0.0, speed)
    if mode == FLIGHT and speed < 0.1 and swing < 1.0 and p.restitution < 1.0:
        settled = base_settling_time(p, after.cosine, after.sine, speed)
        if settled <= quiet or (settled < math.inf and speed < SLOWEST):
            mode = REST
    if mode == REST:
        after = arc_from(p, side, time, 0.0, 0.0)
        forget(columns)
    return mode, after


@njit(**COMPILED)
def after_brace(p, arc, time, coming, quiet, columns):
    """(mode, arc) after a hit on a brace."""
    before = max(coming.velocity, 0.0)
    speed = p.brace_restitution * before
    if columns.shape[0] > 0 and before > 0.0:
        carry_brace(p, columns, coming.cosine, arc.side, arc.side * before)
    after = arc_from(p, arc.side, time, p.brace_angle, -speed)
    mode = FLIGHT
    if speed == 0.0:
        if wait_leaning(p, arc.side, after.psi) > 0.0:
            mode = LEAN
    elif speed < 0.1 and p.brace_restitution < 1.0:
        settled = brace_settling_time(p, after.cosine, after.sine, speed)
        if settled <= quiet or (settled < math.inf and speed < SLOWEST):
            mode = LEAN
    if mode == LEAN:
        after = arc_from(p, arc.side, time, p.brace_angle, 0.0)
        forget_leaning(columns, arc.side)
    return mode, after


@njit(**COMPILED)
def after_event(p, arc, time, coming, quiet, columns):
    """(mode, arc) after the coming event."""
    if coming.event == IMPACT:
        return after_impact(p, arc, time, coming, quiet, columns)
    if coming.event == BRACE:
        return after_brace(p, arc, time, coming, quiet, columns)
    if coming.event == LIFT_OFF:
        forget(columns)
        return FLIGHT, arc_from(p, coming.side, time, 0.0, 0.0)
    if coming.event == LEAVE:
        forget_leaning(columns, arc.side)
        return FLIGHT, arc_from(p, arc.side, time, p.brace_angle, 0.0)
    return FLIGHT, arc_from(p, arc.side, time, coming.angle, coming.velocity)


@njit(**COMPILED)
def note(events, count, cycle, mode, arc, event, before):
    """Write one event, with the arc that follows it and the velocity before it."""
    row = events[count]
    row[0] = cycle
    row[1] = arc.start
    row[2] = event
    row[3] = mode
    row[4] = arc.side
    row[5] = arc.angle
    row[6] = arc.velocity
    row[7] = before
    return count + 1


@njit(**COMPILED)
def march(p, progress, cycles, section_time, section, events, columns, growth, want_peak):
    """March to the end of cycle ``cycles``: (status, progress, section rows written, events written).

    1. ``section`` (n, 2) takes the state at ``section_time`` within each cycle, just after any event there, in order; (0, 2) records nothing.
    2. ``events`` (n, 8) takes one row an event (``note``); when it is full the march returns FULL and goes on where it was when called again.
    3. ``columns`` (2, 2) or (8, 2) carries differences (``tangent``); with ``growth`` (2,) they are re-orthonormalised at every event.
    4. Without section and events, accumulating impacts that certainly end in rest before the march does are cut short.
    5. At the end the arc is renewed: the progress begins at the start of cycle ``cycles``. Overturning, once proved, ends the march with its cycle.
    """
    mode, cycle, arc, pending, impacts, brace_hits, peak, no_return = progress
    hasty = section.shape[0] == 0 and events.shape[0] == 0
    written, rows, crowd = 0, 0, 0
    while True:
        coming = next_event(p, mode, arc)
        at = arc.start + coming.wait
        if coming.event == NONE and mode == FLIGHT and no_return == math.inf:
            no_return = arc.start + no_return_time(p, arc)
        while at > (section_time if pending else p.period):
            if pending:
                pending = False
                if rows < section.shape[0]:
                    section[rows, 0], section[rows, 1] = state_at(p, mode, arc, section_time - arc.start)
                    rows += 1
                continue
            cycle, crowd, pending = cycle + 1, 0, True
            arc, at, no_return = earlier(arc, p.period), at - p.period, no_return - p.period
            if cycle >= cycles or no_return <= 0.0:
                return finish(p, mode, cycle, arc, impacts, brace_hits, peak, no_return, coming, columns, growth, want_peak, rows, written)
        crowd += 1
        if crowd > MOST_EVENTS or (events.shape[0] > 0 and written + 2 > events.shape[0]):
            status = CROWDED if crowd > MOST_EVENTS else FULL
            return status, Progress(mode, cycle, arc, pending, impacts, brace_hits, peak, no_return), rows, written
        if want_peak and mode == FLIGHT:
            peak = arc_peak(p, arc, coming.wait, peak)
        carry(p, mode, arc, coming.wait, cycle * p.period + arc.start, columns, growth)
        impacts += coming.event == IMPACT
        brace_hits += coming.event == BRACE
        before = arc.side * coming.velocity
        mode, arc = after_event(p, arc, at, coming, (cycles - cycle) * p.period - at if hasty else 0.0, columns)
        if growth.shape[0] > 0:
            orthonormalise(columns, growth)
        if events.shape[0] > 0:
            written = note(events, written, cycle, mode, arc, coming.event, before)
            if mode != FLIGHT:
                written = note(events, written, cycle, mode, arc, RESTS if mode == REST else LEANS, 0.0)


@njit(**COMPILED)
def finish(p, mode, cycle, arc, impacts, brace_hits, peak, no_return, coming, columns, growth, want_peak, rows, written):
    """The end of a march at the start of ``cycle``: differences and peak brought there, the arc renewed."""
    t = -arc.start
    carry(p, mode, arc, t, cycle * p.period + arc.start, columns, growth)
    status = DONE
    if coming.event == NONE and coming.wait == math.inf:
        status = OVERTURNED if mode == FLIGHT else STILL
    if mode == FLIGHT:
        if want_peak:
            peak = arc_peak(p, arc, t, peak)
        now = evaluate(p, arc, t)
        arc = arc_from(p, arc.side, 0.0, max(now.angle, 0.0), now.velocity)
    else:
        arc = arc_from(p, arc.side, 0.0, arc.angle, 0.0)
    return status, Progress(mode, cycle, arc, True, impacts, brace_hits, peak, no_return), rows, written
