"""A small result of each kind, made once."""

from functools import cache

import numpy as np

import rocking as rk

BLOCK = rk.Block(2.0, 0.5)
SYSTEM = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
OF_BLOCK = BLOCK.system(acceleration=4.0, frequency_hz=1.2)
RESTING = rk.System(rk.Harmonic(amplitude=1.1, period=2.0), restitution=0.5)
BRANCHING = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
RECORDS = rk.synthetic_ground_motions(3, seed=1)
LEVELS = [3.0, 4.0, 6.0]


@cache
def branch():
    return rk.continue_orbit(rk.classify(BRANCHING).orbit, "amplitude", (10, 30), step=0.05)


def cascade():
    system = rk.System(rk.Harmonic(amplitude=10.46, period=1.721328), restitution=0.8)
    doubling = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10.3, 10.9)).special[0]
    return rk.cascade(doubling, (10.3, 10.9), doublings=4)


def transition():
    system = rk.System(rk.Harmonic(4.0, period=1.0), 0.8, rk.Braces(0.3, 0.7))
    followed = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (0.5, 15.0))
    return rk.grazing_transition(followed.special[-1])


def orbit_manifolds():
    saddle = next(each for each in rk.find_orbits(SYSTEM, 3) if each.impacts and each.stability == "unstable")
    return rk.orbit_manifolds(saddle, length=0.5)


