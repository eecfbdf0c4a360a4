"""Intensities of ground motions against independent formulas: CAV, durations, RotD50 and RotD100, averages of spectra."""

import math
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import rocking as rk

G = 9.80665
RECORDS = Path(__file__).parents[3] / "shared" / "records"
WTMC = RECORDS / "20161113_110259_WTMC_20.V2A"


def noise(seed, samples=60, step=0.05):
    return rk.GroundMotion(np.random.default_rng(seed).normal(size=samples), step=step)


def test_cav_is_exact_in_rational_numbers():
    values = [Fraction(k * k % 11 - 5, 2) for k in range(30)]
    step, total = Fraction(1, 8), Fraction(0)
    for first, second in pairwise(values):
        if first * second < 0:  # two triangles on both sides of the zero
            zero = first / (first - second)
            total += (abs(first) * zero + abs(second) * (1 - zero)) * step / 2
        else:
            total += abs(first + second) * step / 2
    motion = rk.GroundMotion([float(value) for value in values], step=0.125)
    assert motion.cav == pytest.approx(float(total), rel=1e-14)
    assert motion.scaled(-3.0).cav == pytest.approx(3.0 * motion.cav, rel=1e-14)


def test_cav_is_at_least_the_velocity_and_equal_for_one_push():
    push = rk.GroundMotion([0.0, 2.0, 0.5, 0.0], step=0.1)
    assert push.cav == pytest.approx(push.pgv, rel=1e-14)
    assert noise(3).cav > noise(3).pgv


@pytest.mark.parametrize("threshold", [0.05, 0.7, 1.5, 2.0])
def test_bracketed_duration_is_that_on_a_fine_grid(threshold):
    motion = noise(2)
    times = np.linspace(0, motion.duration, 1_000_000)
    strong = times[np.abs(np.interp(times, motion.times, motion.acceleration)) >= threshold]
    expected = strong[-1] - strong[0] if strong.size else 0.0
    assert motion.bracketed_duration(threshold) == pytest.approx(expected, abs=2 * times[1])


def test_bracketed_duration_of_simple_motions():
    triangle = rk.GroundMotion([0.0, 1.0, 0.0], step=1.0)
    assert triangle.bracketed_duration(0.25) == pytest.approx(1.5)
    assert triangle.bracketed_duration(1.0) == 0.0
    assert triangle.bracketed_duration(2.0) == 0.0
    assert triangle.bracketed_duration() == pytest.approx(2 * (1 - 0.05 * G))
    assert rk.GroundMotion([2.0, -2.0], step=1.0).bracketed_duration(1.0) == 1.0
    assert rk.GroundMotion([0.0], step=1.0).bracketed_duration() == 0.0


@pytest.mark.parametrize("threshold", [0.0, -1.0, math.nan, math.inf, "g", None])
def test_threshold_has_a_range(threshold):
    with pytest.raises(ValueError, match=r"^threshold must "):
        noise(1).bracketed_duration(threshold)


def test_ratio_of_peaks():
    assert noise(4).pgv_to_pga == noise(4).pgv / noise(4).pga
    assert math.isnan(rk.GroundMotion([0.0, 0.0], step=0.1).pgv_to_pga)


def integrated(motions, period, damping):
    """ω² u of each motion at many times, by a general solver of differential equations."""
    w = 2 * math.pi / period
    rows = []
    for motion in motions:

        def rates(time, state, motion=motion):
            a = np.interp(time, motion.times, motion.acceleration)
            return [state[1], -a - 2 * damping * w * state[1] - w * w * state[0]]

        run = solve_ivp(
            rates,
            (0, motion.duration),
            [0, 0],
            t_eval=np.linspace(0, motion.duration, 5_000),
            rtol=1e-9,
            atol=1e-13,
            max_step=motion.step / 4,
        )
        rows.append(w * w * run.y[0])
    return np.array(rows)


@pytest.mark.parametrize("period, damping", [(0.3, 0.05), (1.0, 0.2), (2.5, 0.0)])
def test_rotated_spectra_are_percentiles_of_integrated_oscillators(period, damping):
    pair = noise(5), noise(6)
    x, y = integrated(pair, period, damping)
    turned = [
        np.abs(x * math.cos(angle) + y * math.sin(angle)).max()
        for angle in (math.radians(degree) for degree in range(180))
    ]
    ordered = sorted(turned)
    for percentile, expected in ((0, ordered[0]), (50, (ordered[89] + ordered[90]) / 2), (100, ordered[-1])):
        found = pair[0].rotated_spectrum(pair[1], period, damping, percentile=percentile)
        assert found == pytest.approx(expected, rel=1e-4)


