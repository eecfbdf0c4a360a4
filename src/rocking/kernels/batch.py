"""Classification of a batch of systems, in SIMD lanes or one by one, in a single call from Python."""

import math
from functools import cache

import llvmlite.binding as llvm
import numba
import numpy as np
from numba import njit

from rocking.kernels.classify.decision_cascade import judge
from rocking.kernels.classify.results import empty_results, store_result
from rocking.kernels.classify.workspace import make_workspace
from rocking.kernels.compile_options import ENTRY_POINT
from rocking.kernels.lanes.scheduler import MIN_LANE_PERIOD, classify_batch_lanes
from rocking.kernels.lanes.workspace import make_lane_workspace
from rocking.kernels.parameters import parameters_from_row

# Version of the results. It is raised whenever a result for the same request may change, so that a store
# never mixes two versions.
METHOD = 19


@njit(**ENTRY_POINT)
def classify_batch_scalar(systems, starts, max_cycles, max_period, memory, answers, stop):
    """Classify the points of a batch one by one.

    A row of ``systems`` holds the arguments of ``make``, a row of ``starts`` is (angle, velocity). Returns
    True if all points were classified, False if ``stop[0]`` was set before the end.
    """
    for k in range(systems.shape[0]):
        if stop[0] != 0:
            return False
        p = parameters_from_row(systems[k])
        store_result(answers, k, judge(p, starts[k, 0], starts[k, 1], max_cycles, max_period, memory))
    return True


@cache
def has_simd():
    """Return whether this processor fuses multiplication and addition of four or more numbers at a time.

    On other processors lanes are not faster.
    """
    told = numba.config.CPU_FEATURES
    features = (llvm.get_host_cpu_features().flatten() if told is None else told).split(",")
    return {"+avx2", "+fma"} <= set(features)


def lane_masks(systems):
    """Return masks of the points that profit from the lane path. They depend on each point only.

    Only undamped motions and motions between braces often need long marches.

    Returns
    -------
    tuple of (array of bool, array of bool)
        Points without braces and points with braces.
    """
    amplitude, _, period, _, restitution, brace_angle, _ = systems.T
    may, braced = (amplitude > 1.0) & (period >= MIN_LANE_PERIOD) & has_simd(), brace_angle < math.inf
    return may & (restitution == 1.0) & ~braced, may & braced


def classify_batch(systems, starts, max_cycles, max_period, stop):
    """Classify a batch of points, ``systems`` (n, 7) and ``starts`` (n, 2).

    Returns ``ResultArrays``, or None if another thread set ``stop`` (1,) before the end.
    """
    answers, (lossless, braced) = empty_results(len(systems)), lane_masks(systems)
    parts = (
        (~(lossless | braced), classify_batch_scalar, make_workspace),
        (lossless, classify_batch_lanes, make_lane_workspace),
        (braced, classify_batch_lanes, make_lane_workspace),
    )
    for part, judge_part, memory in parts:
        if not part.any():
            continue
        some, room = empty_results(int(part.sum())), memory(max_cycles, max_period)
        if not judge_part(systems[part], starts[part], max_cycles, max_period, room, some, stop):
            return None
        for whole, found in zip(answers, some, strict=True):
            whole[part] = found
    return answers


def compile_many(may_last):
    """Compile or load the kernels of ``classify_batch``.

    A process that ends while another thread compiles may crash. The lanes are compiled only if some points
    may need a long march (``may_last``).
    """
    still = np.array(
        [[0.0, 1.0, math.tau, 0.0, 0.0, math.inf, 1.0], [2.0, math.tau, 1.0, 0.0, 1.0, math.inf, 1.0]]
    )
    classify_batch(still[: 1 + may_last], np.zeros((1 + may_last, 2)), 1, 1, np.zeros(1, np.int64))
