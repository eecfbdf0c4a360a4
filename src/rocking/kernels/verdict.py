"""What a response is: a cascade in which the first evidence that suffices decides, and nothing is a default.

In this order: no return, or rest for ever, proved by the march; a release like an earlier one (``release``); a stable
periodic orbit that the motion has reached (``cycle``); where nothing is lost, averages that converge as on a torus
(``lossless``); at the end of the budget an exponent clearly above zero. Else undetermined.
"""

import math
from typing import NamedTuple

from numba import njit

from .cycle import ON_EVENT, REACHED, find_cycle, loses, no_cycle
from .desk import BATCHES, LEG
from .elementary import COMPILED, ENTRY, WITHIN, WRITTEN_IN
from .judgement import NEUTRAL_ORBIT, ORBIT, ended, periodic, torus, unsettled
from .lossless import FEWEST_FLIGHTS, Flights, agreement, follow_flights, no_flights
from .march import DONE, UNKNOWN, begin
from .release import Watch, begin_measuring, begin_tangent, follow, released_since, unvisited, watched
from .returns import closest_return

FIRST_CHECKPOINT = 6
FIRST_CHECKPOINTS = 4  # cycles between the first ones
GROW_FROM = 14
CHECKPOINTS_GROW = 1.25
FIRST_SECTION = 0.3819660112501051  # of a period
NEXT_SECTION = 0.6180339887498949
# Newton's method may compute half as many events as the march, and this many in any case.
FREE_WORK = 10
UNMOVED = 1e-11
# A motion with more events a cycle than this on average is not judged to its end.
MOST_EVENTS_A_CYCLE = 200
FREE_EVENTS = 1_000_000


class Run(NamedTuple):
    """A motion under way."""

    watch: Watch
    flights: Flights
    section_time: float  # of the section, within a cycle
    count: int  # rows kept of it
    lossless: bool
    measuring: bool


@njit(**WITHIN)
def room(section, count, coming):
    """How many of the last rows stay when ``coming`` more are to follow: they are moved to the front."""
    kept = max(min(count, section.shape[0] - coming), 0)
    if kept < count:
        for k in range(kept):
            for column in range(4):
                section[k, column] = section[count - kept + k, column]
    return kept


@njit(**WRITTEN_IN)
def leg(p, run, target, most, desk):
    """(status, run): a motion followed to ``target`` with its last states."""
    watch, flights, section_time, count, lossless, measuring = run
    cycle, rows = watch.progress.cycle, desk.section.shape[0]
    count = room(desk.section, count, target - cycle)
    if lossless:
        status, progress, flights = follow_flights(
            p, watch.progress, flights, target, most, section_time, desk.section[count:], desk
        )
        watch = Watch(progress, watch.base, watch.brace, 0, 0.0, watch.peak)
        return status, Run(watch, flights, section_time, count + target - cycle, lossless, measuring)
    growth = desk.growth if measuring else desk.nothing.growth
    total, status = min(count + target - cycle, rows), DONE
    while status == DONE and cycle < target:
        # Of a long leg only the last states are kept.
        until = target if target - cycle <= rows else target - rows
        kept = desk.section[count:total] if until == target else desk.nothing.section
        status, watch = follow(p, watch, until, most, section_time, kept, desk.nothing, desk.columns, growth)
        cycle = watch.progress.cycle
    return status, Run(watch, flights, section_time, total, lossless, measuring)


@njit(**WITHIN)
def unmoved(section, count, max_period):
    """Whether the motion came back to where it was: on a torus only where that is a neutral periodic orbit, on chaos never."""
    lag, distance = closest_return(section, count, max_period)
    return lag > 0 and distance <= UNMOVED


@njit(**WITHIN)
def next_checkpoint(cycle):
    """When to look for a periodic orbit again: after 6, 10, 14 cycles, then ever later."""
    return cycle + FIRST_CHECKPOINTS if cycle < GROW_FROM else int(cycle * CHECKPOINTS_GROW)


@njit(**COMPILED)
def judge(p, angle, velocity, max_cycles, max_period, desk):
    """The ``Judgement`` of a motion from (angle, velocity), followed for ``max_cycles`` forcing cycles at most.

    In legs that end at checkpoints, where a periodic orbit is looked for, and, over the second half of the
    budget, at the ends of equal batches, over which the exponent is measured.
    """
    watch, flights, section_time = (
        watched(begin(p, angle, velocity, UNKNOWN)[0]),
        no_flights(),
        FIRST_SECTION * p.period,
    )
    most = MOST_EVENTS_A_CYCLE * max_cycles + FREE_EVENTS
    batch = max_cycles // (2 * BATCHES)
    measured, batch_end = 0, (max_cycles - BATCHES * batch) if batch > 0 else max_cycles + 1
    checkpoint, count, work, lossy, enough = FIRST_CHECKPOINT, 0, 0, 0, FEWEST_FLIGHTS
    digits, converged, grown, known, known_at = 0.0, False, 0.0, no_cycle(0), 0
    lossless, measuring = False, False
    while True:
        before, target = watch.progress, min(checkpoint, batch_end, max_cycles)
        run = Run(watch, flights, section_time, count, lossless, measuring)
        status, run = leg(p, run, target, most, desk)
        watch, flights, count = run.watch, run.flights, run.count
        if status != DONE:
            return ended(status, watch, work)
        after = watch.progress
        if loses(p, after.impacts - before.impacts, after.brace_hits - before.brace_hits):
            watch = unvisited(watch) if lossless else watch
            lossy, lossless, flights = target, False, no_flights()
        if target == batch_end:
            if measuring:
                # A release forgets all differences.
                forgets = released_since(watch, target - batch)
                grown = -math.inf if forgets else desk.growth[0] - grown
                desk.batches[measured] = grown / (batch * p.period)
                measured += 1
            elif not lossless:
                begin_measuring(watch, desk.columns, desk.growth)
            grown, measuring, batch_end = desk.growth[0], True, batch_end + batch
        if lossless and flights.count >= enough:
            digits, converged = agreement(flights, desk.flights, desk.growth[0])
            enough = flights.count * 5 // 4
        still = converged and unmoved(desk.section, count, max_period)
        if converged and not still:
            return torus(watch, work, section_time, digits)
        due = target in (checkpoint, max_cycles)
        if still or (due and not lossless):
            done = watch.progress.impacts + watch.progress.brace_hits
            most_work = done if still else FREE_WORK + done // 2 - work
            cycle = find_cycle(
                p, section_time, desk, count, max_period, most_work, known, target - known_at, still
            )
            work += cycle.work
            if cycle.answer == REACHED:
                return periodic(p, NEUTRAL_ORBIT if still else ORBIT, watch, work, cycle, section_time)
            if cycle.period > 0:
                known, known_at = cycle, (target if cycle.work > 0 else known_at)
            if cycle.answer == ON_EVENT:
                section_time, count = (section_time + NEXT_SECTION * p.period) % p.period, 0
                known = no_cycle(0)
        if due and not lossless and target >= GROW_FROM and 2 * lossy <= target:
            lossless, grown = True, 0.0
            begin_tangent(desk.columns, desk.growth)
        if target == max_cycles:
            stands = unmoved(desk.section, count, max_period)
            return unsettled(p, watch, work, max_cycles, measured, lossless, digits, desk.batches, stands)
        if target == checkpoint:
            checkpoint = target + LEG if lossless else next_checkpoint(target)


@njit(**ENTRY)
def judge_plain(p, angle, velocity, max_cycles, max_period, desk):
    """``judge`` for Python."""
    return judge(p, angle, velocity, max_cycles, max_period, desk)
