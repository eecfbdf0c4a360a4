"""Many systems, one after another or in lanes, without Python in between: what a survey asks of a tile."""

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

# The version of what is answered: raised whenever an answer to the same question may change, so that a store never mixes two.
METHOD = 19


@njit(**ENTRY_POINT)
def classify_batch_scalar(systems, starts, max_cycles, max_period, memory, answers, stop):
    """Whether all points were judged, and ``stop[0]`` not set on the way.

    A row of ``systems`` is what ``make`` takes, a row of ``starts`` (angle, velocity).
    """
    for k in range(systems.shape[0]):
        if stop[0] != 0:
            return False
        p = parameters_from_row(systems[k])
        store_result(answers, k, judge(p, starts[k, 0], starts[k, 1], max_cycles, max_period, memory))
    return True


@cache
def has_simd():
    """Whether this machine adds products four numbers at a time, or more: on others lanes gain nothing."""
    told = numba.config.CPU_FEATURES
    features = (llvm.get_host_cpu_features().flatten() if told is None else told).split(",")
    return {"+avx2", "+fma"} <= set(features)


def lane_masks(systems):
    """(which points may come to be marched in lanes without braces, and which between braces): a point's own matter.

    Where much plain marching is likely: without loss, or in what braces make of it.
    """
    amplitude, _, period, _, restitution, brace_angle, _ = systems.T
    may, braced = (amplitude > 1.0) & (period >= MIN_LANE_PERIOD) & has_simd(), brace_angle < math.inf
    return may & (restitution == 1.0) & ~braced, may & braced


def classify_batch(systems, starts, max_cycles, max_period, stop):
    """``Answers`` for points (n, 7) and (n, 2); None where ``stop`` (1,) was set by another thread on the way."""
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
    """Compile, or load, what ``classify_batch`` runs: a process that ends while another thread compiles may crash.

    Some points may have to be marched for long (``may_last``): only for those the lanes are compiled.
    """
    still = np.array(
        [[0.0, 1.0, math.tau, 0.0, 0.0, math.inf, 1.0], [2.0, math.tau, 1.0, 0.0, 1.0, math.inf, 1.0]]
    )
    classify_batch(still[: 1 + may_last], np.zeros((1 + may_last, 2)), 1, 1, np.zeros(1, np.int64))
