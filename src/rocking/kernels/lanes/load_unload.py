"""A block in its lane: how it is put there, what is read of it, and what its lane cannot do."""

import math

import numpy as np
from numba import njit

from rocking.kernels.arc.extrema import largest_on
from rocking.kernels.arc.first_zero import MAX_ARC_TIME
from rocking.kernels.arc.solution import NONE_YET, arc_after, shift_clock
from rocking.kernels.classify.classifier_state import Run
from rocking.kernels.classify.decision_cascade import most_events, room
from rocking.kernels.classify.quasi_periodicity import Flights, append_lazy_rows
from rocking.kernels.classify.reset import moved_on
from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE, SIMD_INLINE
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT
from rocking.kernels.forcing.harmonic import clock
from rocking.kernels.lanes.rows import (  # fmt: skip
    ANGLE,
    AT_BRACE,
    AT_EVENT,
    BRACE_HITS,
    BRACKET,
    COSINE,
    COUNTED,
    CYCLE,
    DELTA_ANGLE,
    DELTA_VELOCITY,
    DOUBLINGS,
    DUE,
    END_LEG,
    EVENTS,
    FLUSH_LOG,
    FREQUENCY,
    LANES,
    LOG_ON,
    NEW_ARC,
    NEXT_COSINE,
    NEXT_SINE,
    NEXT_SINH,
    NEXT_VERSINH,
    NO_REQUEST,
    PEAK,
    PERIOD,
    PHASE,
    SIDE,
    SINE,
    SLOT,
    SLOWEST,
    SPEED,
    SQUARE,
    STAGE,
    START,
    TARGET,
    TO_SCALAR,
    UNCOLLECTED,
    UPDATE_PEAK,
    VELOCITY,
    WAIT,
    load,
    set_system,
    store,
    trail_is_full,
)
from rocking.kernels.lanes.workspace import prefetch_for_write
from rocking.kernels.march.chatter import base_settling_time, brace_settling_time
from rocking.kernels.march.impact_law import SLOW
from rocking.kernels.march.march import CROWDED, DONE, RESYNCHRONISE, UNKNOWN, Progress
from rocking.kernels.march.next_event import next_event
from rocking.kernels.numerics.simd import choose

LN2 = math.log(2.0)
# A line of memory holds four flights: the next but one is brought near.
AHEAD = 8


@njit(**INTERNAL)
def load_block(s, i, p, progress, columns, collected):
    """Put a block into a lane, of which so many flights were collected."""
    set_system(s, i, p)
    arc = progress.arc
    store(s, i, CYCLE, progress.cycle)
    store(s, i, START, arc.start)
    store(s, i, SIDE, arc.side)
    store(s, i, ANGLE, arc.angle)
    store(s, i, VELOCITY, arc.velocity)
    store(s, i, COSINE, arc.cosine)
    store(s, i, SINE, arc.sine)
    events = progress.impacts + progress.brace_hits
    store(s, i, EVENTS, events)
    store(s, i, COUNTED, events)
    store(s, i, UNCOLLECTED, events - collected)
    store(s, i, BRACE_HITS, progress.brace_hits)
    store(s, i, PEAK, progress.peak)
    store(s, i, STAGE, NEW_ARC)
    set_difference(s, i, columns)


@njit(**INTERNAL_INLINE)
def set_difference(s, i, columns):
    """The difference that a lane carries from here on."""
    store(s, i, DELTA_ANGLE, columns[0, 0])
    store(s, i, DELTA_VELOCITY, columns[0, 1])
    store(s, i, DOUBLINGS, 0.0)


@njit(**INTERNAL_INLINE)
def set_leg(s, i, target, trails):
    """Where the leg of a lane ends, and whether its arcs are asked for."""
    store(s, i, TARGET, target)
    store(s, i, LOG_ON, trails)


@njit(**INTERNAL)
def arc_of(s, i, p):
    """The arc under way in a lane."""
    side, start = int(load(s, i, SIDE)), load(s, i, START)
    return arc_after(
        p, side, start, load(s, i, ANGLE), load(s, i, VELOCITY), load(s, i, COSINE), load(s, i, SINE)
    )


