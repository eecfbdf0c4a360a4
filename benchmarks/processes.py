"""Whole processes: cost of commands from start to end, cost of compilation, and memory of a long run."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

from benchmarks.table import Figure

SYSTEM = ["--amplitude", "2", "--period", "1", "--restitution", "0.925"]
SIMULATE, CLASSIFY = ["simulate", *SYSTEM], ["classify", *SYSTEM]
MAP = ["map", "--amplitude", "0:16:60", "--period", "0.2:3:60", "--restitution", "0.925"]
DIAGRAM = ["orbit-diagram", "--amplitude", "5:9:60", "--period", "1.721", "--restitution", "0.8"]
BASINS = ["basins", *SYSTEM, "--angle", "-1:1:30", "--velocity", "-1:1:30"]
BUILD = "import runpy, sys; sys.argv[1:] = []; runpy.run_module('rocking.kernels', run_name='__main__')"
LOAD = """
from time import perf_counter
import rocking
system = rocking.System(rocking.Harmonic(2.0, period=1.0), 0.925)
import rocking.motion
begun = perf_counter()
rocking.simulate(system, cycles=1)
print(perf_counter() - begun)
"""


def command(*arguments, folder=None, **environment):
    """Run `rocking ARGUMENTS`; return its wall-clock seconds."""
    program = Path(sys.executable).with_name("rocking")
    begun = perf_counter()
    environment = os.environ | environment
    subprocess.run([program, *arguments], cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - begun


def commands():
    """Time commands as a user waits for them, with all kernels compiled."""
    python(BUILD)
    with tempfile.TemporaryDirectory() as folder:
        picture, map_ = [*SIMULATE, "--plot", "motion.png"], [*MAP, "--plot", "map.png"]
        for line, goal in ((["--help"], 0.15), (SIMULATE, None), (picture, 1.2), (map_, 2.0)):
            command(*line, folder=folder)
            seconds = median(command(*line, folder=folder) for _ in range(5))
            yield Figure(
                f"rocking {line[0]}{' with a picture' * ('--plot' in line)}, warm", seconds, "s", goal
            )


def first_answers():
    """Time the first commands of a user one after another, with nothing compiled, while the builders work."""
    with tempfile.TemporaryDirectory() as folder:
        total = 0.0
        for line, goal in ((SIMULATE, 15), (CLASSIFY, None), (MAP, None), (DIAGRAM, None), (BASINS, None)):
            seconds = command(*line, folder=folder, NUMBA_CACHE_DIR=folder)
            total += seconds
            yield Figure(f"rocking {line[0]}, first ever", seconds, "s", goal, note="compiles")
        yield Figure("  all five, one after another", total, "s", 90)
        begun = perf_counter()
        python(BUILD, NUMBA_CACHE_DIR=folder)
        yield Figure("  then until all kernels are compiled", perf_counter() - begun, "s")


def compiling():
    """Time the compilation of all kernels, and the load of those of a simulation in a new process."""
    with tempfile.TemporaryDirectory() as folder:
        begun = perf_counter()
        python(BUILD, NUMBA_CACHE_DIR=folder)
        yield Figure("compile everything", perf_counter() - begun, "s", 90, note="two processes")
        again = [float(python(LOAD, NUMBA_CACHE_DIR=folder)) for _ in range(5)]
        yield Figure("load the kernels of a simulation", median(again), "s", 0.1)


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
