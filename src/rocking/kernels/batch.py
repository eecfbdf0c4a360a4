"""Classification of a batch of systems, in SIMD lanes or one by one, in a single call from Python."""

import math

import numpy as np

from rocking.kernels.classify.decision_cascade import judge
from rocking.kernels.classify.results import ResultArrays, empty_results, judgement_of, store_result
from rocking.kernels.classify.workspace import Workspace, make_workspace
from rocking.kernels.compile_options import KERNEL
from rocking.kernels.entry_point import entry_point
from rocking.kernels.forcing.parameters import PeriodicParameters, parameters_of_row, row_of
from rocking.kernels.forcing.periodic import with_row
from rocking.kernels.lanes.scheduler import MIN_LANE_PERIOD, classify_batch_lanes
from rocking.kernels.lanes.workspace import make_lane_workspace
from rocking.kernels.library.load import library_class
from rocking.kernels.signature import Floats2, Integers1

# Version of the results. It is raised whenever a result for the same request may change, so that a store
# never mixes two versions.
METHOD = 25


@entry_point(**KERNEL)
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


def has_simd():
    """Return whether the library adds products of four numbers at a time, or more; without this, lanes gain nothing."""
    return library_class() in ("x86-64-v4", "x86-64-v3")


def lane_masks(systems):
    """Return masks of the points that profit from the lane path. They depend on each point only.

    Lanes are for slender blocks that lift off and for forcing that is not too fast.

    Returns
    -------
    tuple of (array of bool, array of bool)
        Points without braces and points with braces.
    """
    amplitude, _, period, _, _, brace_angle, _, critical_angle = systems.T
    lifts, braced = (amplitude > 1.0) & (period >= MIN_LANE_PERIOD), brace_angle < math.inf
    may = lifts & (critical_angle == 0.0) & has_simd()
    return may & ~braced, may & braced


def classify_one_by_one(systems, *arguments):
    """Return ``classify_batch_scalar`` for one or more ``systems``."""
    return classify_batch_scalar(parameters_of_row(systems[0]), systems, *arguments)


def classify_batch(systems, starts, max_cycles, max_period, stop):
    """Classify a batch of n >= 0 points, ``systems`` (n, 8), all slender or none, and ``starts`` (n, 2).

    Returns ``ResultArrays``, or None if another thread set ``stop`` (1,) before the end.
    """
    answers, (free, braced) = empty_results(len(systems)), lane_masks(systems)
    parts = (
        (~(free | braced), classify_one_by_one, make_workspace),
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
