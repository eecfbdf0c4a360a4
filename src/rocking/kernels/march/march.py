"""The march of one block: from event to event, in constant memory, recording what is asked for.

Time is kept as an integer cycle and the time within it, so that no phase is lost however long the run.
Sections lie inside arcs and do not break them.
"""

import math
from enum import IntEnum
from typing import NamedTuple

from numba import njit

from rocking.kernels.arc.extrema import largest_on, peak_with
from rocking.kernels.arc.first_zero import MAX_ARC_TIME, no_return_time
from rocking.kernels.arc.solution import (
    Arc,
    arc_from,
    evaluate,
    propagator_or_none,
    shift_clock,
    within_reach,
)
from rocking.kernels.compile_options import ENTRY_POINT, INTERNAL, KERNEL_INLINE
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, LEAN, REST
from rocking.kernels.march.event_rows import note_event, note_state
from rocking.kernels.march.impact_law import after_event
from rocking.kernels.march.next_event import next_event, side_to_lift, stays_leaning
from rocking.kernels.march.tangent import (
    TANGENT,
    Tangent,
    carried,
    carry_arc,
    carry_rows,
    log_strain,
    normalised,
    out_of_scale,
    read_tangent,
    write_tangent,
)

MAX_EVENTS = 10_000_000
# Compiled code cannot be interrupted: it comes up for air after this many events.
BREATH = 2_000_000
# No guesses of the first two waits.
UNKNOWN = (0.0, 0.0)
# From event to event the forcing is turned on with the arc; after this many (a power of two, less one) it
# is taken from the clock anew.
RESYNCHRONISE = 15


class Status(IntEnum):
    """How a march ended; the text of the last one is the remedy that the caller prints."""

    DONE = 0
    OVERTURNED = 1
    STILL = 2  # at rest, or leaning, for ever
    PAUSED = 3  # the event buffer is full, or it is time to look up: go on
    CROWDED = 4  # more than MAX_EVENTS events in one cycle
    RELEASED = 5  # the block has just lifted off or left a brace, and that was waited for: go on


DONE, OVERTURNED, STILL, PAUSED, CROWDED, RELEASED = (int(status) for status in Status)


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
    # about how long the last arc took, and how long the one under way will take from where it is entered, which is
    # most often what the last on its side took; 0 where that is not known
    last_wait: float
    wait_before: float
    strain: float  # logarithm of what differences had grown to when the block last came to rest or leaned


@njit(**KERNEL_INLINE)
def to_tuple(progress):
    """A progress as nested tuples: what a kernel hands to Python.

    A named tuple is made by calling its class, and an interrupt (Ctrl-C) that strikes there, on the way out of compiled code,
    ends the whole process.
    """
    arc = progress.arc
    return (
        progress.mode,
        progress.cycle,
        (arc.side, arc.start, arc.angle, arc.velocity, arc.cosine, arc.sine, arc.psi, arc.acceleration),
        progress.pending,
        progress.crowd,
        progress.impacts,
        progress.brace_hits,
        progress.peak,
        progress.no_return,
        progress.last_wait,
        progress.wait_before,
        progress.strain,
    )


def from_tuple(fields):
    """The progress that ``to_tuple`` took apart."""
    return Progress(*fields[:2], Arc(*fields[2]), *fields[3:])


@njit(**INTERNAL)
def begin(p, angle, velocity, waits, start=0.0):
    """The block just after any event at the time ``start`` within its first cycle, and whether a brace was hit there.

    ``waits`` guesses the time to the first event and that from there to the next.
    """
    wait_before, last_wait = waits
    side = 1 if angle > 0.0 or (angle == 0.0 and velocity > 0.0) else -1
    hit = abs(angle) == p.brace_angle and side * velocity > 0.0
    u, v = abs(angle), side * velocity
    if hit:
        v = -p.brace_restitution * v
    mode = FLIGHT
    arc = arc_from(p, side, start, u, v)
    if u == 0.0 and v == 0.0:
        lifting = side_to_lift(p, arc.psi)
        mode = REST if lifting == 0 else FLIGHT
        arc = arc_from(p, side if lifting == 0 else lifting, start, 0.0, 0.0)
    elif u == p.brace_angle and v == 0.0 and stays_leaning(p, side, arc.psi):
        mode = LEAN
    return Progress(
        mode, 0, arc, True, 0, 0, 1 if hit else 0, u, math.inf, last_wait, wait_before, -math.inf
    ), hit