@njit(**INTERNAL_INLINE)
def growth_since(s, i):
    """(the logarithm of what differences have grown by since that was last read, the difference, of size 1)."""
    a, b = load(s, i, DELTA_ANGLE), load(s, i, DELTA_VELOCITY)
    size = math.hypot(a, b)
    grown = math.log(size) + load(s, i, DOUBLINGS) * LN2
    store(s, i, DELTA_ANGLE, a / size)
    store(s, i, DELTA_VELOCITY, b / size)
    store(s, i, DOUBLINGS, 0.0)
    return grown, a / size, b / size


@njit(**INTERNAL_INLINE)
def flights_by_now(s, i, flights, most):
    """How many flights are collected, with those since the lane was last read."""
    return min(flights.count + int(load(s, i, EVENTS)) - int(load(s, i, COUNTED)), most)


@njit(**INTERNAL)
def unload_block(s, i, wants, p, run, max_cycles, workspace, log):
    """(status, run) of a lane, with what happened since it was last read: at the end of the leg if it wants that."""
    watch, flights, section_time, count, lossless, measuring = run
    before, arc, cycle, target = (
        watch.progress,
        arc_of(s, i, p),
        int(load(s, i, CYCLE)),
        int(load(s, i, TARGET)),
    )
    pending, written = arc.start <= section_time, int(load(s, i, EVENTS)) - int(load(s, i, COUNTED))
    if lossless and written > 0:
        collected = flights_by_now(s, i, flights, workspace.flights.shape[0])
        flights = Flights(IMPACT, cycle, arc.start, flights.first_cycle, collected)
    if wants == END_LEG:
        arc, cycle, pending = shift_clock(arc, (target - cycle) * p.period), target, True
    elif cycle < before.cycle:
        # the arc under way began before the lane was last read
        arc, cycle, pending = (
            shift_clock(arc, (before.cycle - cycle) * p.period),
            before.cycle,
            before.pending,
        )
    events, hits, peak = int(load(s, i, EVENTS)), int(load(s, i, BRACE_HITS)), load(s, i, PEAK)
    wait = load(s, i, WAIT) if load(s, i, STAGE) == AT_EVENT else UNKNOWN[0]
    after = Progress(
        FLIGHT,
        cycle,
        arc,
        pending,
        0,
        events - hits,
        hits,
        peak,
        math.inf,
        UNKNOWN[1],
        wait,
        -math.inf,
    )
    if load(s, i, LOG_ON) > 0.0:
        count = room(workspace.section, count, cycle + 1 - before.cycle, workspace.scratch.shape[0])
        count = append_lazy_rows(p, before, log[1:], written, after, section_time, workspace.section, count)
    else:
        count = 0
    store(s, i, COUNTED, events)
    grown, workspace.columns[0, 0], workspace.columns[0, 1] = growth_since(s, i)
    workspace.growth[0] += grown
    watch = moved_on(watch, after)
    status = CROWDED if events > most_events(max_cycles) else DONE
    return status, Run(watch, flights, section_time, count, lossless, measuring)


@njit(**INTERNAL)
def leg_done(s, i):
    """Whether the coming event lies beyond the end of the leg."""
    left = (load(s, i, TARGET) - load(s, i, CYCLE)) * load(s, i, PERIOD)
    return load(s, i, START) + load(s, i, WAIT) > left


@njit(**INTERNAL)
def settles(s, i, p):
    """Whether events certainly accumulate after the coming one, as in ``impact_law``."""
    hits, cosine, sine = load(s, i, AT_BRACE) > 0.0, load(s, i, NEXT_COSINE), load(s, i, NEXT_SINE)
    restitution = p.brace_restitution if hits else p.restitution
    speed = restitution * load(s, i, SPEED)
    if not (restitution < 1.0 and speed < SLOW):
        return False
    if hits:
        return brace_settling_time(p, cosine, sine, speed) <= MAX_ARC_TIME
    return base_settling_time(p, -cosine, -sine, speed) <= MAX_ARC_TIME


@njit(**INTERNAL)
def lane_request(s, i, p):
    """What a lane wants that may have arrived: the end of its leg, to be marched alone, or nothing."""
    if load(s, i, STAGE) != AT_EVENT:
        return NO_REQUEST
    return END_LEG if leg_done(s, i) else TO_SCALAR if settles(s, i, p) else NO_REQUEST


