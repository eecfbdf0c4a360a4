"""Free rocking (A = 0): Housner (1963), closed forms in the release angle alone."""

import math

import numpy as np
import pytest

import rocking as rk

RELEASES = [1e-6, 0.01, 0.3, 0.75, 0.99, 0.999999]


def _released(angle, restitution, cycles=200, record="all"):
    system = rk.System(rk.Harmonic(amplitude=0.0, period=1.0), restitution)
    return rk.simulate(system, rk.State(angle=angle), cycles=cycles, record=record)


def _impacts(motion):
    return motion.events[motion.events["kind"] == "impact"]


def _speeds(angle, restitution, count):
    """Speed before each impact: v² = 1 − (1 − Θ₀)², then v_{k+1} = e v_k."""
    return math.sqrt(angle * (2 - angle)) * restitution ** np.arange(count)


def _quarter(speed):
    """Time between rest and the base at this speed: arccosh(1/(1 − Θ)) with v² = 1 − (1 − Θ)², which is artanh v."""
    return np.arctanh(speed)


@pytest.mark.parametrize("angle", RELEASES)
@pytest.mark.parametrize("side", [1, -1])
def test_quarter_period_is_arccosh_of_1_over_1_minus_angle(angle, side):
    first = _impacts(_released(side * angle, 0.9))[0]
    exact = math.log1p(
        angle / (1 - angle) + math.sqrt(angle * (2 - angle)) / (1 - angle)
    )  # arccosh without cancellation
    # half an ulp of 1 − Θ₀ moves the time by this much, however it is computed
    allowed = 1e-12 * exact + 2.0**-53 / (1 - angle)
    assert abs(first["time"] - exact) <= allowed
    assert math.isclose(abs(first["before"]), math.sqrt(angle * (2 - angle)), rel_tol=1e-12)


@pytest.mark.parametrize("restitution", [0.5, 0.9, 0.99])
@pytest.mark.parametrize("angle", [0.3, 0.99])
def test_speeds_fall_by_the_restitution_and_half_periods_follow(angle, restitution):
    impacts = _impacts(_released(angle, restitution))
    count = min(len(impacts), 60)
    speeds = _speeds(angle, restitution, count)
    assert count >= 20
    np.testing.assert_allclose(np.abs(impacts["before"][:count]), speeds, rtol=1e-12)
    flights = _quarter(speeds)
    times = np.cumsum(np.concatenate([flights[:1], 2 * flights[1:]]))
    np.testing.assert_allclose(impacts["time"][:count], times, rtol=1e-12)
    assert np.array_equal(np.sign(impacts["before"][:count]), -np.sign(angle) * (-1.0) ** np.arange(count))


@pytest.mark.parametrize("restitution", [0.3, 0.8, 0.925])
def test_housner_relation_between_successive_peaks(restitution):
    """1 − (1 − Θ_{k+1})² = e² (1 − (1 − Θ_k)²)."""
    motion = _released(0.6, restitution)
    heights = np.abs(motion.peaks["angle"])
    heights = heights[heights > 1e-9][:40]
    energy = heights * (2 - heights)
    assert len(heights) >= 5
    np.testing.assert_allclose(energy[1:], restitution**2 * energy[:-1], rtol=1e-12)


@pytest.mark.parametrize("restitution", [0.2, 0.6, 0.9])
@pytest.mark.parametrize("angle", [0.05, 0.9])
def test_total_time_to_rest_is_finite(angle, restitution):
    """The impacts accumulate (Zeno): the series of half periods converges, and the block is at rest at its sum."""
    motion = _released(angle, restitution)
    rests = motion.events[motion.events["kind"] == "rest"]
    speeds = _speeds(angle, restitution, 4000)
    flights = _quarter(speeds[speeds > 0])
    total = 2 * math.fsum(flights) - flights[0]
    assert len(rests) == 1
    assert math.isclose(rests["time"][0], total, rel_tol=1e-12)
    assert motion.outcome is rk.Outcome.AT_REST
    assert (motion.final.angle, motion.final.velocity) == (0.0, 0.0)


@pytest.mark.parametrize("record", ["section", "none"])
def test_rest_is_reached_whatever_is_recorded(record):
    motion = _released(0.9, 0.6, record=record)
    assert motion.outcome is rk.Outcome.AT_REST
    assert (motion.final.angle, motion.final.velocity) == (0.0, 0.0)


def test_energy_is_kept_without_loss_for_ten_thousand_periods():
    """e = 1: period 4 arccosh(1/(1 − Θ₀)), the same peaks permanently."""
    angle = 0.4
    period = 4 * math.acosh(1 / (1 - angle))
    system = rk.System(rk.Harmonic(amplitude=0.0, period=period), 1.0)
    motion = rk.simulate(system, rk.State(angle=angle), cycles=10_000, record="none")
    # a shift of the period by half an ulp adds up to 10⁴ times as much time
    assert motion.impacts == 20_000
    assert math.isclose(motion.final.angle, angle, rel_tol=1e-12 * 1e3)
    # Every arc is the same, and so is its rounding: four halves of an ulp of what grows as e to half the period.
    rounding = 20_000 * 4 * 2.0**-53 * math.exp(period / 2)
    assert math.isclose(motion.peak, angle, abs_tol=rounding)


def test_released_beyond_the_critical_angle_it_overturns_without_an_impact():
    motion = _released(1.001, 0.9)
    assert motion.outcome is rk.Outcome.OVERTURNED
    assert motion.impacts == 0


def test_motion_between_events_is_the_closed_form():
    """Θ = 1 − (1 − Θ₀) cosh τ until the first impact."""
    motion = _released(0.5, 0.9)
    times = np.linspace(0, math.acosh(2.0), 50)[:-1]
    angle, velocity = motion.at(times)
    np.testing.assert_allclose(angle, 1 - 0.5 * np.cosh(times), rtol=0, atol=1e-15 * 4)
    np.testing.assert_allclose(velocity, -0.5 * np.sinh(times), rtol=0, atol=1e-15 * 4)
