"""Run cases for `python -m benchmarks.against`: reads one name per line, prints processor seconds line by line.

Two commits of the package run this script, so it uses public names only.
"""

import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np

import rocking as rk

ONE_THREAD = ThreadPoolExecutor(1)
PERIODS, AMPLITUDES = (0.2, 3.0), (0.0, 16.0)
# At e = 1 nearly every motion of this window is chaotic or undetermined, so nearly every block is marched to its last cycle.
LONG_MOTIONS = {"periods": (0.2, 0.7), "amplitudes": (1.1, 1.4)}


def march(cycles, amplitude, period, restitution, **more):
    """Simulate one block from rest and keep nothing."""
    system = rk.System(rk.Harmonic(amplitude, period=period), restitution, **more)
    rk.simulate(system, cycles=cycles, record="none")


def run_record(levels):
    """Run one block under the record of the package at ``levels`` scales."""
    block, record = rk.Block(height=2.0, width=0.5), rk.example_ground_motion()
    rk.incremental_dynamic_analysis(
        [record], block, np.linspace(1.0, 4.0, levels), executor=ONE_THREAD, model="slender"
    )


def compute_map(points, restitution, periods=PERIODS, amplitudes=AMPLITUDES, braces=None, **more):
    """Classify ``points`` × ``points`` systems on one thread."""
    axes = {"amplitude": np.linspace(*amplitudes, points), "period": np.linspace(*periods, points)}
    system = rk.System(rk.Harmonic(2.0, period=1.0), restitution, braces)
    rk.parametric_map(system, **axes, executor=ONE_THREAD, **more)


CASES = {
    "one block (1,1)": partial(march, 1_000_000, 2.0, 1.0, 0.925),
    "one block (1,3)": partial(march, 2_500_000, 6.5, 0.4, 0.925),
    "one block, chaotic": partial(march, 500_000, 10.103037, 1.721328, 0.8),
    "full block": partial(march, 30_000, 2.0, 1.0, 0.925, critical_angle=0.3),
    "record": partial(run_record, 6_000),
    "lanes": partial(compute_map, 10, 1.0, **LONG_MOTIONS),
    "map, e = .925": partial(compute_map, 140, 0.925),
    # Rounding decides when a chaotic motion overturns, and so how many impacts are computed. Between commits that round differently
    # their number changes by half a per cent here, and by three with 42 × 42 points and 10,000 cycles.
    "map, e = 1": partial(compute_map, 100, 1.0, max_cycles=1_000),
    "map, braced": partial(compute_map, 35, 0.925, braces=rk.Braces(1.0), max_cycles=1_000),
}
"""Cases by name; each takes 0.1 to 0.2 seconds."""


def main(source, core):
    """Serve requests on one core until the input ends; the first run of a case loads its kernels and is not timed."""
    if Path(source) not in Path(rk.__file__).parents:
        sys.exit(f"the package must come from {source}; got {rk.__file__}")
    if core != "any":
        os.sched_setaffinity(0, {int(core)})
    ready = set()
    for line in sys.stdin:
        run = CASES[line.strip()]
        if run not in ready:
            run()
            ready.add(run)
        begun = time.process_time()
        run()
        print(time.process_time() - begun, flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
