"""Whole processes: cost of commands from start to end, the library of kernels, and memory of a long run."""

import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

from benchmarks.table import Figure

SYSTEM = ["--amplitude", "2", "--period", "1", "--restitution", "0.925"]
SIMULATE = ["simulate", *SYSTEM]
MAP = ["map", "--amplitude", "0:16:60", "--period", "0.2:3:60", "--restitution", "0.925"]
LOAD = """
from time import perf_counter
import rocking
system = rocking.System(rocking.Harmonic(2.0, period=1.0), 0.925)
import rocking.motion
begun = perf_counter()
rocking.simulate(system, cycles=1)
print(perf_counter() - begun)
"""


def command(*arguments, folder):
    """Run `rocking ARGUMENTS`; return its wall-clock seconds."""
    program = Path(sys.executable).with_name("rocking")
    begun = perf_counter()
    subprocess.run([program, *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - begun


def commands():
    """Time commands as a user waits for them."""
    with tempfile.TemporaryDirectory() as folder:
        picture, map_ = [*SIMULATE, "--plot", "motion.png"], [*MAP, "--plot", "map.png"]
        for line, goal in ((["--help"], 0.15), (SIMULATE, None), (picture, 1.2), (map_, 2.0)):
            command(*line, folder=folder)
            seconds = median(command(*line, folder=folder) for _ in range(5))
            yield Figure(f"rocking {line[0]}{' with a picture' * ('--plot' in line)}", seconds, "s", goal)


def library():
    """Time the compilation of all kernels, and the first call of one in a new process."""
    with tempfile.TemporaryDirectory() as folder:
        line = [sys.executable, "-P", "-m", "rocking.kernels", "--into", folder]
        begun = perf_counter()
        subprocess.run(line, check=True, stdout=subprocess.DEVNULL)
        yield Figure("compile all kernels", perf_counter() - begun, "s", 90)
        (made,) = Path(folder).glob("*.so")
        yield Figure("size of the library", made.stat().st_size / 1e6, "MB", note=made.name)
    again = [float(python(LOAD)) for _ in range(5)]
    yield Figure("open the library, simulate one cycle", median(again), "s", 0.1)


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


def python(program, *arguments):
    """Run a program in a new interpreter; return its output."""
    line = [sys.executable, "-c", program, *arguments]
    return subprocess.run(line, check=True, text=True, stdout=subprocess.PIPE).stdout
