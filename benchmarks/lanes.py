"""SIMD lanes compared with one block after another, on undamped maps and on maps with braces."""

import math
from time import thread_time

import numpy as np

from benchmarks import marching
from benchmarks.clock import quickest
from benchmarks.table import Figure
from rocking.kernels import batch
from rocking.kernels.classify.cascade import make_workspace
from rocking.kernels.classify.verdict import empty_results
from rocking.kernels.system import parameters_of_row
from rocking.model.verdict import Kind

POINTS, FINER = 100, 200
PERIODS, AMPLITUDES = (0.2, 3.0), (0.0, 16.0)
CYCLES, BRACED_CYCLES, MAX_PERIOD = 10_000, 1_000, 64
RUNS = 3
STILL_OPEN = (Kind.CHAOTIC.code, Kind.UNDETERMINED.code)


def one_by_one(systems, cycles=CYCLES):
    """Classify the points one by one."""
    answers = empty_results(len(systems))
    starts, go_on = np.zeros((len(systems), 2)), np.zeros(1, np.int64)
    kind, memory = parameters_of_row(systems[0]), make_workspace(cycles, MAX_PERIOD)
    batch.classify_batch_scalar(kind, systems, starts, cycles, MAX_PERIOD, memory, answers, go_on)
    return answers


def in_lanes(systems, cycles=CYCLES):
    """Classify the points as a survey does."""
    return batch.classify_batch(
        systems, np.zeros((len(systems), 2)), cycles, MAX_PERIOD, np.zeros(1, np.int64)
    )


def systems_of(points, restitution=1.0, brace_angle=math.inf):
    """Return the systems of a map with ``points`` along each axis."""
    period, amplitude = (
        axis.ravel() for axis in np.meshgrid(np.linspace(*PERIODS, points), np.linspace(*AMPLITUDES, points))
    )
    one = np.ones(period.size)
    return np.column_stack(
        [amplitude, math.tau / period, period, 0 * one, restitution * one, brace_angle * one, one, 0 * one]
    )


def against_one():
    """Time the map at e = 1, the points of a finer map that reach the last cycle, and the map with braces."""
    systems = systems_of(POINTS)
    together, answers = quickest(RUNS, lambda: in_lanes(systems), thread_time)
    alone, told = quickest(RUNS, lambda: one_by_one(systems), thread_time)
    note = f"{1e6 * alone / len(systems):.3g} µs one by one"
    yield Figure("e = 1, 10⁴ cycles, per point", 1e6 * together / len(systems), "µs", 40, note=note)
    yield Figure(
        "  compared with one by one",
        alone / together,
        "×",
        1,
        least=True,
    )
    share = 100.0 * np.mean(answers.kind != told.kind)
    yield Figure(
        "  other result", share, "%", note="the fraction that a change of the last digit of the phase gives"
    )
    systems = systems_of(FINER)
    longest = systems[np.isin(in_lanes(systems).kind, STILL_OPEN)]
    together, _ = quickest(RUNS, lambda: in_lanes(longest), thread_time)
    alone, _ = quickest(RUNS, lambda: one_by_one(longest), thread_time)
    yield Figure(
        "  points marched to the end: compared with one by one",
        alone / together,
        "×",
        1,
        least=True,
        note=f"{len(longest):,} points, which keep the lanes full; with all checkpoints",
    )
    yield from marching.against_one(longest)
    braced = systems_of(POINTS, 0.925, 1.0)
    together, _ = quickest(RUNS, lambda: in_lanes(braced, BRACED_CYCLES), thread_time)
    alone, _ = quickest(RUNS, lambda: one_by_one(braced, BRACED_CYCLES), thread_time)
    yield Figure(
        "with braces, 10³ cycles: compared with one by one",
        alone / together,
        "×",
        1,
        least=True,
        note=f"{1e6 * together / len(braced):.3g} µs per point",
    )
