"""Classification over the paper's map: work of the decision cascade, and the points that it leaves undetermined."""

import math
import subprocess
import sys
import time

import numpy as np

from benchmarks.table import Figure
from rocking.kernels import batch
from rocking.kernels.classify import verdict
from rocking.kernels.classify.cascade import make_workspace
from rocking.kernels.classify.verdict import empty_results
from rocking.kernels.system import parameters_of_row

POINTS = 200
PERIODS, AMPLITUDES = (0.2, 3.0), (0.0, 16.0)
RUNS = 3
DIMENSION = """
import pathlib, resource, time
import numpy as np, rocking
points = np.random.default_rng(1991).random((100_000, 2))
begun = time.perf_counter()
rocking.correlation_dimension(points)
seconds = time.perf_counter() - begun
# On Linux getrusage includes the memory of the parent process.
status = pathlib.Path("/proc/self/status")
most = [line.split()[1] for line in status.read_text().splitlines() if line.startswith("VmHWM")] if status.exists() else []
print(seconds, int(most[0] if most else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) / 1024)
"""


def judged(restitution, max_cycles):
    """Classify the map from rest at phase 0; return kinds, criteria, events computed, and the seconds of one core."""
    amplitudes, periods = map(
        np.ravel, np.meshgrid(np.linspace(*AMPLITUDES, POINTS), np.linspace(*PERIODS, POINTS))
    )
    one = np.ones(amplitudes.size)
    systems = np.column_stack(
        [
            amplitudes,
            math.tau / periods,
            periods,
            0.0 * one,
            restitution * one,
            math.inf * one,
            one,
            0.0 * one,
        ]
    )
    memory, best, starts, go_on = (
        make_workspace(max_cycles, 64),
        math.inf,
        np.zeros((one.size, 2)),
        np.zeros(1, np.int64),
    )
    results, kind = empty_results(one.size), parameters_of_row(systems[0])
    for _ in range(RUNS):
        begun = time.thread_time()
        batch.classify_batch_scalar(kind, systems, starts, max_cycles, 64, memory, results, go_on)
        best = min(best, time.thread_time() - begun)
    return results.kind, results.ground, results.work, best


def maps():
    """Time the map of figure 11 (e = .925) and that of figure 10 (e = 1)."""
    kinds, grounds, work, seconds = judged(0.925, 100_000)
    undetermined, resets = kinds == verdict.UNDETERMINED, grounds == verdict.UNRESOLVED_RESET
    yield Figure("e = .925, impacts per point, all work", work.mean(), "", 40)
    yield Figure("  one core", seconds, "s", 0.15, note=f"{POINTS} × {POINTS} points, ≤ 100,000 cycles")
    yield Figure("  undetermined, resets left out", float((undetermined & ~resets).sum()), "points", 0)
    yield Figure("  resets of unresolved period", float(resets.sum()), "points")
    kinds, grounds, work, seconds = judged(1.0, 10_000)
    open_share = 100.0 * np.isin(kinds, (verdict.CHAOTIC, verdict.UNDETERMINED)).mean()
    yield Figure("e = 1, impacts per point, all work", work.mean(), "", 600, note="≤ 10,000 cycles")
    yield Figure("  still chaotic or undetermined", open_share, "%", 3.5)
    yield Figure("  one core", seconds, "s")


def dimension():
    """Time the correlation dimension of 10⁵ points, in a separate process to measure its memory."""
    done = subprocess.run([sys.executable, "-c", DIMENSION], capture_output=True, text=True, check=True)
    seconds, megabytes = map(float, done.stdout.split())
    yield Figure("correlation dimension of 10⁵ points", seconds, "s", 10)
    yield Figure("  memory at most", megabytes, "MiB", 954)