@njit(**INTERNAL)
def find_event_scalar(s, i, p):
    """What a lane wants once the coming event, of which it was not certain, is found."""
    coming, _ = next_event(p, FLIGHT, arc_of(s, i, p), NONE_YET)
    hits, speed = coming.event == BRACE, abs(coming.velocity)
    returned = (p.brace_restitution if hits else p.restitution) * speed
    if not ((hits or coming.event == IMPACT) and returned >= SLOWEST):
        return TO_SCALAR
    store(s, i, WAIT, coming.wait)
    store(s, i, SPEED, speed)
    store(s, i, AT_BRACE, hits)
    store(s, i, NEXT_COSINE, coming.cosine)
    store(s, i, NEXT_SINE, coming.sine)
    store(s, i, NEXT_SINH, coming.sinh)
    store(s, i, NEXT_VERSINH, coming.versinh)
    store(s, i, STAGE, AT_EVENT)
    wants = lane_request(s, i, p)
    if wants != NO_REQUEST:
        return wants
    full = trail_is_full(load(s, i, LOG_ON), load(s, i, EVENTS), load(s, i, COUNTED))
    return FLUSH_LOG if full else UPDATE_PEAK


@njit(**INTERNAL)
def update_peak(s, i, p):
    """The largest angle up to the coming impact."""
    store(s, i, PEAK, largest_on(p, arc_of(s, i, p), load(s, i, WAIT), load(s, i, PEAK)))


@njit(**SIMD_INLINE)
def mark_pending_logs(s, most, braced):
    """What of each lane is to be noted: where its last flight goes, -1 if nowhere; the square of its speed; whether ``note_arc`` is due."""
    for i in range(LANES):
        events, stage, velocity = load(s, i, EVENTS), load(s, i, STAGE), load(s, i, VELOCITY)
        slot, rounds = events - load(s, i, UNCOLLECTED) - 1.0, events * (1.0 / (RESYNCHRONISE + 1))
        kept = (events > load(s, i, COUNTED)) & (slot < most) & (braced == False)  # noqa: E712
        # every so many events as in ``note_arc``, exactly: RESYNCHRONISE + 1 is a power of two
        due = (load(s, i, LOG_ON) > 0.0) | ((np.floor(rounds) == rounds) & (stage == BRACKET))
        store(s, i, SLOT, choose(kept, slot, -1.0))
        store(s, i, SQUARE, velocity * velocity)
        store(s, i, DUE, choose(due, 1.0, 0.0))


@njit(**INTERNAL_INLINE)
def note_arc(s, i, log):
    """Into the log of a lane, if it is asked for, the arc under way; now and then the forcing is taken from the clock."""
    events, start, side, angle = (
        int(load(s, i, EVENTS)),
        load(s, i, START),
        load(s, i, SIDE),
        load(s, i, ANGLE),
    )
    if load(s, i, LOG_ON) > 0.0:
        k, event = events - int(load(s, i, COUNTED)), BRACE if angle > 0.0 else IMPACT
        log[i, k, 0], log[i, k, 1], log[i, k, 2] = load(s, i, CYCLE), start, event
        log[i, k, 4], log[i, k, 5], log[i, k, 6] = side, angle, load(s, i, VELOCITY)
    if events & RESYNCHRONISE == 0 and load(s, i, STAGE) == BRACKET:
        cosine, sine, _, _, _ = clock(load(s, i, FREQUENCY), load(s, i, PHASE), side, start)
        store(s, i, COSINE, cosine)
        store(s, i, SINE, sine)


@njit(**INTERNAL)
def log_arcs(s, flights, log, braced):
    """Write down of each lane what its last flight was, where there are no braces: how long, and the square of its speed.

    So again and again until the next impact; and ``note_arc`` where that is due.
    """
    mark_pending_logs(s, flights.shape[1], braced)
    for i in range(LANES):
        slot = int(load(s, i, SLOT))
        if slot >= 0:
            flights[i, slot, 0], flights[i, slot, 1] = load(s, i, WAIT), load(s, i, SQUARE)
            # No machine foresees where as many lanes write next.
            prefetch_for_write(
                flights.ctypes.data + flights.itemsize * 2 * (i * flights.shape[1] + slot + AHEAD)
            )
        if load(s, i, DUE) > 0.0:
            note_arc(s, i, log)
