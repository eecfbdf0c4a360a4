"""A block in its lane: how it is put there, what is read of it, and what its lane cannot do."""

import math

from numba import njit

from .arc import arc_after, earlier
from .elementary import WITHIN, direction
from .events import FLIGHT, IMPACT, Next, any_event
from .lanes import (
    ACROSS,
    ALONE,
    ALONG,
    ARRIVED,
    BEGUN,
    COSINE,
    COUNTED,
    CYCLE,
    DOUBLINGS,
    FREQUENCY,
    IMPACTS,
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
    SIDE,
    SINE,
    SLOWEST,
    SPEED,
    STAGE,
    START,
    TARGET,
    VELOCITY,
    WAIT,
    WALK,
    of,
    put,
    set_system,
)  # fmt: skip
from .lossless import collect, may_be_asked_for, sketch
from .march import DONE, RESYNCHRONISE, UNKNOWN, Progress
from .release import Watch
from .turning import peak_with
from .verdict import Run, room

LN2 = math.log(2.0)


@njit(**WITHIN)
def seat(s, i, p, progress, columns, target):
    """Put a block into a lane."""
    set_system(s, i, p)
    arc = progress.arc
    put(s, i, CYCLE, progress.cycle)
    put(s, i, START, arc.start)
    put(s, i, SIDE, arc.side)
    put(s, i, VELOCITY, arc.velocity)
    put(s, i, COSINE, arc.cosine)
    put(s, i, SINE, arc.sine)
    put(s, i, IMPACTS, progress.impacts)
    put(s, i, COUNTED, progress.impacts)
    put(s, i, PEAK, progress.peak)
    put(s, i, ACROSS, columns[0, 0])
    put(s, i, ALONG, columns[0, 1])
    put(s, i, DOUBLINGS, 0.0)
    put(s, i, TARGET, target)
    put(s, i, STAGE, BEGUN)


@njit(**WITHIN)
def arc_of(s, i, p):
    """The arc under way in a lane."""
    side, start = int(of(s, i, SIDE)), of(s, i, START)
    return arc_after(p, side, start, 0.0, of(s, i, VELOCITY), of(s, i, COSINE), of(s, i, SINE))


@njit(**WITHIN)
def read(s, i, wants, p, run, max_cycles, desk, trail):
    """(status, run) of a lane, with what happened since it was last read: at the end of the leg if it wants that."""
    watch, flights, section_time, count, lossless, measuring = run
    before, arc, cycle, target = watch.progress, arc_of(s, i, p), int(of(s, i, CYCLE)), int(of(s, i, TARGET))
    pending = arc.start <= section_time
    if wants == LEG_END:
        arc, cycle, pending = earlier(arc, (target - cycle) * p.period), target, True
    impacts, peak = int(of(s, i, IMPACTS)), of(s, i, PEAK)
    wait = of(s, i, WAIT) if of(s, i, STAGE) == ARRIVED else UNKNOWN[0]
    after = Progress(
        FLIGHT,
        cycle,
        arc,
        pending,
        0,
        impacts,
        before.brace_hits,
        peak,
        math.inf,
        UNKNOWN[1],
        wait,
        -math.inf,
    )
    written = impacts - int(of(s, i, COUNTED))
    rows = desk.scratch.shape[0]
    if may_be_asked_for(desk.growth[0], target, max_cycles, rows):
        count = room(desk.section, count, cycle + 1 - before.cycle, rows)
        count = sketch(p, before, trail[1:], written, after, section_time, desk.section, count)
    else:
        count = 0
    flights = collect(p, flights, written, trail[1:], desk.flights)
    put(s, i, COUNTED, impacts)
    a, b = of(s, i, ACROSS), of(s, i, ALONG)
    size = math.hypot(a, b)
    desk.growth[0] += math.log(size) + of(s, i, DOUBLINGS) * LN2
    desk.columns[0, 0], desk.columns[0, 1] = a / size, b / size
    put(s, i, ACROSS, a / size)
    put(s, i, ALONG, b / size)
    put(s, i, DOUBLINGS, 0.0)
    watch = Watch(after, watch.base, watch.brace, 0, 0.0, watch.peak)
    return DONE, Run(watch, flights, section_time, count, lossless, measuring)


@njit(**WITHIN)
def over(s, i):
    """Whether the coming impact lies beyond the end of the leg."""
    left = (of(s, i, TARGET) - of(s, i, CYCLE)) * of(s, i, PERIOD)
    return of(s, i, START) + of(s, i, WAIT) > left


@njit(**WITHIN)
def find(s, i, p):
    """What a lane wants once the coming event, of which it was not certain, is found."""
    coming = any_event(p, FLIGHT, arc_of(s, i, p))
    if not (coming.event == IMPACT and -coming.velocity >= SLOWEST):
        return ALONE
    put(s, i, WAIT, coming.wait)
    put(s, i, SPEED, -coming.velocity)
    put(s, i, NEXT_COSINE, coming.cosine)
    put(s, i, NEXT_SINE, coming.sine)
    put(s, i, NEXT_SINH, coming.sinh)
    put(s, i, NEXT_VERSINH, coming.versinh)
    put(s, i, STAGE, ARRIVED)
    return LEG_END if over(s, i) else PEAK_SEEN


@njit(**WITHIN)
def see_peak(s, i, p):
    """The largest angle up to the coming impact."""
    side = int(of(s, i, SIDE))
    cosine, sine, sinh, versinh = (
        of(s, i, NEXT_COSINE),
        of(s, i, NEXT_SINE),
        of(s, i, NEXT_SINH),
        of(s, i, NEXT_VERSINH),
    )
    coming = Next(of(s, i, WAIT), IMPACT, side, 0.0, -of(s, i, SPEED), cosine, sine, sinh, versinh)
    put(s, i, PEAK, peak_with(p, arc_of(s, i, p), coming, of(s, i, PEAK)))


@njit(**WITHIN)
def note(s, trail):
    """Into each lane's trail the arc under way, again and again until the next one begins; now and then its forcing from the clock."""
    for i in range(LANES):
        impacts = int(of(s, i, IMPACTS))
        k = impacts - int(of(s, i, COUNTED))
        start, side = of(s, i, START), of(s, i, SIDE)
        trail[i, k, 0], trail[i, k, 1], trail[i, k, 4], trail[i, k, 6] = (
            of(s, i, CYCLE),
            start,
            side,
            of(s, i, VELOCITY),
        )
        if impacts & RESYNCHRONISE == 0 and of(s, i, STAGE) == WALK:
            sine, cosine, _, _ = direction(of(s, i, FREQUENCY) * start + of(s, i, PHASE))
            put(s, i, COSINE, side * cosine)
            put(s, i, SINE, side * sine)
