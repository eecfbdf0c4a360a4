"""Fractions with intervals, and uncertainty exponents, against counts, geometry and the equations they solve."""

import numpy as np
import pytest

import rocking as rk
from rocking.model.share import Share, wilson
from rocking.model.survey_results import UncertaintyExponent
from rocking.survey.uncertainty_exponent import distances, exponent, perturbed_triples

Z = 1.959963984540054
REPEATS = 2_000
CANTOR = 1.0 - np.log(2.0) / np.log(3.0)


@pytest.mark.parametrize("count, of", [(0, 7), (1, 9), (5, 10), (567, 3000), (3000, 3000), (1, 100_000)])
def test_ends_of_an_interval_are_the_shares_that_a_test_just_does_not_reject(count, of):
    # (count/of − p)² = z² p (1 − p)/of, a quadratic in p
    share = count / of
    roots = np.sort(np.roots([1.0 + Z * Z / of, -(2.0 * share + Z * Z / of), share * share]).real)
    assert wilson(count, of) == pytest.approx(tuple(roots), abs=1e-12)


def test_an_interval_of_none_or_all_reaches_the_end_exactly():
    assert wilson(0, 50)[0] == 0.0
    assert wilson(50, 50)[1] == 1.0
    assert wilson(0, 0) == (0.0, 1.0)
    assert str(Share(1, 3000)) == "0.033 % (0.0059–0.2 %)"
    assert str(Share(2999, 3000)) == "99.967 % (99.8–99.9941 %)"
    assert str(Share(0, 50)) == "0 % (0–7.1 %)"
    assert str(Share(50, 50)) == "100 % (92.9–100 %)"


@pytest.mark.parametrize("count, of, unknown", [(567, 3000, 300), (0, 50, 3), (47, 50, 3)])
def test_an_interval_covers_every_number_of_the_unknown_that_may_belong_and_no_more(count, of, unknown):
    """Its lower end counts none of them, so that they widen it upwards alone."""
    ends = [wilson(count + each, of) for each in range(unknown + 1)]
    share = Share(count, of, unknown)
    assert (share.low, share.high) == (min(low for low, _ in ends), max(high for _, high in ends))
    assert share.low == Share(count, of).low
    assert share.high > Share(count, of).high or share.high == 1.0


@pytest.mark.parametrize("share, of", [(0.189, 3000), (0.045, 3000), (0.64, 400), (0.5, 100)])
def test_intervals_cover_what_they_are_of(share, of):
    low, high = wilson(np.random.default_rng(1).binomial(of, share, REPEATS), of)
    assert np.mean((low <= share) & (share <= high)) == pytest.approx(0.95, abs=0.02)


def test_intervals_of_basin_fractions_cover():
    each = 60
    system = rk.System(rk.Harmonic(amplitude=5.53, period=1.0), restitution=0.8)
    found = rk.basin_map(
        system,
        angle=(-1, 1),
        velocity=(-1, 1),
        samples=each * REPEATS,
        seed=3,
        max_cycles=500,
        boundary_runs=0,
    )
    fell = (found.dataset.kind.values == 4).reshape(REPEATS, each)
    low, high = wilson(fell.sum(axis=1), each)
    # the share of all of them is 45 times as well known as those of the parts
    assert np.mean((low <= fell.mean()) & (fell.mean() <= high)) == pytest.approx(0.95, abs=0.02)


def test_two_starts_lie_beside_each_in_opposite_directions_at_the_distances_tried():
    tried = perturbed_triples((-1.0, -2.0), (1.0, 2.0), 2_400, np.random.default_rng(5))
    middle, one, other = np.moveaxis(tried, 2, 0)
    np.testing.assert_allclose(one + other, 2.0 * middle, rtol=0, atol=1e-15)
    away = np.hypot(*np.moveaxis(one - middle, -1, 0))
    np.testing.assert_allclose(away, np.broadcast_to(distances((2.0, 4.0))[:, None], away.shape), rtol=1e-12)


