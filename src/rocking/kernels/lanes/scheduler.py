"""The cascade of ``classify.cascade`` for many systems at once: each alone until plain marching is all that is left, then in a lane.

Legs and looks are the same; a lane only marches. What is said of a block never hangs on its neighbours.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.classify.classifier_state import ClassifierState, next_look, opened
from rocking.kernels.classify.decision_cascade import (
    checkpoint_unstable,
    evaluate_checkpoint,
    march_leg,
    over_batch,
)
from rocking.kernels.classify.quasi_periodicity import section_needed
from rocking.kernels.classify.reset import begin_tangent
from rocking.kernels.classify.results import ResultArrays, parameters_from_row, store_result
from rocking.kernels.classify.verdict_record import OPEN, undecided
from rocking.kernels.classify.workspace import LEG
from rocking.kernels.compile_options import ALLOCATING_ENTRY, INTERNAL, INTERNAL_INLINE
from rocking.kernels.event_kinds import FLIGHT, IMPACT
from rocking.kernels.lanes.load_unload import (
    find_event_scalar,
    flights_by_now,
    growth_since,
    lane_request,
    load_block,
    log_arcs,
    set_difference,
    set_leg,
    unload_block,
    update_peak,
)
from rocking.kernels.lanes.rows import (  # fmt: skip
    AT_EVENT,
    CHECK_ZENO,
    END_LEG,
    EXCEEDS,
    FIND_EVENT,
    IDLE,
    LANES,
    LOAD_NEXT,
    LOG_ON,
    NO_REQUEST,
    REQUEST,
    SLOWEST,
    STAGE,
    TARGET,
    TO_SCALAR,
    UPDATE_PEAK,
    load,
    store,
)
from rocking.kernels.lanes.step import advance, advance_between, strike, strike_between
from rocking.kernels.lanes.workspace import lane_workspace
from rocking.kernels.march.march import DONE
from rocking.kernels.parameters import HarmonicParameters

# Of a quicker forcing an arc has too many stretches to be walked along in step with others.
MIN_LANE_PERIOD = 0.1


class LaneWork(NamedTuple):
    """Who is in a lane: which point, -1 if none."""

    point: int
    p: HarmonicParameters
    case: ClassifierState


class BatchRequest(NamedTuple):
    """What is asked, of whom, and where the answers go."""

    systems: np.ndarray
    starts: np.ndarray
    max_cycles: int
    max_period: int
    answers: ResultArrays


@njit(**INTERNAL)
def lane_eligible(p, case):
    """Whether plain marching is all that is left: between braces from event to event, or without any where nothing is lost."""
    run, watch = case.run, case.run.watch
    progress, arc = watch.progress, watch.progress.arc
    if progress.mode != FLIGHT or not (p.amplitude > 1.0 and p.period >= MIN_LANE_PERIOD):
        return False
    if p.brace_angle < math.inf:
        return not (run.lossless or watch.base.seen or watch.brace.seen)
    plain = p.restitution == 1.0 and arc.angle == 0.0 and arc.velocity >= SLOWEST
    return plain and run.lossless and run.flights.event == IMPACT


@njit(**INTERNAL)
def replace_run(case, run):
    """The case with its motion further on."""
    return ClassifierState(run, *case[1:])


@njit(**INTERNAL_INLINE)
def try_skip_readback(s, i, guest, max_cycles, bench):
    """(whether a lane at the end of its leg was sent on without being read, its block): if its motion has outgrown any torus.

    What differences have grown by is read in any case.
    """
    point, p, case = guest
    target, most = next_look(case, max_cycles), bench.flights.shape[1]
    if not case.run.lossless or load(s, i, LOG_ON) > 0.0 or case.converged or target == max_cycles:
        return False, guest
    grown, bench.columns[i, 0, 0], bench.columns[i, 0, 1] = growth_since(s, i)
    growth = bench.growth[i, 0] + grown
    bench.growth[i, 0] = growth
    further = checkpoint_unstable(case, flights_by_now(s, i, case.run.flights, most), max_cycles, growth)
    ahead = next_look(further, max_cycles)
    if section_needed(growth, ahead, max_cycles, bench.scratch.shape[0]):
        return False, guest
    if further.measured > case.measured:
        exponent = over_batch(p, case.run.watch, target, max_cycles, growth - case.grown)
        bench.batches[i, case.measured] = exponent
    set_leg(s, i, ahead, False)
    return True, LaneWork(point, p, further)


@njit(**INTERNAL_INLINE)
def service_lane(s, i, wants, guest, queue, asking, bench):
    """(who is in a lane, how many were let in) after a leg, or part of one: its block again, or the next that comes to plain marching."""
    point, p, case = guest
    workspace, log = lane_workspace(bench, i), bench.log[i]
    systems, starts, max_cycles, max_period, answers = asking
    told, settled, ended = undecided(case.run.watch), wants == LOAD_NEXT, wants == END_LEG
    marched = ended and load(s, i, TARGET) == next_look(case, max_cycles)
    stays, due = wants < LOAD_NEXT or ended, marched or wants == TO_SCALAR
    status, run = np.int64(DONE), case.run
    if not settled:
        status, run = unload_block(s, i, wants, p, run, max_cycles, workspace, log)
        case = replace_run(case, run)
    while due or settled or not lane_eligible(p, case):
        if settled:
            if point >= 0:
                store_result(answers, point, told)
            if queue == systems.shape[0]:
                store(s, i, STAGE, IDLE)
                return LaneWork(-1, p, case), queue
            point, queue = queue, queue + 1
            p = parameters_from_row(systems[point])
            case, told = opened(p, starts[point, 0], starts[point, 1], max_cycles), undecided(case.run.watch)
            settled = stays = False
            if lane_eligible(p, case):
                begin_tangent(workspace.columns, workspace.growth)
                break
        if not marched:
            stays = False
            status, run = march_leg(p, case.run, max_cycles, next_look(case, max_cycles), workspace)
        told, case = evaluate_checkpoint(p, case, status, run, max_cycles, max_period, workspace)
        due, marched, settled = False, False, told[0] != OPEN
    if stays:
        set_difference(s, i, workspace.columns)
    else:
        load_block(s, i, p, case.run.watch.progress, workspace.columns, case.run.flights.count)
    # no more cycles at a time than the section has room for
    target = min(next_look(case, max_cycles), case.run.watch.progress.cycle + LEG)
    asked_for = not case.run.lossless or section_needed(
        workspace.growth[0], target, max_cycles, workspace.scratch.shape[0]
    )
    set_leg(s, i, target, asked_for)
    return LaneWork(point, p, case), queue


@njit(**INTERNAL)
def run_lanes(s, flights, log, braced, stop):
    """All lanes onward until one of them wants attention."""
    while stop[0] == 0:
        if braced:
            strike_between(s)
        else:
            strike(s)
        log_arcs(s, flights, log, braced)
        if advance_between(s) if braced else advance(s):
            return


@njit(**ALLOCATING_ENTRY)
def classify_batch_lanes(systems, starts, max_cycles, max_period, bench, answers, stop):
    """Whether all points were judged, and ``stop[0]`` not set on the way; arguments as for ``batch.judge_each``."""
    s, p, queue, blocks = bench.state, parameters_from_row(systems[0]), np.int64(0), LANES
    braced = p.brace_angle < math.inf
    asking = BatchRequest(systems, starts, max_cycles, max_period, answers)
    guests = [LaneWork(-1, p, opened(p, 0.0, 0.0, max_cycles))] * LANES
    for i in range(LANES):
        store(s, i, STAGE, IDLE)
        store(s, i, REQUEST, LOAD_NEXT)
    while stop[0] == 0:
        for i in range(LANES):
            wants = load(s, i, REQUEST)
            if wants == NO_REQUEST:
                continue
            if wants == FIND_EVENT:
                wants = find_event_scalar(s, i, guests[i].p)
            elif wants == CHECK_ZENO:
                wants = lane_request(s, i, guests[i].p)
            while wants != NO_REQUEST and wants != UPDATE_PEAK:
                on, guest = (
                    try_skip_readback(s, i, guests[i], max_cycles, bench)
                    if wants == END_LEG
                    else (False, guests[i])
                )
                if not on:
                    guest, queue = service_lane(s, i, wants, guest, queue, asking, bench)
                    blocks -= guest.point < 0
                guests[i] = guest
                wants = lane_request(s, i, guests[i].p)
            if load(s, i, STAGE) == AT_EVENT and load(s, i, EXCEEDS) > 0.0:
                update_peak(s, i, guests[i].p)
        if blocks == 0:
            break
        run_lanes(s, bench.flights, bench.log, braced, stop)
    return blocks == 0
