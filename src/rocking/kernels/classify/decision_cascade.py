"""What a response is: a cascade in which the first evidence that suffices decides, and nothing is a default.

In this order: no return, or rest for ever, proved by the march; a release like an earlier one (``reset``); a stable
periodic orbit that the motion has reached (``periodicity``); where nothing is lost, averages that converge as on a torus
(``quasi_periodicity``); at the end of the budget an exponent clearly above zero. Else undetermined.
"""

import math

import numpy as np
from numba import njit

from rocking.kernels.classify.classifier_state import ClassifierState, Run, batch_of, next_look, opened
from rocking.kernels.classify.periodicity import ON_EVENT, REACHED, check_periodicity, loses, no_cycle
from rocking.kernels.classify.quasi_periodicity import (
    agreement,
    digits_of_speeds,
    evaluate_lazy_rows,
    follow_flights,
    no_flights,
    section_needed,
    under_way,
)
from rocking.kernels.classify.recurrence import closest_return
from rocking.kernels.classify.reset import (
    begin_measuring,
    begin_tangent,
    follow,
    moved_on,
    released_since,
    unvisited,
)
from rocking.kernels.classify.verdict_record import (
    NEUTRAL_ORBIT,
    OPEN,
    ORBIT,
    ended,
    periodic,
    torus,
    undecided,
    unsettled,
)
from rocking.kernels.classify.workspace import LEG
from rocking.kernels.compile_options import AST_INLINE, ENTRY_POINT, INTERNAL, INTERNAL_INLINE
from rocking.kernels.march.march import DONE
from rocking.kernels.numerics.elementary import size

CHECKPOINTS_GROW = 1.25
NEXT_SECTION = 0.6180339887498949
# Newton's method may compute half as many events as the march, and this many in any case.
FREE_WORK = 10
UNMOVED = 1e-11
# A motion that stays as near as this to an unstable orbit has not left it.
NEAR = 1e-3
# A motion with more events a cycle than this on average is not judged to its end.
MAX_EVENTS_A_CYCLE = 200
FREE_EVENTS = 1_000_000


@njit(**INTERNAL)
def room(section, count, coming, looked_at):
    """How many rows stay when ``coming`` more are to follow: where they do not fit the last ones are moved to the front."""
    if coming <= looked_at and count + coming <= section.shape[0]:
        return count
    kept = max(min(count, looked_at - coming), 0)
    if kept < count:
        for k in range(kept):
            for column in range(section.shape[1]):
                section[k, column] = section[count - kept + k, column]
    return kept


@njit(**INTERNAL_INLINE)
def most_events(max_cycles):
    """A motion with more events is not judged to its end."""
    return MAX_EVENTS_A_CYCLE * max_cycles + FREE_EVENTS


@njit(**AST_INLINE)
def march_leg(p, run, max_cycles, target, workspace):
    """(status, run): a motion followed to ``target`` with its last states."""
    most = most_events(max_cycles)
    watch, flights, section_time, count, lossless, measuring = run
    cycle, rows = watch.progress.cycle, workspace.scratch.shape[0]
    count = room(workspace.section, count, target - cycle, rows)
    if lossless:
        wanted = section_needed(workspace.growth[0], target, max_cycles, rows)
        status, progress, flights, count = follow_flights(
            p, watch.progress, flights, target, most, section_time, count if wanted else 0, workspace, wanted
        )
        watch = moved_on(watch, progress)
        return status, Run(watch, flights, section_time, count, lossless, measuring)
    growth = workspace.growth if measuring else workspace.nothing.growth
    # the section of the cycle under way may be past
    coming = target - cycle - (not watch.progress.pending)
    total, status = count + min(coming, rows), np.int64(DONE)
    while status == DONE and cycle < target:
        # Of a long leg only the last states are kept.
        until = target if target - cycle <= rows else target - rows
        kept = workspace.section[count:total] if until == target else workspace.nothing.section
        status, watch = follow(
            p, watch, until, most, section_time, kept, workspace.nothing, workspace.columns, growth
        )
        cycle = watch.progress.cycle
    return status, Run(watch, flights, section_time, total, lossless, measuring)


