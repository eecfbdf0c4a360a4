"""A block in its lane: how it is put there, what is read of it, and what its lane cannot do."""

import math

import numpy as np
from numba import njit

from rocking.kernels.arc.extrema import largest_on
from rocking.kernels.arc.first_zero import LONGEST
from rocking.kernels.arc.solution import NONE_YET, arc_after, earlier
from rocking.kernels.classify.cascade import most_events, room
from rocking.kernels.classify.classifier_state import Run
from rocking.kernels.classify.quasi_periodicity import Flights, sketch
from rocking.kernels.classify.reset import moved_on
from rocking.kernels.compile_options import EXACT_INNER, INNER, WITHIN
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT
from rocking.kernels.forcing.harmonic import clock
from rocking.kernels.lanes.rows import (  # fmt: skip
    ACROSS,
    ALONE,
    ALONG,
    ANGLE,
    ARRIVED,
    AT_BRACE,
    BEGUN,
    BRACE_HITS,
    CONTENT,
    COSINE,
    COUNTED,
    CYCLE,
    DOUBLINGS,
    DUE,
    EVENTS,
    FREQUENCY,
    LANES,
    LEG_END,
    NEXT_COSINE,
    NEXT_SINE,
    NEXT_SINH,
    NEXT_VERSINH,
    PEAK,
    PEAK_SEEN,
    PERIOD,
    PHASE,
    READING,
    SIDE,
    SINE,
    SLOT,
    SLOWEST,
    SPEED,
    SQUARE,
    STAGE,
    START,
    TARGET,
    TRAILS,
    UNCOLLECTED,
    VELOCITY,
    WAIT,
    WALK,
    of,
    put,
    set_system,
    trail_is_full,
)
from rocking.kernels.lanes.workspace import fetch
from rocking.kernels.march.chatter import base_settling_time, brace_settling_time
from rocking.kernels.march.impact_law import SLOW
from rocking.kernels.march.march import CROWDED, DONE, RESYNCHRONISE, UNKNOWN, Progress
from rocking.kernels.march.next_event import next_event
from rocking.kernels.numerics.simd import choose

LN2 = math.log(2.0)
# A line of memory holds four flights: the next but one is brought near.
AHEAD = 8


@njit(**WITHIN)
def seat(s, i, p, progress, columns, collected):
    """Put a block into a lane, of which so many flights were collected."""
    set_system(s, i, p)
    arc = progress.arc
    put(s, i, CYCLE, progress.cycle)
    put(s, i, START, arc.start)
    put(s, i, SIDE, arc.side)
    put(s, i, ANGLE, arc.angle)
    put(s, i, VELOCITY, arc.velocity)
    put(s, i, COSINE, arc.cosine)
    put(s, i, SINE, arc.sine)
    events = progress.impacts + progress.brace_hits
    put(s, i, EVENTS, events)
    put(s, i, COUNTED, events)
    put(s, i, UNCOLLECTED, events - collected)
    put(s, i, BRACE_HITS, progress.brace_hits)
    put(s, i, PEAK, progress.peak)
    put(s, i, STAGE, BEGUN)
    set_difference(s, i, columns)


@njit(**INNER)
def set_difference(s, i, columns):
    """The difference that a lane carries from here on."""
    put(s, i, ACROSS, columns[0, 0])
    put(s, i, ALONG, columns[0, 1])
    put(s, i, DOUBLINGS, 0.0)


@njit(**INNER)
def set_leg(s, i, target, trails):
    """Where the leg of a lane ends, and whether its arcs are asked for."""
    put(s, i, TARGET, target)
    put(s, i, TRAILS, trails)


@njit(**WITHIN)
def arc_of(s, i, p):
    """The arc under way in a lane."""
    side, start = int(of(s, i, SIDE)), of(s, i, START)
    return arc_after(p, side, start, of(s, i, ANGLE), of(s, i, VELOCITY), of(s, i, COSINE), of(s, i, SINE))


