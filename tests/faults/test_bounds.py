"""No compiled function writes or reads beyond an array. Without a check that would damage other data."""

import os
import subprocess
import sys

import pytest

JUDGED = """
import math
import numba
import numpy as np
from rocking.kernels import batch
from rocking.kernels.library.kernel import OPTIONS, import_all
from rocking.kernels.system import Cosine, Slender, parameters_of_row

# Kernels in the library have no checks. So these two entry points are compiled here, with checks.
import_all()
for entry in (batch.classify_batch_scalar[Slender[Cosine]], batch.classify_batch_lanes):
    setattr(batch, entry.function.__name__, numba.njit(**OPTIONS)(entry.function))

from rocking.kernels.classify.verdict import empty_results
from rocking.kernels.classify.cascade import make_workspace

# undamped chaos and tori; dissipative cycle, chaos, resets and overturning; braces
cases = [(2.0, 0.4, 1.0), (4.0, 0.4, 1.0), (1.75, 0.9, 1.0), (2.0, 1.0, 0.925), (10.103037, 1.721328, 0.8), (1.1, 0.7, 0.5),
         (1.75, 2.0, 0.95), (15.0, 2.0, 0.925)]
systems = np.array([(a, math.tau / t, t, 0.0, e, 1.0 if a == 15.0 else math.inf, 1.0, 0.0) for a, t, e in cases])
starts = np.zeros((len(systems), 2))
for max_cycles, max_period in ((1, 1), (129, 1), (200, 64), (639, 64), (1_000, 300), (20_000, 2), (100_000, 1), (150_000, 64)):
    answers, stop = empty_results(len(systems)), np.zeros(1, np.int64)
    memory = make_workspace(max_cycles, max_period)
    batch.classify_batch_scalar(parameters_of_row(systems[0]), systems, starts, max_cycles, max_period, memory, answers, stop)
    batch.classify_batch(systems, starts, max_cycles, max_period, stop)
print(*answers.kind)

# undamped, short periods: long sojourns near tori, often fewer impacts than cycles
amplitude, period = (axis.ravel() for axis in np.meshgrid(np.linspace(1.01, 7.0, 24), np.linspace(0.1, 0.6, 24)))
one = np.ones(period.size)
systems = np.column_stack([amplitude, math.tau / period, period, 0.0 * one, one, math.inf * one, one, 0.0 * one])
batch.classify_batch(systems, np.tile((0.0, 0.3), (len(systems), 1)), 20_000, 1, np.zeros(1, np.int64))

# between braces, weak dissipation: long legs with few events
systems[:, 4], systems[:, 5], systems[:, 6] = 0.9999, 3.0, 0.9999
for max_cycles, max_period in ((6_000, 1), (10_000, 64)):
    batch.classify_batch(systems[::3], np.tile((0.0, 0.3), (len(systems[::3]), 1)), max_cycles, max_period, np.zeros(1, np.int64))
"""


@pytest.mark.long
def test_cascade_stays_within_its_arrays():
    checked = os.environ | {"NUMBA_BOUNDSCHECK": "1"}
    done = subprocess.run(
        [sys.executable, "-c", JUDGED], check=False, capture_output=True, text=True, env=checked
    )
    assert done.returncode == 0, done.stderr[-2000:]
    assert len(set(done.stdout.split())) >= 4