MADE = {
    "motion": lambda: rk.simulate(SYSTEM, cycles=20),
    "motion of a block": lambda: rk.simulate(OF_BLOCK, cycles=20),
    "motion under a record": lambda: rk.simulate(BLOCK.system(RECORDS[0], model="slender")),
    "section": lambda: rk.simulate(SYSTEM, cycles=20, record="section"),
    "verdict": lambda: rk.classify(SYSTEM),
    "verdict of a block": lambda: rk.classify(OF_BLOCK, prove=True),
    "verdict of a resting block": lambda: rk.classify(RESTING),
    "orbit": lambda: rk.classify(SYSTEM).orbit,
    "proof": lambda: rk.prove(rk.classify(SYSTEM).orbit),
    "horseshoe": lambda: rk.horseshoe(rk.System(rk.Harmonic(amplitude=3.7, period=1.0), restitution=0.8)),
    "exponents": lambda: rk.lyapunov(SYSTEM, cycles=200),
    "exponents of a block": lambda: rk.lyapunov(OF_BLOCK, cycles=200),
    "exponents of a resting block": lambda: rk.lyapunov(RESTING, cycles=100),
    "spectrum": lambda: rk.spectral_density(rk.simulate(OF_BLOCK, cycles=300), transient=100),
    "dimension": lambda: rk.correlation_dimension(np.random.default_rng(1).random((3_000, 2))),
    "fit of the restitution": lambda: rk.fit_restitution(
        [0.0, 0.90, 1.68, 2.36, 2.97, 3.52, 4.02], frequency_parameter=2.7
    ),
    "slip": lambda: rk.slide(RECORDS[0].scaled(pga=6.0), friction=0.2),
    "rotation number": lambda: rk.rotation_number(
        rk.System(rk.Harmonic(amplitude=4.0, period=0.4), restitution=1.0)
    ),
    "branch": branch,
    "branch of a block": lambda: rk.continue_orbit(
        rk.classify(OF_BLOCK).orbit, "amplitude", (1.4, 1.7), step=0.1
    ),
    "curve": lambda: rk.bifurcation_curve(
        branch().special[0], "period", "amplitude", ((1, 1.2), (1, 30)), step=0.1
    ),
    "bifurcation set": lambda: rk.bifurcation_set(
        rk.System(rk.Harmonic(amplitude=4.0, period=2.0), restitution=0.9),
        1,
        grid=2,
        period=(1.5, 2.0),
        amplitude=(3.0, 12.0),
    ),
    "cascade": cascade,
    "transition": transition,
    "orbits": lambda: rk.find_orbits(SYSTEM, 1),
    "orbits of a resting block": lambda: rk.find_orbits(RESTING, 1),
    "orbit diagram": lambda: rk.orbit_diagram(
        OF_BLOCK, amplitude=[1.0, 2.0, 9.0], sweep="rest", cycles=4, transient=4
    ),
    "response diagram": lambda: rk.response_diagram(OF_BLOCK, amplitude=[0.5, 1.5]),
    "frequency response": lambda: rk.frequency_response(
        rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925), period=[0.5, 1.0], modes=(1,)
    ),
    "manifolds": lambda: rk.saddle_manifolds(
        rk.System(rk.Harmonic(amplitude=4.0, period=1.0), restitution=0.8), cycles=1
    ),
    "orbit manifolds": orbit_manifolds,
    "basins": lambda: rk.basin_map(OF_BLOCK, angle=[0.0, 0.1], velocity=[0.0, 0.1], boundary_runs=0),
    "random basins": lambda: rk.basin_map(SYSTEM, angle=(0, 1), velocity=(0, 1), samples=20),
    "safe basin": lambda: rk.safe_basin(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925), amplitude=[0.2, 0.5], samples=10
    ),
    "overturning": lambda: rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925),
        period=[1.5, 2.0],
        amplitude=[1.0, 4.0],
        phases=2,
    ),
    "overturning of one system": lambda: rk.overturning_amplitude(
        rk.System(rk.Harmonic(1.0, period=2.0), restitution=0.925), amplitude=[1.0, 4.0], phases=2
    ),
    "chaos": lambda: rk.chaos_share(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=1.0),
        restitution=[0.8, 0.9],
        period=(0.5, 1.0),
        amplitude=(0.1, 0.9),
        samples=5,
    ),
    "map": lambda: rk.parametric_map(SYSTEM, amplitude=[2.0, 3.0], period=[0.5, 1.0]),
    "map of a block": lambda: rk.parametric_map(OF_BLOCK, amplitude=[0.5, 1.5], angle=[0.0, 0.5]),
    "overturning spectrum": lambda: rk.overturning_spectrum(
        rk.System(rk.Pulse("one-sine", amplitude=2.0, duration=1.0), restitution=0.9),
        amplitude=[1.0, 8.0],
        frequency=[1.0, 5.0],
    ),
    "rocking spectrum": lambda: rk.rocking_spectrum(
        RECORDS, BLOCK, size=[0.5, 1.0], slenderness=[0.1, 0.2], model="slender"
    ),
    "repeatability": lambda: rk.repeatability(OF_BLOCK, samples=10),
    "map of repeatability": lambda: rk.repeatability_map(
        rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.9),
        amplitude=[0.2, 0.5],
        period=[1.0, 2.0],
        samples=5,
    ),
    "proved share": lambda: rk.proved_share(
        rk.parametric_map(
            rk.System(rk.Harmonic(1.0, period=1.0), restitution=0.925),
            amplitude=[2.0, 3.0],
            period=[0.5, 1.0],
        )
    ),
    "incremental dynamic analysis": lambda: rk.incremental_dynamic_analysis(
        RECORDS,
        BLOCK,
        LEVELS,
        intensity="pga",
        model="slender",
    ),
    "overturning set": lambda: rk.overturning_set(RECORDS, BLOCK, LEVELS, intensity="pga", model="slender"),
    "comparison of intensities": lambda: rk.compare_intensities(
        rk.overturning_set(rk.synthetic_ground_motions(6, seed=1), BLOCK, [3.0, 5.0, 8.0], intensity="pga"),
        ["pga", "pgv"],
    ),
    "fragility": lambda: rk.fragility(RECORDS, BLOCK, LEVELS, intensity="pga", limits=[0.5], model="slender"),
    "assessment": lambda: rk.assess(
        RECORDS, BLOCK, LEVELS, intensity="pga", model="slender", level=LEVELS[0]
    ),
    "overturning rate": lambda: rk.overturning_rate(
        rk.fragility(
            rk.synthetic_ground_motions(8, seed=1), BLOCK, [3.0, 4.0, 5.0, 6.0], limits=(), model="slender"
        ),
        ([1.0, 3.0, 10.0], [0.02, 2e-3, 1e-4]),
        replicates=100,
    ),
    "sensitivity": lambda: rk.sensitivity(RECORDS, BLOCK, LEVELS, intensity="pga", model="slender"),
}


@cache
def made(name):
    return MADE[name]()
