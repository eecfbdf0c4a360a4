"""Melnikov's functions against numerical integration, and the exact manifolds against the engine."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import rocking as rk

RANDOM = np.random.default_rng(1991)
CASES = [
    (float(t), float(a), float(p), float(e))
    for t, a, p, e in zip(
        RANDOM.uniform(-5, 5, 12),
        RANDOM.uniform(0, 16, 12),
        10 ** RANDOM.uniform(-0.7, 1.0, 12),
        [0.0, 1.0, 0.3, *RANDOM.uniform(0, 1, 9)],
        strict=True,
    )
]


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("orbit", ["upper", "lower"])
def test_closed_form_is_the_integral_along_the_orbit(case, orbit):
    closed = rk.theory.melnikov_function(*case, orbit)
    errors = [abs(rk.theory.melnikov_integral(*case, orbit, width) - closed) for width in (1e-3, 1e-6)]
    loss = rk.theory.impact_loss(1.0, case[3])
    # the orbit loses up to 2/3 of the width in squared speed, the forcing's integral is good to 1e-7
    for error, width in zip(errors, (1e-3, 1e-6), strict=True):
        assert error <= width * loss + 1e-7


@pytest.mark.parametrize("case", CASES)
def test_function_of_the_lower_orbit_is_that_of_the_upper_half_a_period_later(case):
    time, amplitude, period, e = case
    lower = rk.theory.melnikov_function(time, amplitude, period, e, "lower")
    later = rk.theory.melnikov_function(time + period / 2, amplitude, period, e)
    assert lower == pytest.approx(later, abs=1e-13 * (1 + amplitude))


@pytest.mark.parametrize("velocity", [1.0, -1.0, 0.37])
@pytest.mark.parametrize("e", [0.0, 0.8, 1.0])
def test_damping_takes_over_its_width_what_the_impact_takes(velocity, e):
    """∫ F dΘ at one velocity, along its way: −½(1 − e²)Θ'², on either orbit a loss."""
    way = math.copysign(1.0, velocity)
    parts = (
        quad(lambda x: way * rk.theory.damping(x, velocity, e, 1e-3), *ends)[0]
        for ends in ((-1e-3, 0.0), (0.0, 1e-3))
    )
    assert sum(parts) == pytest.approx(-0.5 * (1 - e * e) * velocity**2, abs=1e-12)
    assert rk.theory.impact_loss(velocity, e) == pytest.approx(0.5 * (1 - e * e) * velocity**2, abs=1e-15)


@pytest.mark.parametrize("orbit", ["upper", "lower"])
def test_heteroclinic_orbits_have_the_critical_energy_and_are_motions_of_the_free_block(orbit):
    times = np.linspace(-8, 8, 1001)
    angle, velocity = rk.theory.heteroclinic_orbit(times, orbit)
    np.testing.assert_allclose(rk.theory.energy(angle, velocity), 0.5, rtol=0, atol=4e-16)
    free = rk.System(rk.Harmonic(0.0, period=1.0), 1.0)
    first, last = (rk.theory.heteroclinic_orbit(t, orbit) for t in (-3.0, 3.0))
    end = rk.simulate(free, rk.State(*first), cycles=6, record="none").final
    assert (end.angle, end.velocity) == pytest.approx(last, abs=1e-13)


@pytest.mark.parametrize("period", [0.3, 1.0, 4.0])
@pytest.mark.parametrize("e", [0.3, 0.925])
def test_zeros_appear_at_the_thresholds(period, e):
    phases = np.linspace(0, 2 * np.pi, 20_001)
    for threshold, function, times in (
        (rk.theory.melnikov_amplitude(period, e), rk.theory.melnikov_function, phases * period / (2 * np.pi)),
        (rk.theory.heteroclinic_amplitude(period, e), rk.theory.manifold_gap, phases),
    ):
        assert function(times, threshold * (1 - 1e-6), period, e).max() < 0
        assert function(times, threshold * (1 + 1e-6), period, e).max() > 0


def test_thresholds_have_the_known_values():
    assert rk.theory.heteroclinic_amplitude(1, 0.8) == pytest.approx(3.687813070284, abs=6e-13)
    # .09 (1 + 4π²)
    assert rk.theory.melnikov_amplitude(1, 0.8) == pytest.approx(3.643057584392, abs=6e-13)
    assert rk.theory.heteroclinic_amplitude(2, 0.925) == pytest.approx(0.420353980151, abs=6e-13)
    assert rk.theory.melnikov_amplitude(2, 0.925) == pytest.approx(0.392324783852, abs=6e-13)


def test_melnikov_is_the_first_order_of_the_exact_gap():
    """Halving A and 1 − e together leaves a quarter of the difference."""
    phases = np.linspace(0, 2 * np.pi, 101)

    def apart(small):
        first = rk.theory.melnikov_function(phases / (2 * np.pi), small, 1.0, 1 - small)
        return np.abs(rk.theory.manifold_gap(phases, small, 1.0, 1 - small) - first).max()

    assert apart(1e-3) / apart(5e-4) == pytest.approx(4.0, rel=1e-3)


