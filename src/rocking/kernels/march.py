"""The march of one block: from event to event, in constant memory, recording what is asked for.

Time is kept as an integer cycle and the time within it, so that no phase is lost however long the run.
Sections lie inside arcs and do not break them.
"""

import math
from enum import IntEnum
from typing import NamedTuple

from numba import njit

from .arc import Arc, arc_from, earlier, evaluate, within_reach
from .crossing import CROSSING, first_turn_sign, first_zero, no_return_time, turn_watch
from .elementary import COMPILED, INLINED
from .events import (
    BRACE,
    FLIGHT,
    IMPACT,
    LEAN,
    LEANS,
    REST,
    RESTS,
    next_event,
    side_to_lift,
    stays_leaning,
)
from .impact import after_event
from .tangent import TANGENT, Tangent, carried, carry_arc, carry_rows, read_tangent, write_tangent

MOST_EVENTS = 10_000_000
# Compiled code cannot be interrupted: it comes up for air after this many events.
BREATH = 2_000_000
# From impact to impact the forcing is turned on with the arc; after this many (a power of two, less one) it
# is taken from the clock anew.
RESYNCHRONISE = 15


class Status(IntEnum):
    """How a march ended; the text of the last one is the remedy that the caller prints."""

    DONE = 0
    OVERTURNED = 1
    STILL = 2  # at rest, or leaning, for ever
    PAUSED = 3  # the event buffer is full, or it is time to look up: go on
    CROWDED = 4  # more than MOST_EVENTS events in one cycle


DONE, OVERTURNED, STILL, PAUSED, CROWDED = (int(status) for status in Status)


class Progress(NamedTuple):
    """A block under way, and what it has met so far."""

    mode: int
    cycle: int
    arc: Arc
    pending: bool  # this cycle's section is still to come
    crowd: int  # events in this cycle
    impacts: int
    brace_hits: int
    peak: float
    no_return: float  # time within the cycle at which overturning was proved; infinite before
    last_wait: (
        float  # how long the last two arcs took: what comes next is guessed from the last on the same side
    )
    wait_before: float


@njit(**INLINED)
def plain(progress):
    """A progress as nested tuples: what a kernel hands to Python.

    A named tuple is made by calling its class, and an interrupt (Ctrl-C) that strikes there, on the way out of compiled code,
    ends the whole process.
    """
    arc = progress.arc
    return (
        progress.mode,
        progress.cycle,
        (arc.side, arc.start, arc.angle, arc.velocity, arc.cosine, arc.sine, arc.psi, arc.pull),
        progress.pending,
        progress.crowd,
        progress.impacts,
        progress.brace_hits,
        progress.peak,
        progress.no_return,
        progress.last_wait,
        progress.wait_before,
    )


def named(fields):
    """The progress that ``plain`` took apart."""
    return Progress(*fields[:2], Arc(*fields[2]), *fields[3:])


@njit(**COMPILED)
def begin_plain(p, angle, velocity):
    """The block just after any event at the start, and whether a brace was hit there."""
    side = 1 if angle > 0.0 or (angle == 0.0 and velocity > 0.0) else -1
    hit = abs(angle) == p.brace_angle and side * velocity > 0.0
    u, v = abs(angle), side * velocity
    if hit:
        v = -p.brace_restitution * v
    mode = FLIGHT
    arc = arc_from(p, side, 0.0, u, v)
    if u == 0.0 and v == 0.0:
        lifting = side_to_lift(p, arc.psi)
        mode = REST if lifting == 0 else FLIGHT
        arc = arc_from(p, side if lifting == 0 else lifting, 0.0, 0.0, 0.0)
    elif u == p.brace_angle and v == 0.0 and stays_leaning(p, side, arc.psi):
        mode = LEAN
    return plain(Progress(mode, 0, arc, True, 0, 0, 1 if hit else 0, u, math.inf, 1.0, 1.0)), hit


@njit(**COMPILED)
def state_at(p, mode, arc, t):
    """(Theta, Theta') a time t into an arc, a rest or a lean."""
    if mode == REST:
        return 0.0, 0.0
    if mode == LEAN:
        return arc.side * p.brace_angle, 0.0
    now = evaluate(p, arc, t)
    return arc.side * within_reach(p, now.angle), arc.side * now.velocity


@njit(**COMPILED)
def arc_peak(p, arc, until, peak):
    """The largest of ``peak`` and |Theta| on the arc up to ``until``."""
    now = evaluate(p, arc, until)
    peak = max(peak, within_reach(p, now.angle))
    t = 0.0
    sign = first_turn_sign(p, arc)
    while True:
        found, t, now = first_zero(p, arc, turn_watch(p, sign), t, until)
        if found != CROSSING:
            return peak
        peak = max(peak, within_reach(p, now.angle))
        sign = -sign


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
def note_event(events, count, cycle, mode, arc, event, before):
    """Write an event; rest or leaning that begins with it is an event of its own at the same instant."""
    count = note(events, count, cycle, mode, arc, event, before)
    if mode == FLIGHT:
        return count
    return note(events, count, cycle, mode, arc, RESTS if mode == REST else LEANS, 0.0)


