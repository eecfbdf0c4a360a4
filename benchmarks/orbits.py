"""Periodic orbits: a branch, a curve through two parameters, a search."""

import rocking as rk
from benchmarks.clock import quickest
from benchmarks.table import Figure

RUNS = 5


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
