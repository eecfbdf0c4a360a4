"""The full block against references of many digits, which take neither its equation nor its method from the package."""

import json
import math
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

import rocking as rk
from oracles.full_block import DIGITS, Block, Cosine, Samples

CASES = json.loads((Path(__file__).resolve().parents[1] / "data" / "full_states.json").read_text())
MOVING = [case for case in CASES if case["fate"] == "rocking" and case["name"] != "free"]


def simulate(case):
    alpha = float(case["alpha"])
    if case["kind"] == "harmonic":
        forcing = rk.Harmonic(amplitude=float(case["A"]), period=float(case["T"]), phase=float(case["phi"]))
        system = rk.System(forcing, float(case["e"]), critical_angle=alpha)
        return rk.simulate(system, cycles=case["cycles"])
    base = rk.PiecewiseLinear(np.array(case["a"], float) / alpha, step=float(case["dtau"]))
    system = rk.System(base, float(case["e"]), critical_angle=alpha)
    return rk.simulate(system, duration=float(case["tau"]))


@pytest.mark.parametrize("case", MOVING, ids=lambda case: case["name"])
def test_reference_states(case):
    motion = simulate(case)
    alpha = float(case["alpha"])
    assert motion.impacts == case["impacts"]
    assert abs(motion.final.angle * alpha - float(case["theta"])) < 1e-14
    assert abs(motion.final.velocity * alpha - float(case["dtheta"])) < 1e-14


def random_case(seed):
    """Return a system, its oracle and an initial state; a block that moves, at any slenderness."""
    random = np.random.default_rng(seed)
    alpha = float(np.round(np.exp(random.uniform(np.log(0.02), np.log(1.2))), 6))
    restitution = float(np.round(random.uniform(0.3, 0.7), 6))
    level = math.tan(alpha) / alpha
    if seed % 2:
        amplitude = float(np.round(level * random.uniform(0.7, 2.0), 6))
        period, phase = (float(np.round(random.uniform(*limits), 6)) for limits in ((0.4, 2.5), (-3.0, 3.0)))
        forcing = rk.Harmonic(amplitude=amplitude, period=period, phase=phase)
        exact = Cosine(amplitude, 2 * mp.pi / mp.mpf(forcing.frequency), phase)
    else:
        values = np.round(level * random.uniform(-2.0, 2.0, 30), 6)
        step = float(np.round(random.uniform(0.05, 0.15), 6))
        values[[0, -1]] = 0.0
        forcing, exact = rk.PiecewiseLinear(values, step=step), Samples(values, step)
    start = rk.State() if seed % 3 == 0 else rk.State(*np.round(random.uniform(-0.3, 0.3, 2), 6))
    return rk.System(forcing, restitution, critical_angle=alpha), Block(exact, restitution, alpha), start


def check(seed, end=3.0):
    """Compare the states at a time, to 1e-13 times the growth of an error in a block that stands upright."""
    system, exact, start = random_case(seed)
    with mp.workdps(DIGITS):
        if isinstance(system.forcing, rk.Harmonic):
            cycles = max(1, round(end / system.forcing.period))
            end, motion = cycles * system.forcing.period, rk.simulate(system, start, cycles=cycles)
        else:
            motion = rk.simulate(system, start, duration=end)
        if motion.outcome == "overturned":
            end = motion.overturning.time
        angle, velocity, impacts = exact.final(end, start.angle, start.velocity)
    found = motion.at(min(end, motion.duration))
    allowed = 1e-13 * math.exp(1.5 * end)
    assert abs(found[0] - float(angle)) < allowed
    assert abs(found[1] - float(velocity)) < allowed
    return motion.impacts, impacts


@pytest.mark.parametrize(
    "seed", [pytest.param(k, marks=pytest.mark.long) if k not in (1, 7, 9) else k for k in range(12)]
)
def test_states_of_random_blocks_are_those_of_collocation(seed):
    check(seed)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(12, 60))
def test_states_of_many_random_blocks_are_those_of_collocation(seed):
    check(seed)


