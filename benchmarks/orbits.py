"""Periodic orbits: a branch, a curve through two parameters, a search."""

import time

import numpy as np

import rocking as rk
from benchmarks.clock import quickest
from benchmarks.table import Figure

RUNS = 5
# Random verdicts that are proved, and the goals of the medians.
VERDICTS, PROOF_MS, START_MS = 60, 1.0, 6.0


def following():
    """Time a symmetric branch of period 1, its symmetry-breaking curve in two parameters, and a search for all orbits."""
    system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    orbit = rk.find_orbit(system, rk.State(0.1, 0.1), 1)
    seconds, branch = quickest(RUNS, lambda: rk.continue_orbit(orbit, "amplitude", (0.1, 30.0), step=0.004))
    yield Figure(
        "a branch of 1,000 points",
        1000 * seconds / len(branch),
        "s",
        0.5,
        note=f"{len(branch)} points, {len(branch.special)} special",
    )
    breaking = next(point for point in branch.special if point.kind == "symmetry-breaking")
    seconds, curve = quickest(
        RUNS,
        lambda: rk.bifurcation_curve(breaking, "period", "amplitude", ((0.4, 3.0), (0.1, 100.0)), step=0.005),
    )
    yield Figure("a curve of 300 points", 300 * seconds / len(curve), "s", 1.0, note=f"{len(curve)} points")
    system = rk.System(rk.Harmonic(amplitude=5.5, period=0.5), restitution=0.925)
    seconds, orbits = quickest(RUNS, lambda: rk.find_orbits(system, 7))
    yield Figure(
        "all orbits up to period 7", seconds, "s", note=f"{len(orbits)} orbits, {orbits.starts} starts"
    )


def proofs():
    """Time proofs of random periodic responses from rest, of their orbits and of their initial states, and two horseshoes."""
    verdicts = list(periodic(VERDICTS))
    for what, goal, subjects in (
        ("proof of an orbit", PROOF_MS, [verdict.orbit for verdict in verdicts]),
        ("proof of an initial state", START_MS, verdicts),
    ):
        times, proved = [], 0
        for subject in subjects:
            rk.prove(subject)
            begun = time.perf_counter()
            proof = rk.prove(subject)
            times.append(1e3 * (time.perf_counter() - begun))
            proved += proof.proved if proof.starts is None else proof.starts
        note = f"median; {proved} of {len(subjects)} proved; slowest {max(times):.3g} ms"
        yield Figure(what, float(np.median(times)), "ms", goal, note=note)
    for name, system, arguments in (
        ("horseshoe, closed form", rk.System(rk.Harmonic(2.0, period=1.0), 0.925), {}),
        ("horseshoe, two words", rk.System(rk.Harmonic(10.103037, period=1.721328), 0.8), {"search": True}),
    ):
        seconds, found = quickest(RUNS, lambda one=system, how=arguments: rk.horseshoe(one, **how))
        yield Figure(name, 1e3 * seconds, "ms", note="proved" if found.proved else "not proved")


def periodic(count):
    """Yield periodic verdicts from rest of random systems."""
    random = np.random.default_rng(1)
    while count:
        amplitude, period = float(random.uniform(0, 16)), float(random.uniform(0.2, 3))
        restitution = float(random.choice([0.5, 0.8, 0.925]))
        verdict = rk.classify(rk.System(rk.Harmonic(amplitude, period=period), restitution))
        if verdict.kind is rk.Kind.PERIODIC:
            count -= 1
            yield verdict
