"""Whole processes: cost of commands from start to end, cost of compilation, and memory of a long run."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

from benchmarks.table import Figure

SIMULATE = ["simulate", "--amplitude", "2", "--period", "1", "--restitution", "0.925"]


def command(*arguments, folder=None, **environment):
    """Run `rocking ARGUMENTS`; return its wall-clock seconds."""
    program = Path(sys.executable).with_name("rocking")
    begun = perf_counter()
    environment = os.environ | environment
    subprocess.run([program, *arguments], cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - begun


def commands():
    """Time commands as a user waits for them."""
    with tempfile.TemporaryDirectory() as folder:
        help_ = median(command("--help") for _ in range(9))
        first = command(*SIMULATE, folder=folder, NUMBA_CACHE_DIR=folder)
        picture = [*SIMULATE, "--plot", "motion.png"]
        command(*picture, folder=folder)
        warm = median(command(*picture, folder=folder) for _ in range(5))
    yield Figure("rocking --help", help_, "s", 0.15)
    yield Figure("rocking simulate --plot, warm", warm, "s", 1.5)
    yield Figure("rocking simulate, first ever", first, "s", 15, note="compiles")


COMPILE = """
from time import perf_counter
begun = perf_counter()
from benchmarks.one_block import march
from benchmarks.cases import CASES
import rocking.motion
loaded = perf_counter()
march(CASES[0], 1)
print(perf_counter() - loaded)
"""


def compiling():
    """Time all kernels of a march with tangent: compiled, and loaded from the cache, without imports."""
    with tempfile.TemporaryDirectory() as folder:
        first, *again = (float(python(COMPILE, NUMBA_CACHE_DIR=folder)) for _ in range(4))
    yield Figure("compile, first ever", first, "s", 10)
    yield Figure("from cache", median(again), "s", 0.4)


LONG_RUN = """
import resource, sys, time
from rocking import Harmonic, System, simulate
system = System(Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
simulate(system, cycles=10, record="none")
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
begun = time.perf_counter()
simulate(system, cycles=int(sys.argv[1]), record="none")
print(time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""


def long_run(cycles=10**7):
    """Measure the growth of peak memory over 10⁷ cycles of one block, compared with 10 cycles."""
    seconds, kilobytes = map(float, python(LONG_RUN, str(cycles)).split())
    note = f"in {seconds:.2f} s"
    yield Figure(f"{cycles:,} cycles, growth of peak memory", kilobytes / 1024, "MiB", 1.0, note=note)


def python(program, *arguments, **environment):
    """Run a program in a new interpreter; return its output."""
    line, environment = [sys.executable, "-c", program, *arguments], os.environ | environment
    return subprocess.run(line, env=environment, check=True, text=True, stdout=subprocess.PIPE).stdout