def test_slender_limit_is_reached_at_second_order():
    forcing = rk.Harmonic(amplitude=2.0, period=1.0)
    limit = rk.simulate(rk.System(forcing, 0.9), cycles=3).final
    errors = []
    for angle in (0.08, 0.04, 0.02):
        final = rk.simulate(rk.System(forcing, 0.9, critical_angle=angle), cycles=3).final
        errors.append(abs(final.angle - limit.angle))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx(2.0, abs=0.05)


def test_free_block_falls_beyond_the_balance_point_and_rocks_before_it():
    forcing = rk.Harmonic(amplitude=0.0, period=1.0)
    system = rk.System(forcing, 0.5, critical_angle=0.3)
    assert rk.simulate(system, rk.State(angle=0.99), cycles=40).outcome == "at-rest"
    assert rk.simulate(system, rk.State(angle=1.01), cycles=40).outcome == "overturned"
    # at the balance point the kinetic energy decides: u'^2/2 against (1 - cos(alpha (1 - u)))/alpha^2
    barrier = math.sqrt(2.0 * (1.0 - math.cos(0.3 * 0.5))) / 0.3
    for factor, outcome in ((1.0 - 1e-9, "at-rest"), (1.0 + 1e-9, "overturned")):
        start = rk.State(angle=0.5, velocity=factor * barrier)
        assert rk.simulate(system, start, cycles=40).outcome == outcome


def test_energy_is_kept_between_impacts_without_base_motion():
    system = rk.System(rk.Harmonic(amplitude=0.0, period=2.0), 1.0, critical_angle=0.8)
    motion = rk.simulate(system, rk.State(angle=0.6), cycles=20)
    angle, velocity = motion.at(np.linspace(0.0, 40.0, 401))
    energy = 0.5 * velocity**2 + np.cos(0.8 * (1.0 - np.abs(angle))) / 0.8**2
    assert np.ptp(energy) < 1e-13
    assert motion.impacts > 10


def test_lift_off_is_above_the_tangent_of_the_critical_angle():
    for alpha in (0.05, 0.5, 1.1):
        level = math.tan(alpha) / alpha
        for factor, moves in ((1.0 - 1e-9, False), (1.0 + 1e-9, True)):
            forcing = rk.Harmonic(amplitude=factor * level, period=1.0, phase=1.0)
            motion = rk.simulate(rk.System(forcing, 0.5, critical_angle=alpha), cycles=3)
            assert (len(motion.events) > 0) == moves


def test_a_block_that_overturns_for_certain_lies_flat_before_it_comes_back():
    random, fallen = np.random.default_rng(0), 0
    for _ in range(60):
        alpha = float(random.uniform(0.05, 1.1))
        size, period, phase = (
            float(random.uniform(*limits)) for limits in ((1.0, 4.0), (1.0, 4.0), (-3.0, 3.0))
        )
        forcing = rk.Harmonic(amplitude=size * math.tan(alpha) / alpha, period=period, phase=phase)
        motion = rk.simulate(rk.System(forcing, 0.8, critical_angle=alpha), cycles=30)
        if motion.outcome != "overturned":
            continue
        angle = alpha * motion.at(np.linspace(0.0, 12.0, 2_000) + motion.overturning.time)[0]
        flat = np.flatnonzero(np.abs(angle) >= math.pi / 2 - 1e-9)
        assert flat.size
        assert (np.sign(angle[: flat[0]]) == np.sign(angle[0])).all()
        fallen += 1
    assert fallen > 20


def test_what_the_full_equation_does_not_include_is_refused():
    harmonic = rk.Harmonic(amplitude=2.0, period=1.0)
    for angle in (0.0, -0.1, 1.3, math.nan):
        with pytest.raises(ValueError, match="critical_angle"):
            rk.System(harmonic, 0.9, critical_angle=angle)
    with pytest.raises(ValueError, match="model must be"):
        rk.Block(height=2.0, width=1.0).system(acceleration=6.0, frequency_hz=1.2, model="half")
