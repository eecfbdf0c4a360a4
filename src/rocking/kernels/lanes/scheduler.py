"""Batch scheduler: the decision cascade for many systems, each in a lane as soon as plain marching remains.

Before that each system is marched alone. Marches and checkpoints are the same in both; a lane only marches.
The verdict on a block never depends on the other lanes.
"""

import math
from typing import NamedTuple

import numpy as np

from rocking.kernels.arc.slender_cosine import exponentials
from rocking.kernels.classify.cascade import (
    LEG,
    ClassifierState,
    checkpoint_unstable,
    evaluate_checkpoint,
    march_leg,
    next_look,
    opened,
    over_batch,
    with_run,
)
from rocking.kernels.classify.resets import begin_tangent
from rocking.kernels.classify.torus import section_needed
from rocking.kernels.classify.verdict import OPEN, ResultArrays, store_result
from rocking.kernels.event_kinds import FLIGHT, IMPACT
from rocking.kernels.lanes.scalar import log_arcs, request_of_leg, resolve_alone, update_peak
from rocking.kernels.lanes.state import (
    END_LEG,
    IDLE,
    LANES,
    LOAD_NEXT,
    NO_REQUEST,
    SLOWEST,
    TO_SCALAR,
    UPDATE_PEAK,
    LaneWorkspace,
    flights_by_now,
    lane_workspace,
    load_block,
    load_work,
    read_growth,
    set_collection,
    set_difference,
    set_leg,
    status_of,
    store_work,
    unload_block,
)
from rocking.kernels.lanes.step import advance, advance_between, apply_events, apply_impacts
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats2, Integers1
from rocking.kernels.system import Cosine, Slender, slender_of_row

# With a shorter forcing period an arc has too many sign intervals for a search in lockstep.
MIN_LANE_PERIOD = 0.1
# Of the damped motions few last longer than this; at the end of a batch the last ones would occupy all lanes.
MOST_LOSSY_CYCLES = 512


class LaneWork(NamedTuple):
    """Work item of a lane: a point of the batch (-1 if the lane is idle), its system and its classification."""

    point: int
    p: Slender[Cosine]
    case: ClassifierState


class BatchRequest(NamedTuple):
    """Batch request: systems, initial states, cycle budget and result arrays."""

    systems: np.ndarray
    starts: np.ndarray
    max_cycles: int
    max_period: int
    results: ResultArrays


@kernel
def lane_eligible(p, case):
    """Return whether a motion may be marched in lanes.

    Without braces it is undamped, or in its first MOST_LOSSY_CYCLES. A motion with losses has not rested before.
    If c+ > 0 it probably overturns on this arc.
    """
    run, tracker = case.run, case.run.tracker
    progress, arc = tracker.progress, tracker.progress.arc
    if progress.mode != FLIGHT or not (p.forcing.amplitude > 1.0 and p.forcing.period >= MIN_LANE_PERIOD):
        return False
    braced = p.block.brace_angle < math.inf
    if run.lossless:
        return not braced and run.flights.event == IMPACT and arc.velocity >= SLOWEST
    early = progress.cycle < MOST_LOSSY_CYCLES and not exponentials(p, arc)[0] > 0.0
    return (braced or early) and not (tracker.base.seen or tracker.brace.seen)


@kernel(inline=True)
def try_skip_readback(s, i, work, max_cycles, workspace):
    """Start the next leg of a lane without reading its block, if the tangent growth already excludes a torus.

    The growth is read in any case.

    Returns
    -------
    tuple of (bool, LaneWork)
        Whether the leg was started.
        The work item.
    """
    point, p, case = work
    target, most = next_look(case, max_cycles), workspace.flights.shape[1]
    if not case.run.lossless or s.log_on[i] > 0.0 or case.averages.converged or target == max_cycles:
        return False, work
    read_growth(s, i, workspace.tangent.columns[i], workspace.tangent.growth[i])
    growth = workspace.tangent.growth[i, 0]
    further = checkpoint_unstable(case, flights_by_now(s, i, case.run.flights, most), max_cycles, growth)
    ahead = next_look(further, max_cycles)
    if section_needed(growth, ahead, max_cycles, workspace.scratch.shape[0]):
        return False, work
    if further.batches.measured > case.batches.measured:
        exponent = over_batch(p, case.run.tracker, target, max_cycles, growth - case.batches.grown)
        workspace.batches[i, case.batches.measured] = exponent
    set_leg(s, i, ahead, False)
    return True, LaneWork(point, p, further)


@kernel
def open_point(point, batch):
    """Return the work item of a point at its start."""
    p = slender_of_row(batch.systems[point])
    return LaneWork(point, p, opened(p, batch.starts[point, 0], batch.starts[point, 1], batch.max_cycles))


