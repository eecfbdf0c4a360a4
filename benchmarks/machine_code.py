"""Machine code of the builders against that compiled in the process that needs it, for each class of processors."""

import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from benchmarks.table import Figure
from rocking.kernels import build_processes, machine_code
from rocking.kernels.deferred import import_all
from rocking.kernels.entry_point import ENTRY_POINTS

import_all()
ALL = sorted(ENTRY_POINTS)
LANES = "scheduler.classify_batch_lanes"


class Compared(NamedTuple):
    """Calls of an entry point with both machine codes: their number, those with other results, ratio of the times."""

    calls: int
    others: int
    ratio: float


def comparable():
    """Return the classes whose instructions this processor has."""
    best = machine_code.processor_class()
    classes = list(machine_code.CLASSES)
    return classes[classes.index(best) :] if best in classes else []


def compare(processors):
    """Compare all entry points for a class of processors, by name."""
    with TemporaryDirectory() as folder:
        build_processes.build_all(ALL, Path(folder), processors)
        command = [sys.executable, "-m", "benchmarks.recorded_calls", folder]
        environment = os.environ | build_processes.builder_environment(processors)
        done = subprocess.run(command, env=environment, check=True, stdout=subprocess.PIPE, text=True)
    rows = map(str.split, done.stdout.splitlines())
    return {name: Compared(int(calls), int(others), float(ratio)) for name, calls, others, ratio in rows}


def speed():
    """Compare the speed of every entry point."""
    for processors in comparable():
        found = compare(processors)
        slowest = max(found, key=lambda name: found[name].ratio)
        ratio, others = found[slowest].ratio, sum(each.others for each in found.values())
        yield Figure(f"{processors}, slowest of {len(found)}", ratio, "×", 1.03, note=slowest)
        yield Figure("  lanes", found[LANES].ratio, "×", 1.03 if processors == comparable()[0] else 1.1)
        yield Figure("  calls with other results", others, "", 0)