@pytest.mark.parametrize(("amplitude", "period"), [(2.0, 1.0), (0.5, 2.0), (0.8, 6.0)])
@pytest.mark.parametrize("phase", [0.0, 1.3, 4.0])
def test_saddle_orbit_is_a_motion_until_rounding_takes_it_away(amplitude, period, phase):
    system = rk.System(rk.Harmonic(amplitude, period=period, phase=phase), 0.9)
    for orbit in ("upper", "lower"):
        motion = rk.simulate(
            system, rk.State(*rk.theory.saddle_orbit(phase, amplitude, period, orbit)), cycles=6
        )
        times = np.linspace(0, 3.0, 50)
        angle, velocity = motion.at(times)
        expected = rk.theory.saddle_orbit(phase + times * system.forcing.frequency, amplitude, period, orbit)
        np.testing.assert_allclose([angle, velocity], expected, rtol=0, atol=1e-14 * math.exp(3.0))


@pytest.mark.parametrize(("amplitude", "period"), [(2.0, 1.0), (0.5, 2.0), (6.0, 0.5)])
@pytest.mark.parametrize("phase", [0.0, 1.3, 4.0])
def test_unstable_manifold_arrives_with_its_closed_form(amplitude, period, phase):
    """Off the saddle orbit along (1, 1), which is the unstable direction, exactly."""
    angle, velocity = rk.theory.saddle_orbit(phase, amplitude, period, "lower")
    system = rk.System(rk.Harmonic(amplitude, period=period, phase=phase), 0.9)
    for off in (1e-2, 0.3):
        start = rk.State(angle + off, velocity + off)
        impact = rk.simulate(system, start, cycles=int(10 / period) + 1).events[0]
        exact = rk.theory.unstable_manifold_velocity(impact["phase"], amplitude, period)
        assert impact["kind"] == "impact"
        assert impact["before"] == pytest.approx(exact, abs=1e-12)


@pytest.mark.parametrize(("amplitude", "period"), [(2.0, 1.0), (0.5, 2.0), (6.0, 0.5)])
@pytest.mark.parametrize("phase", [0.0, 1.3, 4.0])
def test_stable_manifold_parts_what_overturns_from_what_comes_back(amplitude, period, phase):
    system = rk.System(rk.Harmonic(amplitude, period=period, phase=phase), 0.9)
    edge = rk.theory.stable_manifold_velocity(phase, amplitude, period)
    slower, faster = (
        rk.simulate(system, rk.State(velocity=edge * (1 + by)), cycles=int(40 / period))
        for by in (-1e-9, 1e-9)
    )
    assert faster.outcome is rk.Outcome.OVERTURNED
    assert faster.impacts == 0
    assert slower.impacts > 0


def test_energy_below_the_critical_one_holds_a_block_only_before_its_critical_angle():
    assert rk.theory.energy(1.5, 0.0) < 0.5
    free = rk.System(rk.Harmonic(0.0, period=1.0), 0.9)
    assert rk.simulate(free, rk.State(angle=1.5)).outcome is rk.Outcome.OVERTURNED
    assert rk.simulate(free, rk.State(angle=0.5)).outcome is rk.Outcome.AT_REST


BLOCK = rk.Block(2.0, 0.5)


def test_physical_orbit_is_equation_16_in_the_papers_symbols():
    """The orbit is (θcr − e^−p, α e^−p), p = αt − ln θcr, and (e^p − θcr, α e^p), p = αt + ln θcr."""
    alpha, critical = BLOCK.frequency_parameter, BLOCK.critical_angle
    for t in (-0.9, -0.1, 0.0, 0.3, 1.2):
        if t >= 0:
            p = alpha * t - math.log(critical)
            expected = critical - math.exp(-p), alpha * math.exp(-p)
        else:
            p = alpha * t + math.log(critical)
            expected = math.exp(p) - critical, alpha * math.exp(p)
        assert rk.theory.physical_heteroclinic_orbit(BLOCK, t) == pytest.approx(expected, abs=1e-15)
        mirrored = rk.theory.physical_heteroclinic_orbit(BLOCK, t, "lower")
        assert mirrored == pytest.approx((-expected[0], -expected[1]), abs=1e-15)


def test_physical_energy_force_and_acceleration_are_equations_12_to_15_in_the_papers_symbols():
    square, critical = BLOCK.frequency_parameter**2, BLOCK.critical_angle
    for theta, v, ground in ((0.1, 0.2, 0.0), (-0.2, 0.3, 2.5), (0.02, -0.4, -1.0)):
        side = math.copysign(1.0, theta)
        h = v * v / 2 - square / 2 * theta * theta + side * square * theta * critical
        assert rk.theory.physical_energy(BLOCK, theta, v) == pytest.approx(h, abs=1e-15)
        acceleration = -side * square * (critical - side * theta) - square * ground / 9.80665
        assert rk.theory.physical_acceleration(BLOCK, theta, ground) == pytest.approx(
            acceleration, rel=1e-13, abs=0
        )
        # δ(θ/θcr)/θcr of a triangle of half width w in θ/θcr
        width, e = 0.5, BLOCK.restitution
        delta = max(0.0, 1 - abs(theta / critical) / width) / width / critical
        force = -0.5 * v * abs(v) * (1 - e * e) * delta
        assert rk.theory.physical_damping(BLOCK, theta, v, width) == pytest.approx(
            force, rel=1e-13, abs=1e-16
        )
    assert rk.theory.physical_critical_energy(BLOCK) == pytest.approx(
        square * critical**2 / 2, rel=1e-14, abs=0
    )
