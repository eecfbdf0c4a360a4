"""Averages along a motion: against their definitions in NumPy, and on sequences with known averages."""

import math

import numpy as np
import pytest

from rocking.kernels.numerics import averages

RANDOM = np.random.default_rng(1991)


def weights_of(values):
    """Working memory for the weights of values, which are symmetric."""
    return np.empty((len(values) + 1) // 2)


def digits(values):
    return averages.mean_and_digits(values, weights_of(values))[1]


@pytest.mark.parametrize("count", [1, 2, 3, 10, 1001])
def test_weighted_mean_is_that_of_the_bump(count):
    values = RANDOM.normal(size=count)
    x = np.arange(1, count + 1) / (count + 1)
    weights = np.exp(-1 / (x * (1 - x)))
    assert averages.mean_and_digits(values, weights_of(values))[0] == pytest.approx(
        np.average(values, weights=weights), rel=1e-12, abs=0
    )


def test_weighted_mean_of_a_rotation_is_its_integral_to_all_digits():
    """The mean of exp(sin) over a circle is I0(1) (Abramowitz and Stegun 9.6.16)."""
    turns = 2 * np.pi * np.arange(20_000) * 0.5 * (5**0.5 - 1)
    values = np.exp(np.sin(turns))
    assert averages.mean_and_digits(values, weights_of(values))[0] == pytest.approx(
        1.2660658777520084, rel=1e-14, abs=0
    )
    assert abs(values.mean() - 1.2660658777520084) > 1e-6  # unweighted it is far
    assert digits(values) > 13


def test_digits_of_agreement_are_those_of_the_halves():
    values = np.append(np.full(500, 2.0), np.full(500, 2.0 + 2e-7))
    assert digits(values) == pytest.approx(7.0, abs=1e-6)
    assert digits(np.zeros(100)) == digits(np.ones(100)) == 16.0
    assert digits(np.append(-np.ones(50), np.ones(50))) < 0.0


def test_error_of_a_sum_is_the_spread_of_its_groups():
    terms = RANDOM.normal(size=96)
    departures = terms - terms.mean()
    for width in (1, 2, 8):
        groups = departures.reshape(-1, width).sum(axis=1)
        known = math.sqrt(len(groups)) * math.sqrt((groups**2).sum() / (len(groups) - 1))
        assert averages.error_of_sum(departures, width) == pytest.approx(known, rel=1e-12, abs=0)


def test_error_of_a_mean_is_the_largest_of_three_ways_to_group():
    batches = 3.0 + RANDOM.normal(size=64)
    mean, error, correlation = averages.batch_error(batches.copy())
    known = [np.std(batches.reshape(-1, k).mean(axis=1), ddof=1) / math.sqrt(64 / k) for k in (1, 2, 4)]
    assert mean == pytest.approx(batches.mean(), rel=1e-15, abs=0)
    assert error == pytest.approx(max(known), rel=1e-12, abs=0)
    assert correlation == pytest.approx((max(known) / known[0]) ** 2, rel=1e-12, abs=0)


def test_correlated_batches_have_the_larger_error_that_is_theirs():
    """x' = .8 x + noise: sums of four spread √(1 + 2 (.75·.8 + .5·.64 + .25·.512)) = 1.76 times as much as single ones say."""
    ratios = []
    for _ in range(200):
        series = np.zeros(64)
        for k in range(1, 64):
            series[k] = 0.8 * series[k - 1] + RANDOM.normal()
        ratios.append(averages.batch_error(series.copy())[1] / (series.std(ddof=1) / 8))
    assert 1.5 < np.median(ratios) < 2.0
