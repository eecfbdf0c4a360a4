"""Decision cascade of the classification: the first test with sufficient evidence decides, and there is no default.

The tests, in this order:

1. overturning is certain, or rest is permanent: proved by the march;
2. a reset, the same release as before (``resets``);
3. a stable periodic orbit that the motion has reached (``periodicity``);
4. for an undamped motion, averages that converge as on a torus (``torus``);
5. at the end of the budget, a Lyapunov exponent clearly above zero (``exponent``).

Else the motion is undetermined.
"""

from typing import NamedTuple

import numpy as np

from rocking.kernels.classify.exponent import (
    BATCHES,
    Batches,
    Findings,
    batch_of,
    begin_measuring,
    over_batch,
    unsettled,
)
from rocking.kernels.classify.periodicity import (
    ON_EVENT,
    REACHED,
    PeriodicityCheck,
    check_periodicity,
    loses,
    no_cycle,
    with_work,
)
from rocking.kernels.classify.resets import (
    ResetTracker,
    begin_tangent,
    follow,
    moved_on,
    new_tracker,
    unvisited,
)
from rocking.kernels.classify.section import append_lazy_rows, closest_return, evaluate_lazy_rows
from rocking.kernels.classify.torus import (
    MIN_FLIGHTS,
    Flights,
    agreeing_digits,
    collect,
    digits_of_speeds,
    no_flights,
    section_needed,
    under_way,
)
from rocking.kernels.classify.verdict import (
    NEUTRAL_ORBIT,
    OPEN,
    ORBIT,
    ended,
    periodic,
    torus,
    undecided,
)
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats1, Floats2
from rocking.kernels.motion.march import (
    DONE,
    PAUSED,
    RELEASED,
    UNKNOWN,
    NoRecording,
    Recording,
    begin,
    march_on,
    no_recording,
)
from rocking.kernels.motion.observers import EVENT_ROW, EventRows
from rocking.kernels.motion.tangent import TangentState
from rocking.kernels.numerics.elementary import size
from rocking.kernels.numerics.replace_fields import replacing

# Cycles between checkpoints of an undamped motion.
LEG = 128
# The last states are moved to the front once per this number of checkpoints.
SPARE = 3


FIRST_CHECKPOINT = 17
# Phase of the first section, in cycles: by chance alone an event lies there.
FIRST_SECTION = 0.3819660112501051
# A motion with a larger average number of events per cycle is not classified to its end.
MAX_EVENTS_A_CYCLE = 200
FREE_EVENTS = 1_000_000
# Maximum number of cycles to a predicted checkpoint, as a fraction of the cycles so far. The motion may approach another orbit
# than the predicted one. That is noticed at the next checkpoint only.
MAX_AHEAD = 0.5
# A checkpoint that is not predicted follows after this fraction of the cycles so far, but not after fewer than
# MIN_AHEAD: in lanes a checkpoint costs as much as 20 cycles.
CHECKPOINTS_GROW, MIN_AHEAD = 0.25, 10
NEXT_SECTION = 0.6180339887498949
# Newton's method may compute half as many events as the march, and this number in any case.
FREE_WORK = 10
UNMOVED = 1e-11
# A motion that stays this close to an unstable orbit has not left it.
NEAR = 1e-3


class Workspace(NamedTuple):
    """Preallocated arrays for the classification of one system after another."""

    section: Floats2  # (n, 8), the last cycles: ``observers.note_state``, then ``append_lazy_rows``
    scratch: Floats2  # (n, 4), states of a trial orbit; n also limits the number of last cycles used
    events: EventRows  # (n,)
    flights: Floats2  # (n, 2)
    weights: Floats1  # (n/4 + 1,)
    batches: Floats1
    tangent: TangentState  # (2, 2), (1,)
    trial: Floats2  # (2, 2), tangent vectors of a trial orbit
    nothing: NoRecording