def fake_trios(label, random, each=4000):
    reach = 0.03 * 0.5 ** np.arange(8)
    middle = random.uniform(0.0, 1.0, (8, each))
    step = reach[:, None] * np.cos(random.uniform(0.0, np.pi, (8, each)))
    return reach, label(np.stack([middle, middle - step, middle + step], axis=2))


def cantor(points):
    """On which level the gap of the middle-thirds set lies that a number is in: even or odd."""
    level, left, x = np.zeros(points.shape, int), np.ones(points.shape, bool), points % 1.0
    for depth in range(1, 25):
        x = 3.0 * x
        gap = left & (x >= 1.0) & (x < 2.0)
        level[gap], left = depth, left & ~gap
        x = np.where(x >= 2.0, x - 2.0, x)
    return level % 2


def test_a_smooth_boundary_has_exponent_one_and_its_interval_covers():
    random, covered = np.random.default_rng(2), 0
    for _ in range(300):
        found = exponent(*fake_trios(lambda x: x > 0.4, random))
        covered += found.low <= 1.0 <= found.high
    assert 0.93 <= covered / 300 <= 1.0


def test_a_cantor_boundary_has_the_exponent_of_its_dimension():
    found = exponent(*fake_trios(cantor, np.random.default_rng(3), 20_000))
    # its share oscillates about the power law, by a few percent of the slope over eight octaves
    assert found.value == pytest.approx(CANTOR, abs=0.03)
    assert not found.smooth
    assert found.fractal


@pytest.mark.parametrize(
    "interval, smooth, fractal, meaning",
    [
        ((0.72, 1.13), False, False, "undecided: 0.72–1.13 contains 1"),
        ((0.95, 1.04), True, False, "contains 1, not below 0.9: smooth"),
        ((0.72, 0.98), False, True, "below 1: fractal"),
        ((1.02, 1.2), False, False, "undecided: 1.02–1.20 lies above 1"),
    ],
)
def test_only_a_narrow_interval_says_what_a_boundary_is(interval, smooth, fractal, meaning):
    found = UncertaintyExponent(sum(interval) / 2, *interval, (), (), 1.0)
    assert (found.smooth, found.fractal, found.meaning) == (smooth, fractal, meaning)


def test_where_nothing_is_uncertain_there_is_no_exponent():
    assert exponent(*fake_trios(lambda x: x > 2.0, np.random.default_rng(4))) is None


@pytest.mark.parametrize("period, restitution", [(1.0, 0.8), (2.0, 0.925)])
@pytest.mark.long
def test_the_boundary_of_overturning_is_smooth_up_to_the_tangency_and_fractal_above(period, restitution):
    tangency = rk.theory.heteroclinic_amplitude(period, restitution)
    starts = np.linspace(-1, 1, 9)
    found = [
        rk.basin_map(
            rk.System(rk.Harmonic(amplitude=times * tangency, period=period), restitution),
            angle=starts,
            velocity=starts,
            max_cycles=1000,
        ).uncertainty_exponent
        for times in (0.9, 1.0, 1.5)
    ]
    for one in found[:2]:
        assert one.low <= 1.0 <= one.high
        assert not one.fractal
    assert found[2].high < 0.7


@pytest.mark.parametrize(
    "count, of, unknown, told",
    [
        (5, 10, 6, r"count \+ unknown must be at most of = 10; got 11"),
        (11, 10, 0, r"count \+ unknown must be at most of = 10; got 11"),
        (-1, 10, 0, "count must be a whole number in .*; got -1"),
        (0, -2, 0, "of must be a whole number in .*; got -2"),
        (0, 10, -3, "unknown must be a whole number in .*; got -3"),
    ],
)
def test_impossible_counts_are_refused(count, of, unknown, told):
    with pytest.raises(ValueError, match=f"^{told}"):
        rk.Share(count, of, unknown)