@njit(**COMPILED)
def finish(p, reached, coming, columns, growth, want_peak):
    """(status, progress) at the end of a march: differences, peak and arc are brought there.

    An overturned block is left at the moment of the proof: later its angle may be beyond all numbers.
    """
    mode, cycle, arc, _, _, impacts, brace_hits, peak, no_return, last_wait, wait_before = reached
    end = min(no_return, 0.0)
    t = end - arc.start
    if mode == FLIGHT:
        now = evaluate(p, arc, t)
        if columns.shape[0] > 0:
            carry_arc(p, arc, columns, growth, t, cycle * p.period + arc.start)
        angle = within_reach(p, now.angle)
        if want_peak:
            peak = max(arc_peak(p, arc, t, peak), angle)
        arc = arc_from(p, arc.side, end, angle, now.velocity)
    else:
        arc = arc_from(p, arc.side, end, arc.angle, 0.0)
    status = DONE
    if coming.wait == math.inf:
        status = OVERTURNED if mode == FLIGHT else STILL
    return status, Progress(
        mode, cycle, arc, True, 0, impacts, brace_hits, peak, no_return, last_wait, wait_before
    )


@njit(**COMPILED)
def march_plain(p, progress, cycles, section_time, section, events, columns, growth, want_peak):
    """March to the end of cycle ``cycles``: (status, ``plain`` progress, section rows written, event rows written).

    1. ``section`` (n, 2) takes the state at ``section_time`` within each cycle, just after any event there,
       in order and as long as no overturning is proved; (0, 2) records nothing.
    2. ``events`` (n, 8) takes one row an event (``note``). When it is full, or after BREATH events, the march
       returns PAUSED; called again it goes on where it was.
    3. ``columns`` (2, 2) or (8, 2) carries differences (``tangent``); with ``growth`` (2,) they are
       re-orthonormalised at every event.
    4. Without section and events, accumulating impacts that certainly end in rest before the march does are
       cut short.
    5. At the end the arc is renewed: the progress begins at the start of cycle ``cycles``. A proof of
       overturning ends the march with its cycle.
    """
    mode, cycle, arc, pending, crowd, impacts, brace_hits, peak, no_return, last_wait, wait_before = progress
    hasty = section.shape[0] == 0 and events.shape[0] == 0
    # The tangent alone travels in registers.
    light = columns.shape[0] == TANGENT and growth.shape[0] == 0
    tangent = read_tangent(columns) if light else Tangent(0.0, 0.0, 0.0, 0.0)
    written, rows, breath, ended = 0, 0, 0, False
    while True:
        coming = next_event(p, mode, arc, wait_before)
        at = arc.start + coming.wait
        if coming.wait == math.inf and mode == FLIGHT and no_return == math.inf:
            no_return = arc.start + no_return_time(p, arc)
        while at > (section_time if pending else p.period):
            if pending:
                pending = False
                if rows < section.shape[0] and section_time <= no_return:
                    section[rows, 0], section[rows, 1] = state_at(p, mode, arc, section_time - arc.start)
                    rows += 1
                continue
            cycle, crowd, pending = cycle + 1, 0, True
            arc, no_return = earlier(arc, p.period), no_return - p.period
            at = arc.start + coming.wait
            ended = cycle >= cycles or no_return <= 0.0
            if ended:
                break
        paused = breath >= BREATH or (events.shape[0] > 0 and written + 2 > events.shape[0])
        if ended or paused or crowd >= MOST_EVENTS:
            break
        crowd += 1
        breath += 1
        if want_peak and mode == FLIGHT:
            peak = p.brace_angle if coming.event == BRACE else arc_peak(p, arc, coming.wait, peak)
        wait_before, last_wait = last_wait, coming.wait
        impacts += coming.event == IMPACT
        brace_hits += coming.event == BRACE
        quiet = (cycles - cycle) * p.period - at if hasty else 0.0
        mode_after, after = after_event(p, arc, at, coming, quiet)
        if light:
            tangent = carried(p, tangent, mode, arc, coming, mode_after, after.side)
        elif columns.shape[0] > 0:
            elapsed = cycle * p.period + arc.start
            carry_rows(p, columns, growth, mode, arc, coming, mode_after, after.side, elapsed)
        before = arc.side * coming.velocity
        mode, arc = mode_after, after
        if impacts & RESYNCHRONISE == 0:
            arc = arc_from(p, arc.side, arc.start, arc.angle, arc.velocity)
        if events.shape[0] > 0:
            written = note_event(events, written, cycle, mode, arc, coming.event, before)
    if light:
        write_tangent(columns, tangent)
    reached = Progress(
        mode, cycle, arc, pending, crowd, impacts, brace_hits, peak, no_return, last_wait, wait_before
    )
    if not ended:
        return PAUSED if paused else CROWDED, plain(reached), rows, written
    status, reached = finish(p, reached, coming, columns, growth, want_peak)
    return status, plain(reached), rows, written


def begin_march(p, angle, velocity):
    """``begin_plain`` for Python: (progress, whether a brace was hit)."""
    fields, hit = begin_plain(p, angle, velocity)
    return named(fields), hit


def march(p, progress, cycles, section_time, section, events, columns, growth, want_peak):
    """``march_plain`` for Python: (status, progress, section rows written, event rows written)."""
    status, fields, rows, written = march_plain(
        p, progress, cycles, section_time, section, events, columns, growth, want_peak
    )
    return status, named(fields), rows, written
