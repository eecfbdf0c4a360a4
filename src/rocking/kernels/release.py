"""Motions that come to rest or lean: every lift-off, and every release from a brace, is the same state up to symmetry."""

import math
from typing import NamedTuple

from numba import njit

from .elementary import WITHIN, WRITTEN_IN
from .events import FLIGHT
from .march import PAUSED, RELEASED, Progress, march_on
from .tangent import normalised, read_tangent, write_tangent

# Differences that grow by less between two releases leave the later one certain in double precision.
LARGEST_STRAIN = math.log(1e8)


class Visit(NamedTuple):
    """The last release of one kind, and what happened since."""

    seen: bool
    cycle: int
    time: float
    strain: float
    peak: float


class Watch(NamedTuple):
    """A motion under way, with its releases.

    ``half_periods`` is how many half cycles of the forcing apart the last two releases of one kind were, if
    they prove an orbit; negative if differences grew too much in between; 0 before. The progress counts its
    peak anew at each release.
    """

    progress: Progress
    base: Visit
    brace: Visit
    half_periods: int
    orbit_peak: float
    peak: float


@njit(**WITHIN)
def watched(progress):
    """A motion at its start."""
    never = Visit(False, 0, 0.0, -math.inf, 0.0)
    return Watch(progress, never, never, 0, 0.0, progress.peak)


@njit(**WITHIN)
def unvisited(watch):
    """The same motion, its releases forgotten: what differences have grown to since is no longer known."""
    anew = watched(watch.progress)
    return Watch(anew.progress, anew.base, anew.brace, 0, 0.0, watch.peak)


@njit(**WITHIN)
def largest_angle(watch):
    """Largest angle since the start."""
    return max(watch.peak, watch.progress.peak)


@njit(**WITHIN)
def released_since(watch, cycle):
    """Whether the block was released in ``cycle`` or later."""
    return (watch.base.seen and watch.base.cycle >= cycle) or (
        watch.brace.seen and watch.brace.cycle >= cycle
    )


@njit(**WITHIN)
def after_flight(visit, strain, peak):
    """A visit after one more flight that ended in rest or leaning."""
    return Visit(visit.seen, visit.cycle, visit.time, max(visit.strain, strain), max(visit.peak, peak))


@njit(**WITHIN)
def at_release(p, watch, progress):
    """The watch at a release, from the base (the arc begins there) or from a brace."""
    base = after_flight(watch.base, progress.strain, progress.peak)
    brace = after_flight(watch.brace, progress.strain, progress.peak)
    arc = progress.arc
    visit = base if arc.angle == 0.0 else brace
    half_periods = 0
    if visit.seen:
        cycles = progress.cycle - visit.cycle + (arc.start - visit.time) / p.period
        half_periods = round(2.0 * cycles)
        if not visit.strain < LARGEST_STRAIN:
            half_periods = -half_periods
    now = Visit(True, progress.cycle, arc.start, -math.inf, 0.0)
    anew = Progress(
        progress.mode,
        progress.cycle,
        arc,
        progress.pending,
        progress.crowd,
        progress.impacts,
        progress.brace_hits,
        arc.angle,
        progress.no_return,
        progress.last_wait,
        progress.wait_before,
        -math.inf,
    )
    peak = max(watch.peak, progress.peak)
    if arc.angle == 0.0:
        return Watch(anew, now, brace, half_periods, visit.peak, peak)
    return Watch(anew, base, now, half_periods, visit.peak, peak)


@njit(**WRITTEN_IN)
def follow(p, watch, target, most_events, section_time, section, nothing, columns, growth):
    """(status, watch) at the end of cycle ``target``, or at the release that decides; RELEASED only then.

    ``section`` must have a row for every cycle to come, or none. ``columns`` (2, 2) carries differences
    since the last release; with ``growth`` (1,) from the start.
    """
    rows = 0
    tracked = columns if watch.base.seen or watch.brace.seen or growth.shape[0] > 0 else nothing.columns
    while True:
        status, progress, taken, _ = march_on(
            p,
            watch.progress,
            target,
            section_time,
            section if rows == 0 else section[rows:],
            nothing.events,
            tracked,
            growth,
            True,
            True,
        )
        rows += taken
        if status == RELEASED:
            watch = at_release(p, watch, progress)
            if watch.half_periods != 0:
                return RELEASED, watch
            tracked = columns
            begin_tangent(columns, growth)
            continue
        watch = Watch(progress, watch.base, watch.brace, 0, 0.0, watch.peak)
        if status != PAUSED or progress.impacts + progress.brace_hits > most_events:
            return status, watch


@njit(**WITHIN)
def begin_tangent(columns, growth):
    """Differences of size 1 along both axes."""
    columns[0, 0], columns[0, 1], columns[1, 0], columns[1, 1] = 1.0, 0.0, 0.0, 1.0
    growth[:] = 0.0


@njit(**WITHIN)
def begin_measuring(watch, columns, growth):
    """From here on growth is measured; what differences have grown to since the last release stays in it."""
    if watch.progress.mode == FLIGHT and (watch.base.seen or watch.brace.seen):
        growth[:] = 0.0
        write_tangent(columns, normalised(read_tangent(columns), growth))
    else:
        begin_tangent(columns, growth)