@kernel(inline=True)
def start_leg(s, i, work, stays, max_cycles, own):
    """Start the next leg of a lane with its work item, whose block ``stays`` in the lane or is loaded."""
    case = work.case
    if stays:
        set_difference(s, i, own.tangent.columns)
    else:
        load_block(s, i, work.p, case.run.tracker.progress, own.tangent.columns)
    set_collection(s, i, case.run)
    # no more cycles than the section has rows for
    target = min(next_look(case, max_cycles), case.run.tracker.progress.cycle + LEG)
    needed = section_needed(own.tangent.growth[0], target, max_cycles, own.scratch.shape[0])
    set_leg(s, i, target, not case.run.lossless or needed)


@kernel(inline=True)
def service_lane(s, i, request, work, queue, batch, workspace):
    """Service one lane at the end of a leg, or of part of one, and start its next leg.

    Motions that are not eligible for lanes are marched here, one block at a time.

    Returns
    -------
    tuple of (LaneWork, int)
        Work item: the same if it continues in the lane, else the next eligible one.
        Next point of the queue.
    """
    own, max_cycles = lane_workspace(workspace, i), batch.max_cycles
    settled, ended = request == LOAD_NEXT, request == END_LEG
    marched = ended and s.target[i] == next_look(work.case, max_cycles)
    stays, due = request < LOAD_NEXT or ended, marched or request == TO_SCALAR
    if not settled:
        run = unload_block(s, i, request, work.p, work.case.run, own, workspace.log[i])
        work = LaneWork(work.point, work.p, with_run(work.case, run))
    while due or settled or not lane_eligible(work.p, work.case):
        if settled:
            if queue == batch.systems.shape[0]:
                s.stage[i] = IDLE
                return LaneWork(-1, work.p, work.case), queue
            work, queue, stays = open_point(queue, batch), queue + 1, False
            if lane_eligible(work.p, work.case):
                begin_tangent(own.tangent)
                break
        point, p, case = work
        status, run = status_of(s, i, max_cycles), case.run
        if not marched:
            stays = False
            status, run = march_leg(p, run, max_cycles, next_look(case, max_cycles), own)
        verdict, case = evaluate_checkpoint(p, case, status, run, max_cycles, batch.max_period, own)
        work, due, marched, settled = LaneWork(point, p, case), False, False, verdict[0] != OPEN
        if settled:
            store_result(batch.results, point, verdict)
    start_leg(s, i, work, stays, max_cycles, own)
    return work, queue


@kernel(inline=True)
def service_until_ready(s, i, request, work, queue, batch, workspace):
    """Fulfil this and the following requests of a lane.

    Returns
    -------
    tuple of (LaneWork, int)
        Work item of the lane.
        Next point of the queue.
    """
    while request > UPDATE_PEAK:
        skipped = False
        if request == END_LEG:
            skipped, work = try_skip_readback(s, i, work, batch.max_cycles, workspace)
        if not skipped:
            work, queue = service_lane(s, i, request, work, queue, batch, workspace)
        request = request_of_leg(s, i, work.p)
    return work, queue


@kernel
def run_lanes(s, flights, log, braced, stop):
    """March all lanes until one of them makes a request."""
    while stop[0] == 0:
        if braced:
            apply_events(s)
        else:
            apply_impacts(s)
        log_arcs(s, flights, log)
        if advance_between(s) if braced else advance(s):
            return


@entry_point(long=True)
def classify_batch_lanes(
    systems: Floats2,
    starts: Floats2,
    max_cycles: int,
    max_period: int,
    workspace: LaneWorkspace,
    results: ResultArrays,
    stop: Integers1,
) -> bool:
    """Classify a batch in lanes, all points with braces or all without.

    The arguments are those of ``batch.classify_batch_scalar``. Returns True if all points were classified,
    False if ``stop[0]`` was set before the end.
    """
    batch = BatchRequest(systems, starts, max_cycles, max_period, results)
    s, p, queue, busy = workspace.state[0], slender_of_row(systems[0]), np.int64(0), LANES
    braced = p.block.brace_angle < math.inf
    idle = LaneWork(-1, p, opened(p, 0.0, 0.0, max_cycles))
    works, parameters = workspace.works.ctypes.data, workspace.parameters.ctypes.data
    for i in range(LANES):
        store_work(works, i, idle)
        store_work(parameters, i, p)
        s.stage[i] = IDLE
        s.request[i] = LOAD_NEXT
    while stop[0] == 0:
        for i in range(LANES):
            if s.request[i] == NO_REQUEST:
                continue
            request = resolve_alone(s, i, load_work(parameters, i, p))
            if request > UPDATE_PEAK:
                work = load_work(works, i, idle)
                work, queue = service_until_ready(s, i, request, work, queue, batch, workspace)
                store_work(works, i, work)
                store_work(parameters, i, work.p)
                busy -= work.point < 0
            update_peak(s, i, load_work(parameters, i, p))
        if busy == 0:
            break
        run_lanes(s, workspace.flights, workspace.log, braced, stop)
    return busy == 0