@njit(**ENTRY_POINT)
def begin_plain(p, angle, velocity):
    """``begin`` as Python may have it."""
    progress, hit = begin(p, angle, velocity, UNKNOWN)
    return to_tuple(progress), hit


@njit(**INTERNAL)
def finish(p, reached, coming, columns, growth, want_peak):
    """(status, progress) at the end of a march: differences, peak and arc are brought there.

    An overturned block is left at the moment of the proof: later its angle may be beyond all numbers.
    """
    mode, cycle, arc, _, _, impacts, brace_hits, peak, no_return, last_wait, wait_before, strain = reached
    end = min(no_return, 0.0)
    t = end - arc.start
    if mode == FLIGHT:
        now = evaluate(p, arc, t)
        if columns.shape[0] > 0:
            carry_arc(p, arc, columns, growth, t, cycle * p.period + arc.start)
        if growth.shape[0] == 1:
            write_tangent(columns, normalised(read_tangent(columns), growth))
        angle = within_reach(p, now.angle)
        if want_peak:
            peak = max(largest_on(p, arc, t, peak), angle)
        arc = arc_from(p, arc.side, end, angle, now.velocity)
    else:
        arc = arc_from(p, arc.side, end, arc.angle, 0.0)
    status = DONE
    if coming.wait == math.inf:
        status = OVERTURNED if mode == FLIGHT else STILL
    return status, Progress(
        mode, cycle, arc, True, 0, impacts, brace_hits, peak, no_return, last_wait, wait_before, strain
    )