@njit(**INNER)
def growth_since(s, i):
    """(the logarithm of what differences have grown by since that was last read, the difference, of size 1)."""
    a, b = of(s, i, ACROSS), of(s, i, ALONG)
    size = math.hypot(a, b)
    grown = math.log(size) + of(s, i, DOUBLINGS) * LN2
    put(s, i, ACROSS, a / size)
    put(s, i, ALONG, b / size)
    put(s, i, DOUBLINGS, 0.0)
    return grown, a / size, b / size


@njit(**INNER)
def flights_by_now(s, i, flights, most):
    """How many flights are collected, with those since the lane was last read."""
    return min(flights.count + int(of(s, i, EVENTS)) - int(of(s, i, COUNTED)), most)


@njit(**WITHIN)
def read(s, i, wants, p, run, max_cycles, desk, trail):
    """(status, run) of a lane, with what happened since it was last read: at the end of the leg if it wants that."""
    watch, flights, section_time, count, lossless, measuring = run
    before, arc, cycle, target = watch.progress, arc_of(s, i, p), int(of(s, i, CYCLE)), int(of(s, i, TARGET))
    pending, written = arc.start <= section_time, int(of(s, i, EVENTS)) - int(of(s, i, COUNTED))
    if lossless and written > 0:
        collected = flights_by_now(s, i, flights, desk.flights.shape[0])
        flights = Flights(IMPACT, cycle, arc.start, flights.first_cycle, collected)
    if wants == LEG_END:
        arc, cycle, pending = earlier(arc, (target - cycle) * p.period), target, True
    elif cycle < before.cycle:
        # the arc under way began before the lane was last read
        arc, cycle, pending = earlier(arc, (before.cycle - cycle) * p.period), before.cycle, before.pending
    events, hits, peak = int(of(s, i, EVENTS)), int(of(s, i, BRACE_HITS)), of(s, i, PEAK)
    wait = of(s, i, WAIT) if of(s, i, STAGE) == ARRIVED else UNKNOWN[0]
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
    if of(s, i, TRAILS) > 0.0:
        count = room(desk.section, count, cycle + 1 - before.cycle, desk.scratch.shape[0])
        count = sketch(p, before, trail[1:], written, after, section_time, desk.section, count)
    else:
        count = 0
    put(s, i, COUNTED, events)
    grown, desk.columns[0, 0], desk.columns[0, 1] = growth_since(s, i)
    desk.growth[0] += grown
    watch = moved_on(watch, after)
    status = CROWDED if events > most_events(max_cycles) else DONE
    return status, Run(watch, flights, section_time, count, lossless, measuring)


@njit(**WITHIN)
def over(s, i):
    """Whether the coming event lies beyond the end of the leg."""
    left = (of(s, i, TARGET) - of(s, i, CYCLE)) * of(s, i, PERIOD)
    return of(s, i, START) + of(s, i, WAIT) > left


@njit(**WITHIN)
def settles(s, i, p):
    """Whether events certainly accumulate after the coming one, as in ``impact_law``."""
    hits, cosine, sine = of(s, i, AT_BRACE) > 0.0, of(s, i, NEXT_COSINE), of(s, i, NEXT_SINE)
    restitution = p.brace_restitution if hits else p.restitution
    speed = restitution * of(s, i, SPEED)
    if not (restitution < 1.0 and speed < SLOW):
        return False
    if hits:
        return brace_settling_time(p, cosine, sine, speed) <= LONGEST
    return base_settling_time(p, -cosine, -sine, speed) <= LONGEST


@njit(**WITHIN)
def wanted(s, i, p):
    """What a lane wants that may have arrived: the end of its leg, to be marched alone, or nothing."""
    if of(s, i, STAGE) != ARRIVED:
        return CONTENT
    return LEG_END if over(s, i) else ALONE if settles(s, i, p) else CONTENT