@njit(**INTERNAL)
def is_stationary(section, count, max_period):
    """Whether the motion came back to where it was: on a torus only where that is a neutral periodic orbit, on chaos never."""
    lag, distance = closest_return(section, count, max_period)
    return lag > 0 and distance <= UNMOVED


@njit(**INTERNAL)
def lingers_near(section, count, since, known):
    """Whether the motion was near the ``known`` orbit, found ``since`` cycles ago, in all of the cycles that are kept."""
    if known.period == 0:
        return False
    rows = range(count - 1 - since % known.period, -1, -known.period)
    for row in rows:
        if size(section[row, 0] - known.found.angle, section[row, 1] - known.found.velocity) > NEAR:
            return False
    return len(rows) > 0


@njit(**INTERNAL)
def next_checkpoint(cycle, coming):
    """When to look for a periodic orbit again: as foretold, where one was found, else ever later."""
    return cycle + min(coming, cycle // 2) if coming > 0 else int(cycle * CHECKPOINTS_GROW)


@njit(**INTERNAL_INLINE)
def over_batch(p, watch, target, max_cycles, grown):
    """The exponent over the batch that ends at ``target``, in which differences have ``grown``; a release forgets them all."""
    batch = batch_of(max_cycles)
    return (-math.inf if released_since(watch, target - batch) else grown) / (batch * p.period)


@njit(**INTERNAL_INLINE)
def batch_after(target, max_cycles, batch_end, measured, measuring, grown, growth):
    """(the end of the next batch, how many are measured, whether that has begun, the growth before it) after a leg to ``target``."""
    if target != batch_end:
        return batch_end, measured, measuring, grown
    return batch_end + batch_of(max_cycles), measured + measuring, True, growth


@njit(**INTERNAL_INLINE)
def measure(p, watch, target, max_cycles, measured, measuring, grown, lossless, workspace):
    """Write the exponent over the batch that ends, or begin to measure: with differences of size 1 unless nothing is lost."""
    if measuring:
        workspace.batches[measured] = over_batch(p, watch, target, max_cycles, workspace.growth[0] - grown)
    elif not lossless:
        begin_measuring(watch, workspace.columns, workspace.growth)


@njit(**INTERNAL_INLINE)
def enough_after(count):
    """How many flights there must be for their averages to be compared again."""
    return count * 5 // 4


@njit(**INTERNAL_INLINE)
def checkpoint_unstable(case, flights, max_cycles, growth):
    """What ``checkpoint`` makes of a case, before the end, of a motion without loss that has outgrown any torus, after so many flights.

    Only an exponent could be noted, if a batch has ended.
    """
    run, target = case.run, next_look(case, max_cycles)
    batch_end, measured, measuring, grown = batch_after(
        target, max_cycles, case.batch_end, case.measured, run.measuring, case.grown, growth
    )
    run = Run(run.watch, run.flights, run.section_time, run.count, run.lossless, measuring)
    due = target == case.checkpoint
    compared = due and flights >= case.enough
    return ClassifierState(
        run, case.impacts, case.brace_hits, target + LEG if due else case.checkpoint, batch_end, measured,
        grown, case.lossy, enough_after(flights) if compared else case.enough,
        0.0 if compared else case.digits, False, case.known, case.known_at, case.work
    )  # fmt: skip


@njit(**AST_INLINE)
def evaluate_checkpoint(p, case, status, run, max_cycles, max_period, workspace):
    """(judgement, case) after a leg that ended so: kind OPEN where nothing decides yet.

    Legs end at checkpoints, which do not depend on the budget, and in its second half at the ends of equal batches. At a
    checkpoint averages are compared, there and at the end a periodic orbit is sought; a batch only adds to the exponent.
    """
    impacts, brace_hits, checkpoint, batch_end, measured, grown, lossy = case[1:8]
    enough, digits, converged, known, known_at, work = case[8:]
    watch, flights, section_time, count, lossless, measuring = run
    if status != DONE:
        return ended(status, watch, work), case
    target, done = next_look(case, max_cycles), watch.progress
    due, over = target == checkpoint, target == max_cycles
    if (due or over) and loses(p, done.impacts - impacts, done.brace_hits - brace_hits):
        watch = unvisited(watch) if lossless else watch
        lossy, lossless, flights = target, False, no_flights()
    if target == batch_end:
        measure(p, watch, target, max_cycles, measured, measuring, grown, lossless, workspace)
    batch_end, measured, measuring, grown = batch_after(
        target, max_cycles, batch_end, measured, measuring, grown, workspace.growth[0]
    )
    if not (due or over):
        run = Run(watch, flights, section_time, count, lossless, measuring)
        return undecided(watch), ClassifierState(
            run, impacts, brace_hits, checkpoint, batch_end, measured, grown, lossy, enough, digits,
            converged, known, known_at, work
        )  # fmt: skip
    if lossless and due and flights.count >= enough:
        digits, converged = agreement(flights, workspace.flights, workspace.weights, workspace.growth[0])
        enough = enough_after(flights.count)
    coming = 0
    if converged or over:
        evaluate_lazy_rows(p, workspace.section, count - 1 - max_period, count, section_time)
    still = converged and is_stationary(workspace.section, count, max_period)
    if due and converged and not still:
        return torus(watch, work, section_time, digits), case
    if still or not lossless:
        events = done.impacts + done.brace_hits
        most_work = events if still else FREE_WORK + events // 2 - work
        evaluate_lazy_rows(p, workspace.section, 0, count, section_time)
        cycle = check_periodicity(
            p, section_time, workspace, count, max_period, most_work, known, target - known_at, still
        )
        work, coming = work + cycle.work, cycle.coming
        if cycle.answer == REACHED:
            ground = NEUTRAL_ORBIT if still else ORBIT
            return periodic(p, ground, watch, work, cycle, section_time), case
        if cycle.period > 0:
            known, known_at = cycle, (target if cycle.work > 0 else known_at)
        if cycle.answer == ON_EVENT:
            section_time, count = (section_time + NEXT_SECTION * p.period) % p.period, 0
            known = no_cycle(0)
    if not lossless and 2 * lossy <= target:
        lossless, grown, flights = True, 0.0, under_way(done)
        begin_tangent(workspace.columns, workspace.growth)
    if over:
        stands = is_stationary(workspace.section, count, max_period)
        lingers = lingers_near(workspace.section, count, target - known_at, known)
        digits = digits_of_speeds(flights, workspace.flights, workspace.weights)
        told = unsettled(
            p, watch, work, max_cycles, batch_of(max_cycles) * p.period, measured, lossless, digits,
            workspace.batches, stands, lingers
        )  # fmt: skip
        return told, case
    checkpoint = target + LEG if lossless else next_checkpoint(target, coming)
    run = Run(watch, flights, section_time, count, lossless, measuring)
    case = ClassifierState(
        run, done.impacts, done.brace_hits, checkpoint, batch_end, measured, grown, lossy, enough, digits,
        converged, known, known_at, work
    )  # fmt: skip
    return undecided(watch), case


@njit(**AST_INLINE)
def judge(p, angle, velocity, max_cycles, max_period, workspace):
    """The ``Judgement`` of a motion from (angle, velocity), followed for ``max_cycles`` forcing cycles at most."""
    case = opened(p, angle, velocity, max_cycles)
    while True:
        status, run = march_leg(p, case.run, max_cycles, next_look(case, max_cycles), workspace)
        told, case = evaluate_checkpoint(p, case, status, run, max_cycles, max_period, workspace)
        if told[0] != OPEN:
            return told


@njit(**ENTRY_POINT)
def judge_plain(p, angle, velocity, max_cycles, max_period, workspace):
    """``judge`` for Python."""
    return judge(p, angle, velocity, max_cycles, max_period, workspace)