@njit(**INTERNAL)
def march_on(p, progress, cycles, section_time, section, events, columns, growth, want_peak, want_release):
    """March to the end of cycle ``cycles``: (status, progress, section rows written, event rows written).

    1. ``section`` (n, 2) takes the state at ``section_time`` within each cycle, just after any event there,
       in order and as long as no overturning is proved; (n, 4) the impacts and brace hits so far too; no rows
       record nothing.
    2. ``events`` (n, 8) takes one row an event (``event_rows.note``). When it is full, or after BREATH events, the march
       returns PAUSED; with ``want_release`` RELEASED after a lift-off or leaving a brace. Called again it goes
       on where it was.
    3. ``columns`` (2, 2) or (8, 2) carries differences (``tangent``); with ``growth`` (2,) they are
       re-orthonormalised at every event, with ``growth`` (1,) the first is normalised where need be and at the end.
    4. Without section and events, accumulating impacts that certainly end in rest before the march does are
       cut short; with ``want_release`` always, whatever the section then misses.
    5. At the end the arc is renewed: the progress begins at the start of cycle ``cycles``; with
       ``want_release`` the arc under way goes on, and counts when it ends. A proof of overturning ends the
       march with its cycle.
    """
    mode, cycle, arc, pending, crowd, impacts, brace_hits, peak, no_return, last_wait, wait_before, strain = (
        progress
    )
    skip_zeno = section.shape[0] == 0 and events.shape[0] == 0 and not want_release
    light, measured = columns.shape[0] == TANGENT and growth.shape[0] < TANGENT, growth.shape[0] == 1
    tangent = read_tangent(columns) if light else Tangent(0.0, 0.0, 0.0, 0.0)
    written, rows, events_since_return, ended, paused, released = 0, 0, 0, False, False, False
    last_lapse, lapse_before = propagator_or_none(p, last_wait), propagator_or_none(p, wait_before)
    while True:
        coming, lapse = next_event(p, mode, arc, lapse_before)
        at = arc.start + coming.wait
        if coming.wait == math.inf and mode == FLIGHT and no_return == math.inf:
            no_return = arc.start + no_return_time(p, arc)
        while at > (section_time if pending else p.period):
            if pending:
                pending = False
                if rows < section.shape[0] and section_time <= no_return:
                    note_state(p, section[rows], mode, arc, section_time - arc.start, impacts, brace_hits)
                    rows += 1
                continue
            cycle, crowd, pending = cycle + 1, 0, True
            arc, no_return = shift_clock(arc, p.period), no_return - p.period
            at = arc.start + coming.wait
            ended = cycle >= cycles or no_return <= 0.0
            if ended:
                break
        paused = events_since_return >= BREATH or (events.shape[0] > 0 and written + 2 > events.shape[0])
        if ended or paused or crowd >= MAX_EVENTS:
            break
        crowd += 1
        events_since_return += 1
        if want_peak and mode == FLIGHT:
            peak = peak_with(p, arc, coming, peak)
        # What is left of an arc entered on its way says nothing about whole ones.
        lapse_before, last_lapse = last_lapse, lapse if arc.angle in (0.0, p.brace_angle) else last_lapse
        impacts += coming.event == IMPACT
        brace_hits += coming.event == BRACE
        horizon = (cycles - cycle) * p.period - at if skip_zeno else MAX_ARC_TIME if want_release else 0.0
        mode_after, after = after_event(p, arc, at, coming, horizon)
        if mode_after != FLIGHT:
            tangent = normalised(tangent, growth) if measured else tangent
            strain = growth[0] if growth.shape[0] > 0 else (log_strain(tangent) if light else math.inf)
        released = want_release and mode != FLIGHT and mode_after == FLIGHT
        if light:
            tangent = carried(p, tangent, mode, arc, coming, mode_after, after.side)
            tangent = normalised(tangent, growth) if measured and out_of_scale(tangent) else tangent
        elif columns.shape[0] > 0:
            elapsed = cycle * p.period + arc.start
            carry_rows(p, columns, growth, mode, arc, coming, mode_after, after.side, elapsed)
        mode, arc, before = mode_after, after, arc.side * coming.velocity
        if (impacts + brace_hits) & RESYNCHRONISE == 0:
            arc = arc_from(p, arc.side, arc.start, arc.angle, arc.velocity)
        if events.shape[0] > 0:
            written = note_event(events, written, cycle, mode, arc, coming.event, before)
        if released:
            break
    if light:
        write_tangent(columns, normalised(tangent, growth) if measured else tangent)
    left = lapse.time if want_release else min(at, MAX_ARC_TIME)
    last_wait, wait_before = last_lapse.time, left if ended else lapse_before.time
    reached = Progress(
        mode, cycle, arc, pending, crowd, impacts, brace_hits, peak, no_return, last_wait, wait_before, strain
    )
    if not ended:
        return RELEASED if released else PAUSED if paused else CROWDED, reached, rows, written
    if want_release and coming.wait < math.inf:
        return DONE, reached, rows, written
    status, reached = finish(p, reached, coming, columns, growth, want_peak)
    return status, reached, rows, written


@njit(**ENTRY_POINT)
def march_plain(p, progress, cycles, section_time, section, events, columns, growth, want_peak):
    """``march_on`` to the end of cycle ``cycles`` as Python may have it."""
    status, reached, rows, written = march_on(
        p, progress, cycles, section_time, section, events, columns, growth, want_peak, False
    )
    return status, to_tuple(reached), rows, written


def begin_march(p, angle, velocity):
    """``begin_plain`` for Python: (progress, whether a brace was hit)."""
    fields, hit = begin_plain(p, angle, velocity)
    return from_tuple(fields), hit


def march(p, progress, cycles, section_time, section, events, columns, growth, want_peak):
    """``march_plain`` for Python: (status, progress, section rows written, event rows written)."""
    status, fields, rows, written = march_plain(
        p, progress, cycles, section_time, section, events, columns, growth, want_peak
    )
    return status, from_tuple(fields), rows, written
