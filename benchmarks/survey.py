"""Maps of a million points: cost with one and two workers, in memory and in a store, and compared with plain marching."""

import itertools
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from statistics import median

import numpy as np

import rocking as rk
from benchmarks.clock import quickest_in_turn
from benchmarks.lanes import MAX_PERIOD, systems_of
from benchmarks.table import Figure
from rocking.kernels import batch
from rocking.kernels.classify import cascade
from rocking.kernels.classify.cascade import make_workspace
from rocking.kernels.classify.verdict import empty_results, store_result
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion import march
from rocking.kernels.motion.march import Recording
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.system import parameters_of_row, slender_of_row
from rocking.model.verdict import Criterion

POINTS = 1000
PERIODS, AMPLITUDES = (0.2, 3.0), (0.0, 16.0)
MARCHED = 1000
"""Cycles of a map that marches every point to the end before the first checkpoint, or has no checkpoint."""
TURNS = 7
PAIRS = 15
"""Alternating runs of one and two workers: the speed of a core changes by a tenth from run to run."""
PEAK = """
import pathlib, resource, sys
import numpy as np, rocking
count, store = int(sys.argv[1]), sys.argv[2]
rocking.parametric_map(
    rocking.System(rocking.Harmonic(2.0, period=1.0), 0.925),
    amplitude=np.linspace(0, 16, count), period=np.linspace(0.2, 3, count), store=store, max_cycles=20
)
# On Linux getrusage includes the memory of the parent process.
status = pathlib.Path("/proc/self/status")
most = [line.split()[1] for line in status.read_text().splitlines() if line.startswith("VmHWM")] if status.exists() else []
print(int(most[0] if most else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) / 1024)
"""


def arguments(points, restitution=0.925, braces=None):
    """Return the arguments of a map of ``points`` × ``points`` points."""
    return {
        "system": rk.System(rk.Harmonic(2.0, period=1.0), restitution, braces),
        "amplitude": np.linspace(*AMPLITUDES, points),
        "period": np.linspace(*PERIODS, points),
    }


def taken(**named):
    """Compute a map; return (seconds, processor seconds of all threads, map)."""
    begun, worked = time.perf_counter(), time.process_time()
    found = rk.parametric_map(**named).dataset
    return time.perf_counter() - begun, time.process_time() - worked, found


def in_turn(*maps_of, turns=TURNS):
    """Time maps alternately, so that load on the machine affects all; return (seconds, processor seconds) of each."""
    runs = [[taken(**of())[:2] for of in maps_of] for _ in range(turns)]
    return [np.transpose(of_one) for of_one in zip(*runs, strict=True)]


def by_one_worker(points):
    """Return the seconds of a map on a single thread; runs in a separate process."""
    with ThreadPoolExecutor(1) as alone:
        return taken(**arguments(points), executor=alone)[0]


def side_by_side():
    """Compare two cores with one on this machine: the speed of two processes with one map each, over that of one."""
    with ProcessPoolExecutor(2, get_context("spawn")) as apart:
        for _ in range(2):
            list(apart.map(by_one_worker, [20, 20]))
        for _ in range(PAIRS):
            (alone,) = apart.map(by_one_worker, [POINTS])
            yield sum(alone / beside for beside in apart.map(by_one_worker, [POINTS, POINTS]))