def test_rotated_oscillator_is_that_of_the_rotated_motion():
    """The oscillator is linear: each of the 180 numbers is an ordinary spectrum, so RotD100 is their maximum."""
    first, second = noise(7, 200), noise(8, 200)
    turned = [
        rk.GroundMotion(
            math.cos(angle) * first.acceleration + math.sin(angle) * second.acceleration, step=first.step
        ).response_spectrum(0.7)
        for angle in np.radians(np.arange(180))
    ]
    assert first.rotated_spectrum(second, 0.7, percentile=100) == pytest.approx(max(turned), rel=1e-12)
    assert first.rotated_spectrum(second, 0.7) == pytest.approx(np.median(turned), rel=1e-12)


def test_rotated_spectra_of_simple_pairs():
    motion, still = noise(9), rk.GroundMotion(np.zeros(60), step=0.05)
    periods = np.array([[0.2, 0.5], [1.0, 2.0]])
    alone = motion.response_spectrum(periods)
    # of the 180 numbers |cos φ|, the mean of the two in the middle
    half = np.median(np.abs(np.cos(np.radians(np.arange(180)))))
    np.testing.assert_allclose(motion.rotated_spectrum(still, periods, percentile=100), alone, rtol=1e-12)
    np.testing.assert_allclose(motion.rotated_spectrum(still, periods), half * alone, rtol=1e-12)
    np.testing.assert_allclose(
        motion.rotated_spectrum(motion, periods, percentile=100), math.sqrt(2) * alone, rtol=1e-12
    )
    assert type(motion.rotated_spectrum(still, 1.0)) is float
    other = noise(10)
    np.testing.assert_allclose(
        motion.rotated_spectrum(other, 0.5),
        other.rotated_spectrum(motion, 0.5),
        rtol=1e-12,  # the same line, turned
    )


@pytest.mark.parametrize(
    "other, options, message",
    [
        (
            noise(1, 50),
            {},
            "other must have 60 samples with a step of 0.05 s, as the first component; got 50 s",
        ),
        (
            noise(1, step=0.1),
            {},
            "other must have 60 samples with a step of 0.05 s, as the first component; ",
        ),
        (noise(1).acceleration, {}, "other must be a GroundMotion"),
        (noise(1), {"percentile": 101}, r"percentile must lie in \[0, 100\]"),
        (noise(1), {"percentile": math.nan}, r"percentile must lie in \[0, 100\]"),
        (noise(1), {"damping": 1.0}, "damping must lie in"),
        (noise(1), {"periods": [1.0, 0.0]}, "periods must lie in"),
    ],
)
def test_pair_that_has_no_rotated_spectrum_is_refused(other, options, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        noise(1).rotated_spectrum(other, **({"periods": 1.0} | options))


def test_average_spectrum_is_the_geometric_mean():
    motion, periods = noise(11), [0.3, 0.6, 1.2, 2.4]
    product = math.prod(float(motion.response_spectrum(period, 0.1)) for period in periods)
    assert motion.average_spectrum(periods, 0.1) == pytest.approx(product**0.25, rel=1e-12)
    assert type(motion.average_spectrum(0.3)) is float
    assert rk.GroundMotion([0.0, 0.0], step=0.1).average_spectrum([1.0, 2.0]) == 0.0
    with pytest.raises(ValueError, match="^periods must hold one period at least"):
        motion.average_spectrum([])


@pytest.mark.skipif(not WTMC.exists(), reason="file absent")
def test_rotated_spectrum_of_a_recorded_pair_lies_between_those_of_its_components():
    pair = [each for each in rk.read_ground_motions(WTMC) if not each.vertical]
    periods = np.array([0.2, 0.5, 1.0, 2.0])
    of_each = np.array([each.response_spectrum(periods) for each in pair])
    most, median, least = (
        pair[0].rotated_spectrum(pair[1], periods, percentile=percentile) for percentile in (100, 50, 0)
    )
    assert (most >= of_each.max(axis=0) * (1 - 1e-12)).all()
    assert (least <= of_each.min(axis=0) * (1 + 1e-12)).all()
    # RotD100/RotD50 lies between 1, of a circle, and √2, of a line
    assert ((most / median > 1.0) & (most / median < math.sqrt(2))).all()
