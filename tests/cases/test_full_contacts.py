"""The full block between braces, and with a coefficient of restitution over the speed, against many digits."""

import math

import mpmath as mp
import numpy as np
import pytest

import rocking as rk
from oracles.full_block import DIGITS, Block, Cosine, Samples
from rocking.motion.march_loop import monodromy


def base_of(random, level, records):
    """Return a base motion, and the same in many digits."""
    if records:
        values = np.round(level * np.repeat(random.uniform(-4.0, 4.0, 10), 3), 6)
        values[[0, -1]] = 0.0
        return rk.PiecewiseLinear(values, step=0.1), Samples(values, 0.1)
    amplitude, period, phase = (
        float(np.round(random.uniform(*limits), 6))
        for limits in ((2 * level, 5 * level), (1.0, 3.0), (-3.0, 3.0))
    )
    forcing = rk.Harmonic(amplitude=amplitude, period=period, phase=phase)
    return forcing, Cosine(amplitude, 2 * mp.pi / mp.mpf(forcing.frequency), phase)


def case(seed, with_braces, with_table):
    """Return a system and its oracle, at any slenderness."""
    random = np.random.default_rng(seed)
    alpha = float(np.round(random.uniform(0.05, 1.2), 6))
    forcing, exact = base_of(random, math.tan(alpha) / alpha, records=seed % 2 == 0)
    e, r = (float(value) for value in np.round(random.uniform(0.3, 0.7, 2), 6))
    table = [(0.3, e - 0.1), (1.0, e + 0.1), (2.0, e - 0.2)] if with_table else []
    brace = float(np.round(random.uniform(0.05, 0.4), 6)) if with_braces else math.inf
    braces = rk.Braces(brace, r) if with_braces else None
    system = rk.System(forcing, e, braces, critical_angle=alpha, restitution_table=table)
    return system, Block(exact, [(0.0, e), *table], alpha, brace, r)


def check(system, exact, end=3.0):
    """Compare the states at a time, to 1e-13 times the growth of an error in a block that stands upright."""
    if isinstance(system.forcing, rk.Harmonic):
        cycles = max(1, round(end / system.forcing.period))
        end, motion = cycles * system.forcing.period, rk.simulate(system, cycles=cycles)
    else:
        motion = rk.simulate(system, duration=end)
    if motion.outcome == "overturned":
        end = motion.overturning.time
    with mp.workdps(DIGITS):
        angle, velocity, impacts, hits = exact.followed(end)
    found = motion.at(min(end, motion.duration))
    allowed = 1e-13 * math.exp(2.0 * end)
    assert abs(found[0] - float(angle)) < allowed
    assert abs(found[1] - float(velocity)) < allowed
    return motion, impacts, hits


@pytest.mark.parametrize(
    "seed", [0, 2, 9, *(pytest.param(k, marks=pytest.mark.long) for k in (1, 3, 5, 6, 7, 8))]
)
def test_states_between_braces_are_those_of_collocation(seed):
    motion, _, hits = check(*case(seed, with_braces=True, with_table=False))
    assert hits > 0
    assert motion.brace_hits > 0


@pytest.mark.parametrize(
    "seed", [20, 24, *(pytest.param(k, marks=pytest.mark.long) for k in (21, 22, 23, 25))]
)
def test_states_with_restitution_over_the_speed_are_those_of_collocation(seed):
    check(*case(seed, with_braces=False, with_table=True))


@pytest.mark.long
def test_block_that_leans_on_its_brace_leaves_when_the_base_pulls_it_off():
    """Chattering at a brace beyond balance ends in contact; from a tilt of 0.8 rad the base must exceed g tan."""
    alpha, brace = 0.5, 1.4
    system = rk.System(
        rk.Harmonic(0.8, period=12.0, phase=math.pi), 0.6, rk.Braces(brace, 0.4), critical_angle=alpha
    )
    motion = rk.simulate(system, rk.State(1.3, 0.0), cycles=1)
    events = motion.events
    assert {"lean", "leave"} <= set(events["kind"])
    leave = events[events["kind"] == "leave"][0]
    pull = np.sign(leave["angle"]) * 0.8 * math.cos(system.forcing.frequency * leave["time"] + math.pi)
    assert pull == pytest.approx(math.tan(alpha * (brace - 1.0)) / alpha, rel=1e-12)
    with mp.workdps(DIGITS):
        exact = Block(
            Cosine(0.8, 2 * mp.pi / mp.mpf(system.forcing.frequency), math.pi), 0.6, alpha, brace, 0.4
        )
        angle, velocity, _, _ = exact.followed(motion.duration, 1.3, 0.0)
    assert motion.final.angle == pytest.approx(float(angle), abs=1e-9)
    assert motion.final.velocity == pytest.approx(float(velocity), abs=1e-9)