def padded_row_length(count):
    """Return a row length of at least ``count``, padded for the cache.

    Consecutive rows start in different cache sets. Lanes write into all their rows in turn; equal alignment
    causes conflict misses.
    """
    return count + (8 - count) % 512


def make_workspace(max_cycles, max_period):
    """Allocate the workspace for runs of up to ``max_cycles`` and orbits of up to ``max_period``."""
    rows = max(4 * max_period, LEG) + 1
    flights = padded_row_length(min(max(4 * max_cycles, 1024), 1 << 18))
    return Workspace(
        np.empty((rows + SPARE * LEG, 8)),
        np.empty((rows, 4)),
        np.empty(512, EVENT_ROW),
        np.empty((flights, 2)),
        np.empty(flights // 4 + 1),
        np.empty(BATCHES),
        TangentState(np.empty((2, 2)), np.empty(1)),
        np.empty((2, 2)),
        no_recording(),
    )


class Run(NamedTuple):
    """Motion in progress, with the records that its classification needs."""

    tracker: ResetTracker
    flights: Flights
    section_time: float  # of the section, within a cycle
    count: int  # number of section rows kept
    lossless: bool
    measuring: bool


class Averages(NamedTuple):
    """Averages over the arcs, as last compared."""

    enough: int  # number of arcs at which they are compared again
    digits: float  # to which both halves agreed
    converged: bool


class KnownOrbit(NamedTuple):
    """Periodic orbit found last, and the cycle at which it was found."""

    check: PeriodicityCheck
    cycle: int


class ClassifierState(NamedTuple):
    """Motion and the knowledge of it at a checkpoint, between two marches."""

    run: Run
    impacts: int
    brace_hits: int
    checkpoint: int
    batches: Batches
    lossy: int  # last checkpoint with dissipation since the one before
    averages: Averages
    known: KnownOrbit
    work: int  # events computed by Newton's method


with_measuring = replacing(Run, "measuring")
with_section = replacing(Run, "section_time", "count")
as_lossy = replacing(Run, "tracker", "flights", "lossless")
as_lossless = replacing(Run, "flights", "lossless")
with_run = replacing(ClassifierState, "run")
with_batches = replacing(ClassifierState, "run", "batches")
with_averages = replacing(ClassifierState, "averages")
with_known = replacing(ClassifierState, "run", "known", "work")
with_losses = replacing(ClassifierState, "run", "lossy")
with_checkpoint = replacing(ClassifierState, "impacts", "brace_hits", "checkpoint")


@kernel
def opened(p, angle, velocity, max_cycles):
    """Return the state of a motion from (angle, velocity) at its start."""
    tracker = new_tracker(begin(p, angle, velocity, UNKNOWN)[0])
    run = Run(tracker, no_flights(), FIRST_SECTION * p.forcing.period, 0, False, False)
    batch = batch_of(max_cycles)
    batch_end = (max_cycles - BATCHES * batch) if batch > 0 else max_cycles + 1
    return ClassifierState(
        run=run,
        impacts=0,
        brace_hits=tracker.progress.brace_hits,
        checkpoint=FIRST_CHECKPOINT,
        batches=Batches(batch_end, 0, 0.0),
        lossy=0,
        averages=Averages(MIN_FLIGHTS, 0.0, False),
        known=KnownOrbit(no_cycle(0), 0),
        work=0,
    )


@kernel(inline=True)
def next_look(case, max_cycles):
    """Return the cycle of the next checkpoint, at which the coming march ends."""
    return min(case.checkpoint, case.batches.end, max_cycles)


@kernel(inline=True)
def most_events(max_cycles):
    """Return the maximum number of events of a motion; the classification of one with more is abandoned."""
    return MAX_EVENTS_A_CYCLE * max_cycles + FREE_EVENTS


@kernel
def make_room(section, count, coming, most_rows):
    """Return the number of section rows that stay when ``coming`` more follow.

    If these do not fit, the last rows move to the front.
    """
    if coming <= most_rows and count + coming <= section.shape[0]:
        return count
    kept = max(min(count, most_rows - coming), 0)
    if kept < count:
        for k in range(kept):
            for column in range(section.shape[1]):
                section[k, column] = section[count - kept + k, column]
    return kept


@kernel(inline=True)
def follow_flights(p, run, target, most, workspace, wanted):
    """March an undamped motion to the end of cycle ``target`` and collect its arcs between impacts.

    Rows of the section are added only if they are ``wanted``.

    Returns
    -------
    tuple of (int, Run)
        Status and run.
    """
    tracker, flights, section_time, count, lossless, measuring = run
    progress, events = tracker.progress, workspace.events
    recording = Recording(section_time, workspace.nothing.section, events, True, True)
    while True:
        before = progress
        status, progress, _, written = march_on(p, before, target, recording, workspace.tangent)
        flights = collect(p, flights, written, events, workspace.flights)
        if wanted:
            count = append_lazy_rows(
                p, before, events, written, progress, section_time, workspace.section, count
            )
        on = status in (PAUSED, RELEASED)
        if not on or progress.impacts + progress.brace_hits > most:
            return status, Run(moved_on(tracker, progress), flights, section_time, count, lossless, measuring)


@kernel(inline=True)
def march_leg(p, run, max_cycles, target, workspace):
    """March a motion to the end of cycle ``target``, with its last states.

    Returns
    -------
    tuple of (int, Run)
        Status and run.
    """
    most = most_events(max_cycles)
    tracker, flights, section_time, count, lossless, measuring = run
    cycle, rows, nothing = tracker.progress.cycle, workspace.scratch.shape[0], workspace.nothing
    count = make_room(workspace.section, count, target - cycle, rows)
    if lossless:
        wanted = section_needed(workspace.tangent.growth[0], target, max_cycles, rows)
        kept = Run(tracker, flights, section_time, count if wanted else 0, lossless, measuring)
        return follow_flights(p, kept, target, most, workspace, wanted)
    growth = workspace.tangent.growth if measuring else nothing.tangent.growth
    tangent = TangentState(workspace.tangent.columns, growth)
    # the section of the present cycle may have passed
    coming = target - cycle - (not tracker.progress.pending)
    total, status = count + min(coming, rows), np.int64(DONE)
    while status == DONE and cycle < target:
        # Only the last states of a long leg are kept.
        until = target if target - cycle <= rows else target - rows
        part = workspace.section[count:total] if until == target else nothing.section
        status, tracker = follow(p, tracker, until, most, section_time, part, tangent, nothing)
        cycle = tracker.progress.cycle
    return status, Run(tracker, flights, section_time, total, lossless, measuring)


@kernel
def is_stationary(section, count, max_period):
    """Return whether the motion came back to an earlier state.

    On a torus that happens only on a neutral periodic orbit, in chaotic motion never.
    """
    lag, distance = closest_return(section, count, max_period)
    return lag > 0 and distance <= UNMOVED


@kernel
def lingers_near(section, count, since, known):
    """Return whether the motion was near the ``known`` orbit in all recorded cycles.

    The orbit was found ``since`` cycles ago.
    """
    if known.period == 0:
        return False
    rows = range(count - 1 - since % known.period, -1, -known.period)
    for row in rows:
        if size(section[row, 0] - known.found.angle, section[row, 1] - known.found.velocity) > NEAR:
            return False
    return len(rows) > 0


@kernel
def next_checkpoint(cycle, coming):
    """Return the cycle of the next search for a periodic orbit.

    If an orbit was found, the cycle is predicted. Otherwise the intervals grow.
    """
    if coming > 0:
        return cycle + min(coming, int(MAX_AHEAD * cycle))
    return cycle + max(int(CHECKPOINTS_GROW * cycle), MIN_AHEAD)


@kernel(inline=True)
def next_batch(case, max_cycles, growth):
    """Return the state at the start of the next batch."""
    run, batches = case.run, case.batches
    after = Batches(batches.end + batch_of(max_cycles), batches.measured + run.measuring, growth)
    return with_batches(case, with_measuring(run, True), after)


@kernel
def end_batch(p, case, target, max_cycles, workspace):
    """Write the exponent over the batch that ends at ``target``, or begin to measure.

    A dissipative motion begins with tangent vectors of size 1.
    """
    run, batches, growth = case.run, case.batches, workspace.tangent.growth
    if run.measuring:
        exponent = over_batch(p, run.tracker, target, max_cycles, growth[0] - batches.grown)
        workspace.batches[batches.measured] = exponent
    elif not run.lossless:
        begin_measuring(run.tracker, workspace.tangent)
    return next_batch(case, max_cycles, growth[0])


@kernel(inline=True)
def enough_after(count):
    """Return the number of arcs at which their averages are compared again."""
    return count * 5 // 4


@kernel(inline=True)
def checkpoint_unstable(case, flights, max_cycles, growth):
    """Return the state after a checkpoint of an undamped motion whose tangent growth excludes a torus.

    The checkpoint is not the last, and the motion has the given number of ``flights``, its arcs between
    impacts. Only an exponent could be recorded, if a batch has ended.
    """
    target, averages = next_look(case, max_cycles), case.averages
    due = target == case.checkpoint
    if target == case.batches.end:
        case = next_batch(case, max_cycles, growth)
    if due and flights >= averages.enough:
        averages = Averages(enough_after(flights), 0.0, False)
    else:
        averages = Averages(averages.enough, averages.digits, False)
    checkpoint = target + LEG if due else case.checkpoint
    return with_checkpoint(with_averages(case, averages), case.impacts, case.brace_hits, checkpoint)


@kernel
def note_losses(p, case, target):
    """Return the state of a motion that may have dissipated energy since the last checkpoint.

    If it has, its arcs are discarded.
    """
    run, done = case.run, case.run.tracker.progress
    if not loses(p, done.impacts - case.impacts, done.brace_hits - case.brace_hits):
        return case
    tracker = unvisited(run.tracker) if run.lossless else run.tracker
    return with_losses(case, as_lossy(run, tracker, no_flights(), False), target)


@kernel
def compare_averages(case, workspace):
    """Return the state after a comparison of the averages over the arcs."""
    flights = case.run.flights
    digits, converged = agreeing_digits(
        flights, workspace.flights, workspace.weights, workspace.tangent.growth[0]
    )
    return with_averages(case, Averages(enough_after(flights.count), digits, converged))


@kernel
def stands_still(p, case, over, max_period, workspace):
    """Return whether the averages converge because the motion came back to an earlier state.

    Then it is no torus.
    """
    run, converged = case.run, case.averages.converged
    if converged or over:
        evaluate_lazy_rows(p, workspace.section, run.count - 1 - max_period, run.count, run.section_time)
    return converged and is_stationary(workspace.section, run.count, max_period)


@kernel(inline=True)
def seek_orbit(p, case, target, max_period, workspace, still):
    """Test whether the motion has reached a periodic orbit; ``still`` allows a neutral one.

    Returns
    -------
    tuple of (Judgement, ClassifierState, int)
        Verdict, of kind OPEN if the motion has not reached an orbit.
        State.
        Predicted number of cycles until an orbit may be reached, 0 if unknown.
    """
    run, known, done = case.run, case.known, case.run.tracker.progress
    events = done.impacts + done.brace_hits
    most_work = events if still else FREE_WORK + events // 2 - case.work
    since = target - known.cycle
    check = check_periodicity(p, run, workspace, max_period, most_work, known.check, since, still)
    work = case.work + check.work
    if check.answer == REACHED:
        ground = NEUTRAL_ORBIT if still else ORBIT
        return periodic(p, ground, run.tracker, with_work(check, work), run.section_time), case, 0
    if check.period > 0:
        known = KnownOrbit(check, target if check.work > 0 else known.cycle)
    if check.answer == ON_EVENT:
        run = with_section(run, (run.section_time + NEXT_SECTION * p.forcing.period) % p.forcing.period, 0)
        known = KnownOrbit(no_cycle(0), known.cycle)
    return undecided(run.tracker), with_known(case, run, known, work), check.coming


@kernel
def expect_torus(case, workspace):
    """Return the state of a motion without dissipation for a long time: from here on its arcs are collected."""
    run, batches = case.run, case.batches
    begin_tangent(workspace.tangent)
    run = as_lossless(run, under_way(run.tracker.progress), True)
    return with_batches(case, run, Batches(batches.end, batches.measured, 0.0))


@kernel
def end_of_budget(p, case, target, max_period, workspace):
    """Return the verdict at the end of the budget."""
    run, known, section = case.run, case.known, workspace.section
    evaluate_lazy_rows(p, section, 0, run.count, run.section_time)
    findings = Findings(
        measured=case.batches.measured,
        lossless=run.lossless,
        digits=digits_of_speeds(run.flights, workspace.flights, workspace.weights),
        stands=is_stationary(section, run.count, max_period),
        lingers=lingers_near(section, run.count, target - known.cycle, known.check),
    )
    return unsettled(p, run.tracker, case.work, target, workspace.batches, findings)


@kernel(inline=True)
def evaluate_checkpoint(p, case, status, run, max_cycles, max_period, workspace):
    """Evaluate a motion at a checkpoint, after a march that ended with ``status``.

    A march (leg) ends at a checkpoint, which does not depend on the budget. In the second half of the budget
    it also ends with each of the equal batches. At a checkpoint averages are compared. There and at the end
    of the budget a periodic orbit is sought. The end of a batch only adds to the exponent.

    Returns
    -------
    tuple of (Judgement, ClassifierState)
        Verdict, of kind OPEN if nothing decides yet.
        State.
    """
    if status != DONE:
        return ended(status, run.tracker, case.work), case
    case, target, done = with_run(case, run), next_look(case, max_cycles), run.tracker.progress
    due, over, coming = target == case.checkpoint, target == max_cycles, 0
    if due or over:
        case = note_losses(p, case, target)
    if target == case.batches.end:
        case = end_batch(p, case, target, max_cycles, workspace)
    if not (due or over):
        return undecided(run.tracker), case
    if case.run.lossless and due and case.run.flights.count >= case.averages.enough:
        case = compare_averages(case, workspace)
    still = stands_still(p, case, over, max_period, workspace)
    if due and case.averages.converged and not still:
        return torus(case.run.tracker, case.work, case.run.section_time, case.averages.digits), case
    if still or not case.run.lossless:
        verdict, case, coming = seek_orbit(p, case, target, max_period, workspace, still)
        if verdict.kind != OPEN:
            return verdict, case
    if not case.run.lossless and 2 * case.lossy <= target:
        case = expect_torus(case, workspace)
    if over:
        return end_of_budget(p, case, target, max_period, workspace), case
    checkpoint = target + LEG if case.run.lossless else next_checkpoint(target, coming)
    case = with_checkpoint(case, done.impacts, done.brace_hits, checkpoint)
    return undecided(case.run.tracker), case


@kernel(inline=True)
def judge(p, angle, velocity, max_cycles, max_period, workspace):
    """Classify a motion from (angle, velocity) within ``max_cycles`` forcing cycles; return its ``Judgement``."""
    case = opened(p, angle, velocity, max_cycles)
    while True:
        status, run = march_leg(p, case.run, max_cycles, next_look(case, max_cycles), workspace)
        verdict, case = evaluate_checkpoint(p, case, status, run, max_cycles, max_period, workspace)
        if verdict.kind != OPEN:
            return verdict