@njit(**WITHIN)
def find(s, i, p):
    """What a lane wants once the coming event, of which it was not certain, is found."""
    coming, _ = next_event(p, FLIGHT, arc_of(s, i, p), NONE_YET)
    hits, speed = coming.event == BRACE, abs(coming.velocity)
    returned = (p.brace_restitution if hits else p.restitution) * speed
    if not ((hits or coming.event == IMPACT) and returned >= SLOWEST):
        return ALONE
    put(s, i, WAIT, coming.wait)
    put(s, i, SPEED, speed)
    put(s, i, AT_BRACE, hits)
    put(s, i, NEXT_COSINE, coming.cosine)
    put(s, i, NEXT_SINE, coming.sine)
    put(s, i, NEXT_SINH, coming.sinh)
    put(s, i, NEXT_VERSINH, coming.versinh)
    put(s, i, STAGE, ARRIVED)
    wants = wanted(s, i, p)
    if wants != CONTENT:
        return wants
    full = trail_is_full(of(s, i, TRAILS), of(s, i, EVENTS), of(s, i, COUNTED))
    return READING if full else PEAK_SEEN


@njit(**WITHIN)
def see_peak(s, i, p):
    """The largest angle up to the coming impact."""
    put(s, i, PEAK, largest_on(p, arc_of(s, i, p), of(s, i, WAIT), of(s, i, PEAK)))


@njit(**EXACT_INNER)
def sort_out(s, most, braced):
    """What of each lane is to be noted: where its last flight goes, -1 if nowhere; the square of its speed; whether ``note_arc`` is due."""
    for i in range(LANES):
        events, stage, velocity = of(s, i, EVENTS), of(s, i, STAGE), of(s, i, VELOCITY)
        slot, rounds = events - of(s, i, UNCOLLECTED) - 1.0, events * (1.0 / (RESYNCHRONISE + 1))
        kept = (events > of(s, i, COUNTED)) & (slot < most) & (braced == False)  # noqa: E712
        # every so many events as in ``note_arc``, exactly: RESYNCHRONISE + 1 is a power of two
        due = (of(s, i, TRAILS) > 0.0) | ((np.floor(rounds) == rounds) & (stage == WALK))
        put(s, i, SLOT, choose(kept, slot, -1.0))
        put(s, i, SQUARE, velocity * velocity)
        put(s, i, DUE, choose(due, 1.0, 0.0))


@njit(**INNER)
def note_arc(s, i, trail):
    """Into the trail of a lane, if it is asked for, the arc under way; now and then the forcing is taken from the clock."""
    events, start, side, angle = int(of(s, i, EVENTS)), of(s, i, START), of(s, i, SIDE), of(s, i, ANGLE)
    if of(s, i, TRAILS) > 0.0:
        k, event = events - int(of(s, i, COUNTED)), BRACE if angle > 0.0 else IMPACT
        trail[i, k, 0], trail[i, k, 1], trail[i, k, 2] = of(s, i, CYCLE), start, event
        trail[i, k, 4], trail[i, k, 5], trail[i, k, 6] = side, angle, of(s, i, VELOCITY)
    if events & RESYNCHRONISE == 0 and of(s, i, STAGE) == WALK:
        cosine, sine, _, _, _ = clock(of(s, i, FREQUENCY), of(s, i, PHASE), side, start)
        put(s, i, COSINE, cosine)
        put(s, i, SINE, sine)


@njit(**WITHIN)
def note(s, flights, trail, braced):
    """Write down of each lane what its last flight was, where there are no braces: how long, and the square of its speed.

    So again and again until the next impact; and ``note_arc`` where that is due.
    """
    sort_out(s, flights.shape[1], braced)
    for i in range(LANES):
        slot = int(of(s, i, SLOT))
        if slot >= 0:
            flights[i, slot, 0], flights[i, slot, 1] = of(s, i, WAIT), of(s, i, SQUARE)
            # No machine foresees where as many lanes write next.
            fetch(flights.ctypes.data + flights.itemsize * 2 * (i * flights.shape[1] + slot + AHEAD))
        if of(s, i, DUE) > 0.0:
            note_arc(s, i, trail)
