"""Classification of a batch of systems, in SIMD lanes or one by one, in a single call from Python; and their attractors."""

import math
from functools import partial

import numpy as np

from rocking.kernels.classify.cascade import FIRST_SECTION, Workspace, judge, make_workspace
from rocking.kernels.classify.verdict import (
    PERIODIC,
    REST,
    ResultArrays,
    empty_results,
    judgement_of,
    store_result,
)
from rocking.kernels.contract import later, with_row
from rocking.kernels.lanes.scheduler import MIN_LANE_PERIOD, classify_batch_lanes
from rocking.kernels.lanes.state import make_lane_workspace
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats2, Integers1
from rocking.kernels.motion.march import (
    DONE,
    STILL,
    UNKNOWN,
    NoRecording,
    Recording,
    begin,
    march_through,
    no_recording,
)
from rocking.kernels.system import (
    NO_LAW,
    PeriodicParameters,
    kind_of_rows,
    parameters_of_row,
    row_of,
    unequal_sides,
)

# Version of the results. It is raised whenever a result for the same request may change, so that a store
# never mixes two versions.
METHOD = 26


# Phase of the section on which attractors are compared, in cycles. An event of a symmetric mode lies there
# only by chance.
SECTION = FIRST_SECTION
# States of an orbit with angles closer than this are ordered by their velocities.
TIED = 1e-7
# Rest is proved long before its last impact, so the march takes this factor longer.
LONGER = 10


@entry_point
def classify_batch_scalar(
    kind: PeriodicParameters,
    systems: Floats2,
    starts: Floats2,
    max_cycles: int,
    max_period: int,
    memory: Workspace,
    answers: ResultArrays,
    stop: Integers1,
) -> bool:
    """Classify the points of a batch one by one.

    A row of ``systems`` is that of ``parameters_of_row``, and all are of the type of ``kind``. A row of ``starts`` is
    (angle, velocity). Returns True if all points were classified, False if ``stop[0]`` was set before the end.
    """
    for k in range(systems.shape[0]):
        if stop[0] != 0:
            return False
        p = with_row(kind, systems[k])
        store_result(answers, k, judge(p, starts[k, 0], starts[k, 1], max_cycles, max_period, memory))
    return True


def classify_one(p, angle, velocity, max_cycles, max_period):
    """Return the ``Judgement`` on one motion, by the same machine code as for a batch."""
    results, start = empty_results(1), np.array([[angle, velocity]])
    memory, go_on = make_workspace(max_cycles, max_period), np.zeros(1, np.int64)
    classify_batch_scalar(p, np.array([row_of(p)]), start, max_cycles, max_period, memory, results, go_on)
    return judgement_of(results, 0)


def lane_masks(systems):
    """Return masks of the points that profit from the lane path. They depend on each point only.

    Lanes are for slender blocks with equal sides that lift off and for forcing that is not too fast, on every processor, so that
    results are the same.

    Returns
    -------
    tuple of (array of bool, array of bool)
        Points without braces and points with braces.
    """
    amplitude, _, period, _, _, brace_angle, _, critical_angle = systems.T[:8]
    lifts, braced = (amplitude > 1.0) & (period >= MIN_LANE_PERIOD), brace_angle < math.inf
    may = lifts & (critical_angle == 0.0) & ~unequal_sides(systems)
    return may & ~braced, may & braced


def classify_one_by_one(systems, *arguments, law=NO_LAW):
    """Return ``classify_batch_scalar`` for one or more ``systems``."""
    return classify_batch_scalar(parameters_of_row(systems[0], law), systems, *arguments)