def maps():
    """Time maps of a million points, and the growth of the cost."""
    rk.parametric_map(**arguments(20))
    (walls, works), (_, quarters) = in_turn(lambda: arguments(POINTS), lambda: arguments(POINTS // 2))
    note = f"the quickest of {TURNS}; {min(works):.3g} s of processors"
    yield Figure("10⁶ points, e = .925, ≤ 10,000 cycles", min(walls), "s", 1, note=note)
    _, _, found = taken(**arguments(POINTS))
    unresolved = found.evidence.values == Criterion.UNRESOLVED_RESET
    undetermined = (found.kind.values == rk.Kind.UNDETERMINED.code) & ~unresolved
    yield Figure("  undetermined, resets left out", float(undetermined.sum()), "points", 0)
    yield Figure("  resets of unresolved period", 100.0 * unresolved.mean(), "%", 0.02)
    grown = median(works) / median(quarters) / 4.0
    yield Figure("  cost per point, compared with a quarter of the points", grown, "×", 1.1)
    early, late, marched = kernels()
    yield Figure(
        "  kernels: 1,000 cycles at every point before the first checkpoint, relative",
        late / early,
        "times",
        10,
        least=True,
        note=f"{marched / early:.3g} times without classification",
    )
    rk.parametric_map(**arguments(20, 1.0), max_cycles=200)
    wall, work, found = taken(**arguments(POINTS, 1.0))
    yield Figure("10⁶ points, e = 1, ≤ 10,000 cycles", wall, "s", 8, note=f"{work:.3g} s of processors")
    open_share = 100.0 * np.isin(found.kind.values, (rk.Kind.CHAOTIC.code, rk.Kind.UNDETERMINED.code)).mean()
    yield Figure("  still chaotic or undetermined", open_share, "%", 3.5)
    braced = arguments(POINTS, braces=rk.Braces(1.0)) | {"max_cycles": 1000}
    wall, work, _ = taken(**braced)
    yield Figure("10⁶ points with braces, ≤ 1,000 cycles", wall, "s", 15, note=f"{work:.3g} s of processors")


def engines():
    """Compare workers and stores on the map of figure 11."""
    rk.parametric_map(**arguments(20))
    with ThreadPoolExecutor(1) as alone, ThreadPoolExecutor(2) as both:
        (one, _), (two, work) = in_turn(
            lambda: arguments(POINTS) | {"executor": alone},
            lambda: arguments(POINTS) | {"executor": both},
            turns=PAIRS,
        )
    note = f"median of {PAIRS} pairs; {median(work / two):.3g} cores at work"
    yield Figure("one worker, compared with two", median(one / two), "×", 1.9, least=True, note=note)
    yield Figure("  one process, compared with two with one map each", median(side_by_side()), "×")
    with tempfile.TemporaryDirectory() as folder:
        rk.parametric_map(**arguments(20), store=f"{folder}/warm.zarr")
        stores = (Path(folder, f"{turn}.zarr") for turn in itertools.count())
        (_, plain), (_, stored) = in_turn(
            lambda: arguments(POINTS), lambda: arguments(POINTS) | {"store": next(stores)}
        )
        share = 100.0 * (median(stored) / median(plain) - 1.0)
        yield Figure("storing, fraction of the processor time", share, "%", 10)
        size = sum(path.stat().st_size for path in Path(folder, "0.zarr").rglob("*"))
        yield Figure("  on disk", size / 1e6, "MB")
        for count in (1000, 4000):
            done = subprocess.run(
                [sys.executable, "-c", PEAK, str(count), f"{folder}/peak-{count}.zarr"],
                capture_output=True,
                text=True,
                check=True,
            )
            yield Figure(
                f"memory at most, {count:,} × {count:,} points stored", float(done.stdout), "MiB", 954
            )


at_the_end = replacing(cascade.ClassifierState, "checkpoint", "batches")


@kernel
def judge_late(systems, cycles, memory, answers):
    """Classify by the decision cascade without early checkpoints: the first comes after ``cycles``."""
    for k in range(systems.shape[0]):
        p = slender_of_row(systems[k])
        case = cascade.opened(p, 0.0, 0.0, cycles)
        case = at_the_end(case, np.int64(cycles), cascade.Batches(cycles + 1, 0, 0.0))
        status, run = cascade.march_leg(p, case.run, cycles, cycles, memory)
        told, _ = cascade.evaluate_checkpoint(p, case, status, run, cycles, MAX_PERIOD, memory)
        store_result(answers, k, told)


@kernel
def march_all(systems, cycles, memory, answers):
    """March every point from rest to its last cycle, unless it overturns or stays at rest before."""
    nothing = memory.nothing
    for k in range(systems.shape[0]):
        p = slender_of_row(systems[k])
        progress = march.begin(p, 0.0, 0.0, march.UNKNOWN)[0]
        recording = Recording(0.0, nothing.section, nothing.events, False, False)
        _, progress = march.march_through(p, progress, cycles, recording, nothing.tangent)
        answers.impacts[k] = progress.impacts


def kernels():
    """Time every tenth point along each axis on one thread: by the cascade, without early checkpoints, by plain marching."""
    systems, memory = systems_of(POINTS // 10, 0.925), make_workspace(10_000, MAX_PERIOD)
    starts, go_on, answers = np.zeros((len(systems), 2)), np.zeros(1, np.int64), empty_results(len(systems))
    kind = parameters_of_row(systems[0])

    def early():
        batch.classify_batch_scalar(kind, systems, starts, 10_000, MAX_PERIOD, memory, answers, go_on)

    def late():
        judge_late(systems, MARCHED, memory, answers)

    def marched():
        march_all(systems, MARCHED, memory, answers)

    for each in (judge_late, march_all):
        each(systems[:1], 1, memory, answers)
    return [seconds for seconds, _ in quickest_in_turn(TURNS, [early, late, marched], time.thread_time)]
