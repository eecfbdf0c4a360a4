"""Calls of every entry point, recorded from a workload, and repeated with another library of kernels.

`python -m benchmarks.recorded_calls LIBRARY`: compare a library, such as that of another class of processors or of other
options of the compiler, with that of the package. For each entry point it prints a line: its name, the number of calls, of
those with other results, and the ratio of the times.
"""

import copy
import ctypes
import sys
from pathlib import Path
from time import perf_counter

import numpy as np
from attrs import evolve

import rocking as rk
from rocking.kernels.library import export
from rocking.kernels.library.kernel import import_all
from rocking.kernels.library.load import open_library
from rocking.kernels.motion.finite_motion import ENDING_ROW, PULSE_ROW, RUN_ROW, run_batch, run_pulses
from rocking.motion.march_loop import parameters

MAX_CALLS = 40
"""Calls kept of each entry point."""
SECONDS = 0.3
"""Time of the repetitions of a call, with either library."""
MIN_ROUNDS = 10


def workload():
    """Run something that calls every entry point."""
    system = rk.System(rk.Harmonic(15.0, period=1.0), 0.9)
    motion = rk.simulate(system, cycles=2_000)
    motion.at(np.linspace(0.0, 50.0, 2_000))
    motion.validity(rk.Block(height=2.0, width=0.5))
    axes = {"amplitude": np.linspace(0.0, 16.0, 24), "period": np.linspace(0.2, 3.0, 24)}
    for restitution in (0.925, 1.0):
        rk.parametric_map(evolve(system, restitution=restitution), **axes, max_cycles=2_000)
    starts = np.linspace(-1.0, 1.0, 12)
    rk.basin_map(system, angle=starts, velocity=starts, max_cycles=1_000)
    rk.lyapunov(rk.System(rk.Harmonic(10.103037, period=1.721328), 0.8), cycles=2_000)
    branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    branch.section(0.7)
    rk.bifurcation_curve(branch.special[0], "period", "amplitude", ((1, 2), (1, 30)))
    rk.find_orbits(system, 1)
    rk.orbit_diagram(system, amplitude=np.linspace(10.0, 15.0, 40))
    rk.theory.symmetric_modes(6.5, 0.4, 0.925, 3)
    rk.saddle_manifolds(rk.System(rk.Harmonic(1.2, period=2.0), 0.9))
    rk.orbit_manifolds(rk.find_orbits(rk.System(rk.Harmonic(6.0, period=2.0), 0.925), 1)[2], length=0.1)
    rk.rotation_number(rk.System(rk.Harmonic(4.0, period=0.4), 1.0))
    rk.tangency_amplitude(rk.System(rk.Harmonic(1.0, period=1.0), 0.8))
    rk.theory.manifold_gap(np.linspace(0.0, 6.0, 50), 1.5, 1.0, 0.8)
    samples = np.random.default_rng(1).uniform(-3.0, 3.0, 400)
    bases = rk.PiecewiseLinear(samples, step=0.05), rk.Pulse("one-sine", amplitude=1.5, duration=2.0)
    full, left = {"critical_angle": 0.3}, {"left": rk.LeftSide(1.3, 0.98, 0.85)}
    restrained = full | {"stiffness_ratio": 0.3, "prestress_ratio": 0.2}
    kinds = {}, full, left, restrained
    moving = [rk.simulate(rk.System(base, 0.8, **kind)) for base in bases for kind in kinds]
    lifted = rk.PiecewiseLinear(0.1 * samples, step=0.05)
    moving.append(rk.simulate(rk.System(bases[0], 0.8, **full, vertical=lifted)))
    others = [rk.System(rk.Harmonic(3.0, period=1.0), 0.8, **kind) for kind in (full, left)]
    for moved in (*moving, *(rk.simulate(other, cycles=200) for other in others)):
        moved.at(np.linspace(0.0, moved.duration, 2_000))
        len(moved.peaks)
    for other in others:
        orbit = rk.classify(other).orbit
        rk.find_orbit(other, orbit.start, orbit.period)
        rk.lyapunov(other, cycles=500)
        rk.orbit_diagram(other, amplitude=np.linspace(2.0, 4.0, 20))
        rk.parametric_map(other, amplitude=axes["amplitude"], period=[1.0, 2.0])
        rk.basin_map(other, angle=starts, velocity=starts, max_cycles=500)
    full, left = others
    rk.orbit_diagram(full, critical_angle=np.linspace(0.1, 0.4, 20))
    rk.parametric_map(full, amplitude=axes["amplitude"], critical_angle=[0.1, 0.3])
    rows, never, runs = np.empty(50, ENDING_ROW), np.zeros(1, np.int64), np.zeros(50, RUN_ROW)
    runs["scale"], runs["restitution"], runs["critical_angle"] = np.linspace(0.5, 2.0, 50), 0.8, 0.3
    pulses = np.zeros(50, PULSE_ROW)
    pulses["amplitude"], pulses["restitution"] = np.linspace(1.0, 9.0, 50), 0.9
    pulses["frequency"], pulses["phase"], pulses["duration"] = 5.0, -np.pi / 2, 0.4 * np.pi
    pulses["critical_angle"] = 0.3
    for kind in kinds:
        sampled, pulse = (parameters(rk.System(base, 0.8, **kind)) for base in bases)
        run_batch(sampled, runs, True, rows, never)
        run_pulses(pulse, pulses, True, rows, never)


def record_calls():
    """Return calls of every entry point, by name."""
    import_all()
    calls = {name: [] for name in export.ENTRY_POINTS}
    original = export.EntryPoint.__call__

    def record(self, *arguments):
        if len(calls[self.name]) < MAX_CALLS:
            calls[self.name].append(copy.deepcopy(arguments))
        return original(self, *arguments)

    export.EntryPoint.__call__ = record
    try:
        workload()
    finally:
        export.EntryPoint.__call__ = original
    return calls


def runner(function):
    """Return a function that runs a compiled function on a block of words."""
    function.argtypes, function.restype = (ctypes.c_int64,), None
    return lambda block: function(ctypes.addressof(ctypes.c_char.from_buffer(block)))


def outcome(entry, run, arguments):
    """Return the bytes of the result of a call and of all its arrays afterwards."""
    arguments = copy.deepcopy(arguments)
    block = entry.signature.pack(arguments)
    run(block)
    return [bytes(block[8 * entry.signature.offset :]), *map(np.ndarray.tobytes, arrays_in(arguments))]


def arrays_in(value):
    """Yield the arrays among nested tuples."""
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from arrays_in(part)


def ratio_of_times(entry, runs, arguments):
    """Return the time of a call with the first library, relative to the second: the quickest of many, in turn."""
    arguments = copy.deepcopy(arguments)  # held, because the block has only their addresses
    block, best = entry.signature.pack(arguments), [np.inf, np.inf]
    original, ends, rounds = bytes(block), perf_counter() + 2.0 * SECONDS, 0
    while perf_counter() < ends or rounds < MIN_ROUNDS:
        rounds += 1
        for k in (0, 1, 1, 0):
            block[:] = original
            begun = perf_counter()
            runs[k](block)
            best[k] = min(best[k], perf_counter() - begun)
    return best[0] / best[1]


def main(path):
    """Print a line for each entry point."""
    other = open_library(Path(path))
    for name, calls in record_calls().items():
        entry = export.ENTRY_POINTS[name]
        runs = runner(getattr(other, entry.symbol)), runner(entry.load())
        others = sum(outcome(entry, runs[0], each) != outcome(entry, runs[1], each) for each in calls)
        print(name, len(calls), others, ratio_of_times(entry, runs, calls[-1]), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