def classify_batch(systems, starts, max_cycles, max_period, stop, law=NO_LAW):
    """Classify a batch of n >= 0 points, ``systems`` (n, 8 or 11), all slender or none, and ``starts`` (n, 2).

    The ``law`` (m, 2) of restitution is that of all points.

    Returns ``ResultArrays``, or None if another thread set ``stop`` (1,) before the end.
    """
    answers, (free, braced) = empty_results(len(systems)), lane_masks(systems)
    unequal, slow = unequal_sides(systems), ~(free | braced)
    parts = (
        (slow & ~unequal, partial(classify_one_by_one, law=law), make_workspace),
        (slow & unequal, partial(classify_one_by_one, law=law), make_workspace),
        (free, classify_batch_lanes, make_lane_workspace),
        (braced, classify_batch_lanes, make_lane_workspace),
    )
    for part, judge_part, memory in parts:
        count = int(np.count_nonzero(part))
        if count == 0:
            continue
        room = memory(max_cycles, max_period)
        if count == len(systems):
            done = judge_part(systems, starts, max_cycles, max_period, room, answers, stop)
            return answers if done else None
        some = empty_results(count)
        if not judge_part(systems[part], starts[part], max_cycles, max_period, room, some, stop):
            return None
        for whole, found in zip(answers, some, strict=True):
            whole[part] = found
    return answers


@kernel
def rest_angle(p, angle, velocity, cycles, nothing):
    """Return the angle at which a motion comes to rest: 0, or on a brace."""
    if p.block.brace_angle == math.inf:
        return 0.0
    recording = Recording(0.0, nothing.section, nothing.events, False, False)
    progress = begin(p, angle, velocity, UNKNOWN)[0]
    status, progress = march_through(p, progress, LONGER * max(cycles, 1), recording, nothing.tangent)
    return progress.arc.side * progress.arc.angle if status == STILL else math.nan


@kernel
def foremost(states, first):
    """Return the row of the largest angle; of rows with tied angles, that of the largest velocity."""
    best = first
    for row in range(first + 1, states.shape[0]):
        ahead = states[row, 0] - states[best, 0]
        if ahead > TIED or (ahead > -TIED and states[row, 1] > states[best, 1]):
            best = row
    return best


@entry_point
def anchor_each(
    kind: PeriodicParameters,
    systems: Floats2,
    starts: Floats2,
    results: ResultArrays,
    nothing: NoRecording,
    scratch: Floats2,
    anchors: Floats2,
) -> None:
    """Write the canonical state (angle, velocity) of the attractor of each of n points; NaN if there is none.

    For a periodic orbit it is the foremost state on the section at SECTION, for rest the state of rest.
    ``kind`` gives the type of the parameters, ``scratch`` has two rows per cycle of the longest period.
    """
    for k in range(systems.shape[0]):
        anchors[k, 0], anchors[k, 1] = math.nan, math.nan
        if results.kind[k] != PERIODIC and results.kind[k] != REST:
            continue
        p = with_row(kind, systems[k])
        if results.kind[k] == REST:
            cycles = results.cycles[k]
            anchors[k, 0], anchors[k, 1] = rest_angle(p, starts[k, 0], starts[k, 1], cycles, nothing), 0.0
            continue
        # The second repetition is used, because an orbit with rest is known at a release, whose time is
        # rounded.
        period, time = results.period[k], results.section_time[k]
        states = scratch[: 2 * period]
        at = (SECTION * p.forcing.period - time) % p.forcing.period
        q, recording = later(p, time), Recording(at, states, nothing.events, False, False)
        progress = begin(q, results.angle[k], results.velocity[k], UNKNOWN)[0]
        status, _ = march_through(q, progress, 2 * period, recording, nothing.tangent)
        if status == DONE:
            best = foremost(states, period)
            anchors[k, 0], anchors[k, 1] = states[best, 0], states[best, 1]


def anchors_of(systems, starts, answers, law=NO_LAW):
    """Return ``anchor_each`` for the results of ``batch.classify_batch``: an array (n, 2)."""
    anchors, scratch = np.empty((len(systems), 2)), np.empty((2 * answers.period.max(initial=1), 2))
    if len(systems):
        kind = kind_of_rows(systems, law)
        anchor_each(kind, systems, starts, answers, no_recording(), scratch, anchors)
    return anchors
