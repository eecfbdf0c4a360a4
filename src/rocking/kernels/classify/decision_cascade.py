"""Decision cascade of the classification: the first test with sufficient evidence decides, and there is no default.

The tests, in this order:

1. overturning is certain, or rest is permanent: proved by the march;
2. a reset, the same release as before (``reset``);
3. a stable periodic orbit that the motion has reached (``periodicity``);
4. for an undamped motion, averages that converge as on a torus (``quasi_periodicity``);
5. at the end of the budget, an exponent clearly above zero.

Else the motion is undetermined.
"""

import math

from rocking.kernels.classify.classifier_state import (
    Averages,
    Batches,
    KnownOrbit,
    as_lossless,
    as_lossy,
    batch_of,
    next_look,
    opened,
    with_averages,
    with_batches,
    with_checkpoint,
    with_known,
    with_losses,
    with_measuring,
    with_run,
    with_section,
)
from rocking.kernels.classify.lazy_section import evaluate_lazy_rows
from rocking.kernels.classify.leg import march_leg
from rocking.kernels.classify.periodicity import (
    ON_EVENT,
    REACHED,
    check_periodicity,
    loses,
    no_cycle,
    with_work,
)
from rocking.kernels.classify.quasi_periodicity import (
    agreeing_digits,
    digits_of_speeds,
    no_flights,
    under_way,
)
from rocking.kernels.classify.recurrence import closest_return
from rocking.kernels.classify.reset import begin_measuring, begin_tangent, released_since, unvisited
from rocking.kernels.classify.verdict_record import (
    NEUTRAL_ORBIT,
    OPEN,
    ORBIT,
    Findings,
    ended,
    periodic,
    torus,
    undecided,
    unsettled,
)
from rocking.kernels.classify.workspace import LEG
from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.march.march import DONE
from rocking.kernels.numerics.elementary import size

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


@njit(**INTERNAL)
def is_stationary(section, count, max_period):
    """Return whether the motion came back to an earlier state.

    On a torus that happens only on a neutral periodic orbit, in chaotic motion never.
    """
    lag, distance = closest_return(section, count, max_period)
    return lag > 0 and distance <= UNMOVED


@njit(**INTERNAL)
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


@njit(**INTERNAL)
def next_checkpoint(cycle, coming):
    """Return the cycle of the next search for a periodic orbit.

    If an orbit was found, the cycle is predicted. Otherwise the intervals grow.
    """
    if coming > 0:
        return cycle + min(coming, int(MAX_AHEAD * cycle))
    return cycle + max(int(CHECKPOINTS_GROW * cycle), MIN_AHEAD)


@njit(**INTERNAL_INLINE)
def over_batch(p, tracker, target, max_cycles, grown):
    """Return the exponent over the batch that ends at ``target``.

    The tangent vector has ``grown`` by this logarithm in the batch. A release in it erases all perturbations.
    """
    batch = batch_of(max_cycles)
    return (-math.inf if released_since(tracker, target - batch) else grown) / (batch * p.forcing.period)


@njit(**INTERNAL_INLINE)
def next_batch(case, max_cycles, growth):
    """Return the state at the start of the next batch."""
    run, batches = case.run, case.batches
    after = Batches(batches.end + batch_of(max_cycles), batches.measured + run.measuring, growth)
    return with_batches(case, with_measuring(run, True), after)


@njit(**INTERNAL)
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


@njit(**INTERNAL_INLINE)
def enough_after(count):
    """Return the number of arcs at which their averages are compared again."""
    return count * 5 // 4


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL)
def note_losses(p, case, target):
    """Return the state of a motion that may have dissipated energy since the last checkpoint.

    If it has, its arcs are discarded.
    """
    run, done = case.run, case.run.tracker.progress
    if not loses(p, done.impacts - case.impacts, done.brace_hits - case.brace_hits):
        return case
    tracker = unvisited(run.tracker) if run.lossless else run.tracker
    return with_losses(case, as_lossy(run, tracker, no_flights(), False), target)


@njit(**INTERNAL)
def compare_averages(case, workspace):
    """Return the state after a comparison of the averages over the arcs."""
    flights = case.run.flights
    digits, converged = agreeing_digits(
        flights, workspace.flights, workspace.weights, workspace.tangent.growth[0]
    )
    return with_averages(case, Averages(enough_after(flights.count), digits, converged))


@njit(**INTERNAL)
def stands_still(p, case, over, max_period, workspace):
    """Return whether the averages converge because the motion came back to an earlier state.

    Then it is no torus.
    """
    run, converged = case.run, case.averages.converged
    if converged or over:
        evaluate_lazy_rows(p, workspace.section, run.count - 1 - max_period, run.count, run.section_time)
    return converged and is_stationary(workspace.section, run.count, max_period)


@njit(**INTERNAL_INLINE)
def seek_orbit(p, case, target, max_period, workspace, still):
    """Test whether the motion has reached a periodic orbit; ``still`` allows a neutral one.

    Returns
    -------
    tuple of (tuple, ClassifierState, int)
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


@njit(**INTERNAL)
def expect_torus(case, workspace):
    """Return the state of a motion without dissipation for a long time: from here on its arcs are collected."""
    run, batches = case.run, case.batches
    begin_tangent(workspace.tangent)
    run = as_lossless(run, under_way(run.tracker.progress), True)
    return with_batches(case, run, Batches(batches.end, batches.measured, 0.0))


@njit(**INTERNAL)
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


@njit(**INTERNAL_INLINE)
def evaluate_checkpoint(p, case, status, run, max_cycles, max_period, workspace):
    """Evaluate a motion at a checkpoint, after a march that ended with ``status``.

    A march (leg) ends at a checkpoint, which does not depend on the budget. In the second half of the budget
    it also ends with each of the equal batches. At a checkpoint averages are compared. There and at the end
    of the budget a periodic orbit is sought. The end of a batch only adds to the exponent.

    Returns
    -------
    tuple of (tuple, ClassifierState)
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
        if verdict[0] != OPEN:
            return verdict, case
    if not case.run.lossless and 2 * case.lossy <= target:
        case = expect_torus(case, workspace)
    if over:
        return end_of_budget(p, case, target, max_period, workspace), case
    checkpoint = target + LEG if case.run.lossless else next_checkpoint(target, coming)
    case = with_checkpoint(case, done.impacts, done.brace_hits, checkpoint)
    return undecided(case.run.tracker), case


@njit(**INTERNAL_INLINE)
def judge(p, angle, velocity, max_cycles, max_period, workspace):
    """Classify a motion from (angle, velocity) within ``max_cycles`` forcing cycles.

    Returns the fields of ``Judgement`` as a flat tuple.
    """
    case = opened(p, angle, velocity, max_cycles)
    while True:
        status, run = march_leg(p, case.run, max_cycles, next_look(case, max_cycles), workspace)
        verdict, case = evaluate_checkpoint(p, case, status, run, max_cycles, max_period, workspace)
        if verdict[0] != OPEN:
            return verdict