@pytest.mark.parametrize("seed", [1, 3, 23, 27])
def test_tangent_vectors_pass_braces_and_tables(seed):
    system, _ = case(seed, with_braces=seed < 20, with_table=seed > 20)
    start, found = rk.State(0.1, 0.05), monodromy(system, rk.State(0.1, 0.05), 2)
    columns = []
    for step in ((1e-6, 0.0), (0.0, 1e-6)):
        there, back = (
            rk.simulate(
                system, rk.State(start.angle + sign * step[0], start.velocity + sign * step[1]), cycles=2
            ).final
            for sign in (1, -1)
        )
        columns.append(((there.angle - back.angle) / 2e-6, (there.velocity - back.velocity) / 2e-6))
    np.testing.assert_allclose(found, np.array(columns).T, rtol=0, atol=1e-7 * max(np.abs(found).max(), 1.0))


def test_table_of_one_coefficient_is_that_number():
    forcing = rk.Harmonic(2.0, period=1.0)
    number = rk.simulate(rk.System(forcing, 0.8, critical_angle=0.3), cycles=30)
    table = rk.simulate(
        rk.System(forcing, 0.8, critical_angle=0.3, restitution_table=[(1.0, 0.8)]), cycles=30
    )
    np.testing.assert_array_equal(number.events["after"], table.events["after"])


def test_verdicts_and_exponents_take_the_table():
    system = rk.System(
        rk.Harmonic(2.0, period=1.0), 0.9, critical_angle=0.25, restitution_table=[(0.2, 0.85), (1, 0.7)]
    )
    verdict = rk.classify(system)
    assert verdict.kind == "periodic"
    orbit = rk.find_orbit(system, verdict.orbit.start, verdict.period)
    assert orbit.multipliers[0] == pytest.approx(verdict.multipliers[0], abs=1e-9)
    assert math.isnan(rk.lyapunov(system, cycles=300).sum_rule_error)
    free = rk.System(rk.Harmonic(0.0, period=1.0), 0.9, critical_angle=0.25, restitution_table=[(0.2, 0.5)])
    assert rk.simulate(free, rk.State(0.5), cycles=30).outcome == "at-rest"


def test_braces_bound_the_full_block_in_maps():
    starts = np.linspace(-0.7, 0.7, 4)
    system = rk.System(rk.Harmonic(4.0, period=1.5), 0.8, rk.Braces(0.8, 0.7), critical_angle=0.3)
    found = rk.basin_map(system, angle=starts, velocity=starts, boundary_runs=0)
    assert "overturned" not in [each.name for each in found.attractors]
    one = rk.parametric_map(
        rk.System(rk.Harmonic(1.0, period=1.5), restitution=0.8, braces=rk.Braces(0.8)),
        amplitude=[2.0, 4.0],
        critical_angle=[0.2, 0.3],
    ).dataset
    verdict = rk.classify(rk.System(rk.Harmonic(4.0, period=1.5), 0.8, rk.Braces(0.8), critical_angle=0.3))
    assert [str(kind) for kind in rk.Kind][int(one.kind[1, 1])] == str(verdict.kind)


FORCING = rk.Harmonic(2.0, period=1.0)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (
            lambda: rk.System(FORCING, 0.9, restitution_table=[(1, 0.8)]),
            "restitution_table must be omitted for a slender",
        ),
        (
            lambda: rk.System(FORCING, 0.9, critical_angle=0.2, restitution_table=[(1, 1.2)]),
            "a coefficient of restitution_table must lie in [0, 1]",
        ),
        (
            lambda: rk.System(FORCING, 0.9, critical_angle=0.2, restitution_table=[(1, 0.9), (0.5, 0.8)]),
            "ascending",
        ),
        (lambda: rk.System(FORCING, 0.9, critical_angle=0.2, restitution_table=[0.8]), "rows"),
        (
            lambda: rk.System(FORCING, 0.9, rk.Braces(8.0), critical_angle=0.2),
            "brace_angle must be below 7.85398",
        ),
    ],
)
def test_bad_braces_and_tables_are_refused_in_one_line(call, says):
    with pytest.raises((TypeError, ValueError)) as refused:
        call()
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)
