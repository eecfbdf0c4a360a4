"""Fragility: runs as simulated, fits that recover known parameters, and intervals that cover the truth."""

import math
import re

import attrs
import numpy as np
import pandas as pd
import pytest
from scipy.optimize import minimize
from scipy.stats import norm

import rocking as rk
from rocking.model.block_formulas import GRAVITY
from rocking.model.record_set import RecordSet
from rocking.survey.fragility_curve import (
    DETERMINED,
    clustered_fractions,
    effective_records,
    log_basic_interval,
    lognormal_fits,
    two_level_weights,
    weighted_counts,
)
from rocking.survey.random_points import block_samples

BLOCK = rk.Block(2.0, 0.5)
LEVELS = np.linspace(2.0, 10.0, 9)
SPREADS = {"height_spread": 0.1, "width_spread": 0.15, "restitution_spread": 0.03}


@pytest.fixture(scope="module")
def records():
    return rk.synthetic_ground_motions(20, seed=1)


@pytest.fixture(scope="module")
def found(records):
    return rk.fragility(records, BLOCK, LEVELS, limits=[0.1, 0.5], model="slender", normalised_by="angle")


def plain_fit(levels, exceeding, rocking):
    """Maximise the likelihood over the logarithms of both parameters with a simplex."""

    def cost(parameters):
        score = (np.log(levels) - parameters[0]) / np.exp(parameters[1])
        return -np.sum(exceeding * norm.logcdf(score) + (rocking - exceeding) * norm.logsf(score))

    tight = {"xatol": 1e-10, "fatol": 1e-12, "maxiter": 10_000, "maxfev": 10_000}
    best = minimize(cost, (np.log(levels).mean(), -1.0), method="Nelder-Mead", options=tight)
    return math.exp(best.x[0]), math.exp(best.x[1])


def compared(records, count, seed):
    """Compare random runs of an uncertain block with single simulations; return the number of certified runs."""
    found = rk.fragility(
        records, BLOCK, LEVELS, samples=5, seed=3, **SPREADS, model="slender", normalised_by="angle"
    ).dataset
    drawn = block_samples(RecordSet(records), BLOCK, 5, tuple(SPREADS.values()), 3)
    random, certified = np.random.default_rng(seed), 0
    for _ in range(count):
        record, sample, level = (int(random.integers(size)) for size in (len(records), 5, LEVELS.size))
        size, slenderness, restitution = drawn[record, sample].tolist()
        base = records[record].scaled(pga=LEVELS[level])
        forcing = base.normalised(GRAVITY * slenderness, math.sqrt(0.75 * GRAVITY / size))
        motion = rk.simulate(rk.System(forcing, restitution))
        run = found.isel(record=record, sample=sample, level=level)
        if not (motion.certified and int(run.certified)):
            continue
        certified += 1
        assert math.isinf(float(run.peak)) == (motion.outcome == "overturned")
        if motion.outcome != "overturned":
            # the factor of the motion differs by a few roundings, which chaos amplifies
            assert float(run.peak) == pytest.approx(motion.peak, rel=1e-6, abs=1e-9)
    return certified


def test_runs_are_those_of_single_simulations(records):
    assert compared(records, 500, seed=4) > 450


@pytest.mark.long
def test_more_runs_are_those_of_single_simulations():
    assert compared(rk.synthetic_ground_motions(100, seed=2), 2000, seed=5) > 1800


def test_fractions_count_runs(found):
    data = found.dataset
    peak = data.peak.values
    for number, limit in enumerate((0.1, 0.5, math.inf)):
        exceeding = np.isinf(peak) if math.isinf(limit) else peak > limit
        assert data.fraction.values[number].tolist() == exceeding.mean(axis=0).tolist()
    assert data.rocking.values.tolist() == (GRAVITY * BLOCK.critical_angle < LEVELS).astype(float).tolist()
    assert (data.fraction_low <= data.fraction).all()
    assert (data.fraction <= data.fraction_high).all()
    assert (data.fraction.diff("limit") <= 0.0).all()


def test_fit_is_the_maximum_of_the_likelihood(found):
    data = found.dataset
    for number, fit in enumerate(found.fits):
        rocking = 20 * data.rocking.values
        median, dispersion = plain_fit(LEVELS, 20 * data.fraction.values[number], rocking)
        assert fit.median == pytest.approx(median, rel=1e-6)
        assert fit.dispersion == pytest.approx(dispersion, rel=1e-6)
        curve = data.rocking.values * norm.cdf(np.log(LEVELS / median) / dispersion)
        assert data.fit.values[number] == pytest.approx(curve, abs=1e-6)
        assert fit.misfit == pytest.approx(np.abs(curve - data.fraction.values[number]).max(), abs=1e-6)
        assert fit.median_low < fit.median < fit.median_high
        assert fit.dispersion_low < fit.dispersion < fit.dispersion_high


def test_fit_is_that_of_a_regression_over_all_runs():
    """A second opinion: a probit line Φ(a + b ln x) through single runs, by BFGS with its gradient."""
    given = {"limits": [0.3], "samples": 4, "width_spread": 0.1, "polarity": "both", "model": "slender"}
    found = rk.fragility(rk.synthetic_ground_motions(15, seed=7), BLOCK, np.linspace(1.5, 9.0, 11), **given)
    runs = found.dataset[["peak"]].to_dataframe()
    runs = runs[runs.peak > 0.0]
    places = np.log(runs.index.get_level_values("level").to_numpy())
    for fit in found.fits:
        signs = np.where(np.isinf(runs.peak) if math.isinf(fit.limit) else runs.peak > fit.limit, 1.0, -1.0)

        def cost(line, signs=signs):
            score = signs * (line[0] + line[1] * places)
            pull = -signs * np.exp(norm.logpdf(score) - norm.logcdf(score))
            return -norm.logcdf(score).sum(), np.array([pull.sum(), (pull * places).sum()])

        a, b = minimize(cost, (0.0, 1.0), jac=True, method="BFGS", options={"gtol": 1e-8}).x
        assert fit.median == pytest.approx(math.exp(-a / b), rel=1e-4)
        assert fit.dispersion == pytest.approx(1.0 / b, rel=1e-4)


def test_fit_of_two_levels_has_a_closed_form():
    """Two levels and two parameters: the curve runs through both fractions."""
    levels, exceeding, rocking = np.array([3.0, 8.0]), np.array([[4.0, 15.0]]), np.array([[20.0, 25.0]])
    fit = lognormal_fits(levels, exceeding, rocking)
    low, high = norm.ppf([4 / 20, 15 / 25])
    dispersion = math.log(8.0 / 3.0) / (high - low)
    assert fit.dispersion[0] == pytest.approx(dispersion, rel=1e-9)
    assert fit.median[0] == pytest.approx(3.0 * math.exp(-low * dispersion), rel=1e-9)


def test_known_median_and_dispersion_lie_in_their_intervals():
    """Records with lognormal capacities: the fit recovers the distribution that they were drawn from."""
    median, dispersion, levels, count = 5.0, 0.4, np.geomspace(1.5, 15.0, 12), 60
    inside = np.zeros(2)
    for seed in range(100):
        random = np.random.default_rng(seed)
        capacity = median * np.exp(dispersion * random.standard_normal(count))
        runs = (levels > capacity[:, None])[:, None]
        rocking = np.ones_like(runs)
        weights = two_level_weights(count, 1, 400, random)
        one = lognormal_fits(levels, runs.sum(axis=(0, 1))[None], rocking.sum(axis=(0, 1))[None])
        many = lognormal_fits(levels, weighted_counts(runs, weights), weighted_counts(rocking, weights))
        for number, (truth, estimate, bounds) in enumerate(
            (
                (median, one.median[0], many.median_bounds),
                (dispersion, one.dispersion[0], many.dispersion_bounds),
            )
        ):
            low, high = log_basic_interval(float(estimate), bounds, count)
            inside[number] += low <= truth <= high
    # fewer than 87 of 100 at a coverage of 95 % have the probability 0.0006
    assert inside.min() >= 87


def test_atom_of_runs_that_do_not_rock_stays_out_of_the_fit():
    levels = np.array([2.0, 4.0, 8.0])
    exceeding, rocking = np.array([[2.0, 10.0, 28.0]]), np.array([[10.0, 20.0, 30.0]])
    fit = lognormal_fits(levels, exceeding, rocking)
    assert (fit.median[0], fit.dispersion[0]) == pytest.approx(
        plain_fit(levels, exceeding[0], rocking[0]), rel=1e-6
    )
    other = lognormal_fits(levels, exceeding, np.full((1, 3), 30.0))
    assert abs(other.median[0] / fit.median[0] - 1.0) > 0.1


@pytest.mark.parametrize(
    "exceeding, bounds",
    [
        ((0, 0, 0), (0.0, math.inf)),
        ((9, 9, 9), (0.0, math.inf)),
        ((0, 9, 9), (1.0, 2.0)),
        ((0, 4, 9), (2.0, 2.0)),
        ((9, 4, 0), (0.0, math.inf)),
        ((4, 4, 0), (0.0, math.inf)),
    ],
)
def test_counts_without_a_finite_maximum_have_no_fit(exceeding, bounds):
    fit = lognormal_fits(np.array([1.0, 2.0, 3.0]), np.array([exceeding], float), np.full((1, 3), 9.0))
    assert fit.kind[0] != DETERMINED
    assert math.isnan(fit.median[0])
    assert math.isnan(fit.dispersion[0])
    low, high = (each[0] for each in fit.median_bounds)
    assert low <= bounds[1]
    assert high >= bounds[0]
    if bounds[0] > 0.0:
        assert (low, high) == bounds
        assert [each[0] for each in fit.dispersion_bounds] == [0.0, 0.0]


def test_undetermined_fit_is_said_in_one_line(records):
    weak = rk.fragility(records, BLOCK, [1.0, 2.0, 3.5], limits=(), model="slender")
    with pytest.raises(
        rk.TooShort, match="^no fit for overturning: no run shows overturning: add higher"
    ) as told:
        weak.fit()
    assert math.isnan(told.value.estimate.median)
    assert "no fit: no run shows overturning" in str(weak)
    strong = rk.fragility(records, BLOCK, [30.0, 40.0], limits=(), model="slender")
    assert str(strong).startswith(
        "overturning over PGA: no fit: all runs that rock show overturning: add lower"
    )
    single = rk.fragility(records[0], BLOCK, LEVELS, limits=(), model="slender")
    assert single.fits[0].problem
    assert single.dataset.effective_records.values.tolist() == [[1.0] * 9]


def test_order_of_the_records_is_of_no_importance(records):
    some = records[:7]
    given = {"limits": 0.5, "samples": 3, "seed": 5, **SPREADS}
    one, other = (rk.fragility(each, BLOCK, LEVELS, **given, model="slender") for each in (some, some[::-1]))
    assert one.fits == other.fits
    for name in ("fraction", "fraction_low", "fraction_high", "fit", "fit_low", "fit_high"):
        assert np.array_equal(one.dataset[name].values, other.dataset[name].values)
    assert np.array_equal(one.dataset.peak.values, other.dataset.peak.values[::-1])


def test_same_seed_gives_the_same_result_and_another_seed_another(records):
    given = {"limits": (), "samples": 2, "width_spread": 0.2}
    one, same, other = (
        rk.fragility(records[:5], BLOCK, LEVELS, **given, seed=k, model="slender") for k in (1, 1, 2)
    )
    assert np.array_equal(one.dataset.peak.values, same.dataset.peak.values)
    assert not np.array_equal(one.dataset.peak.values, other.dataset.peak.values)


def test_copies_of_a_record_are_refused(records):
    first, second = records[0], records[1]
    for copy in (first, first.scaled(2.0), first.reversed()):
        named = attrs.evolve(copy, name="copy")
        with pytest.raises(
            ValueError, match="records must hold independent motions; got 'copy, the same as synthetic 1'"
        ):
            rk.fragility([first, second, named], BLOCK, LEVELS, model="slender")
    assert first.fingerprint != second.fingerprint


def test_samples_have_the_distributions_that_are_stated(records):
    few = RecordSet(records[:2])
    drawn = block_samples(few, BLOCK, 2000, (0.1, 0.2, 0.01), 1)[0]
    height = 2.0 * drawn[:, 0] * np.cos(drawn[:, 1])
    width = 2.0 * drawn[:, 0] * np.sin(drawn[:, 1])
    # in a Latin hypercube each stratum of probability holds one sample
    for values, median, spread in ((height, 2.0, 0.1), (width, 0.5, 0.2)):
        places = np.sort(norm.cdf(np.log(values / median) / spread))
        assert np.array_equal(np.floor(2000 * places).astype(int), np.arange(2000))
    housner = 1.0 - 1.5 * np.sin(drawn[:, 1]) ** 2
    deviation = np.sort((drawn[:, 2] - housner) / 0.02 + 0.5)
    assert np.array_equal(np.floor(2000 * deviation).astype(int), np.arange(2000))
    chosen = block_samples(few, rk.Block(2.0, 0.5, 0.8), 50, (0.1, 0.2, 0.0), 1)
    assert np.abs(chosen[..., 2] - 0.8).max() == 0.0


def test_levels_relative_to_a_block_refer_to_the_nominal_one(records):
    lift_off = GRAVITY * math.tan(BLOCK.critical_angle)
    given = {"limits": (), "samples": 3, "width_spread": 0.2}
    ratio = rk.fragility(
        records[:4], BLOCK, [1.0, 2.0, 3.0], intensity="pga-ratio", **given, model="slender"
    ).dataset
    pga = rk.fragility(
        records[:4], BLOCK, np.array([1.0, 2.0, 3.0]) * lift_off, **given, model="slender"
    ).dataset
    assert np.array_equal(np.isinf(ratio.peak), np.isinf(pga.peak))
    assert np.isinf(pga.peak).any()
    assert not np.isinf(pga.peak).all()


def test_effective_number_is_that_of_the_variance():
    fractions = np.array([0.0, 0.25, 1.0, 1.0])
    members = (np.arange(4) < 4 * fractions[:, None])[..., None]
    s2 = fractions.var(ddof=1)
    p = fractions.mean()
    assert 3.0 < p * (1 - p) * 4 / s2 < 4.0
    assert effective_records(members) == pytest.approx(p * (1 - p) * 4 / s2)
    # one run per record: n − 1
    assert effective_records(np.array([1, 0, 1, 0, 0, 0]).reshape(6, 1, 1) > 0) == pytest.approx(5.0)
    # never above the number of records, even if each has a fraction of its own
    assert effective_records((np.arange(4) < np.array([1, 2, 1, 2])[:, None])[..., None]).tolist() == [4.0]
    # all records agree
    assert effective_records(np.zeros((8, 3, 1), bool)).tolist() == [8.0]
    assert effective_records((np.arange(4) < 2)[None, :, None].repeat(8, axis=0)).tolist() == [8.0]


def test_interval_of_no_run_in_twenty_records_is_that_of_wilson():
    """z² / (n + z²), whatever the number of runs of a record."""
    for samples in (1, 50):
        weights = two_level_weights(20, samples, 200, np.random.default_rng(0))
        found = clustered_fractions(np.zeros((20, samples, 1), bool), weights)
        z2 = norm.ppf(0.975) ** 2
        assert (found.low[0], found.high[0]) == pytest.approx((0.0, z2 / (20 + z2)), rel=1e-12)


def test_more_samples_of_the_same_records_do_not_shrink_the_interval():
    """Runs of a record that are all alike say what one of them says."""
    each = np.random.default_rng(1).random(30) < 0.4
    widths = []
    for samples in (1, 40):
        runs = np.repeat(each[:, None, None], samples, axis=1)
        found = clustered_fractions(runs, two_level_weights(30, samples, 1000, np.random.default_rng(2)))
        widths.append(found.high[0] - found.low[0])
    assert widths[1] == pytest.approx(widths[0], rel=0.05)


def test_weights_of_a_replicate_draw_records_and_then_their_runs():
    weights = two_level_weights(6, 4, 20_000, np.random.default_rng(3))
    assert (weights.sum(axis=(1, 2)) == 24).all()
    per_record = weights.sum(axis=2)
    assert (per_record % 4 == 0).all()
    # the number of draws of a record is binomial (6, 1/6): variance 5/6, within 5 standard errors of it
    assert (per_record / 4).var() == pytest.approx(5 / 6, rel=0.03)
    # weight of one run: mean 1; variance of 4 N trials of 1/4 is 3/4 + that of N, 5/6
    assert weights.var() == pytest.approx(3 / 4 + 5 / 6, rel=0.03)


def test_undecided_runs_widen_the_interval():
    random = np.random.default_rng(4)
    members = random.random((20, 1, 3)) < 0.5
    doubtful = np.zeros_like(members)
    doubtful[:3] = True
    weights = two_level_weights(20, 1, 500, random)
    sure, open_ = (clustered_fractions(members, weights, each) for each in (None, doubtful))
    assert (open_.low < sure.low).any()
    assert (open_.high > sure.high).any()
    assert (open_.low <= sure.low).all()
    assert open_.value.tolist() == sure.value.tolist()
    certain = clustered_fractions(members & ~doubtful, weights)
    assert open_.low.tolist() == certain.low.tolist()


def coverage(population, sets, sizes, fitted):
    """Return the coverage of fractions per level, and of both parameters of the fit, for sets of each size."""
    levels = np.linspace(3.0, 10.0, 8)
    records = rk.synthetic_ground_motions(population, seed=3)
    peaks = rk.incremental_dynamic_analysis(
        records, BLOCK, levels, intensity="pga", model="slender"
    ).dataset.peak
    fell = np.isinf(peaks.transpose("record", "level").values)
    truth = fell.mean(axis=0)
    of_all = lognormal_fits(levels, fell.sum(axis=0)[None], np.full((1, 8), float(population)))
    parameters = (float(of_all.median[0]), float(of_all.dispersion[0]))
    for size in sizes:
        random, inside, parts, fits = np.random.default_rng(size), np.zeros(8), np.zeros(2), 0
        for number in range(sets):
            runs = fell[random.integers(0, population, size)][:, None]
            weights = two_level_weights(size, 1, 1000, random)
            found = clustered_fractions(runs, weights)
            inside += (found.low <= truth) & (truth <= found.high)
            if number >= fitted:
                continue
            one = lognormal_fits(levels, runs.sum(axis=(0, 1))[None], np.full((1, 8), float(size)))
            if one.kind[0] != DETERMINED:
                continue
            fits += 1
            many = lognormal_fits(levels, weighted_counts(runs, weights), np.full((1000, 8), float(size)))
            for place, (value, bounds) in enumerate(
                ((one.median[0], many.median_bounds), (one.dispersion[0], many.dispersion_bounds))
            ):
                low, high = log_basic_interval(float(value), bounds, size)
                parts[place] += low <= parameters[place] <= high
        print(f"{size} records, {sets} sets, truth {np.round(truth, 3).tolist()}:")
        print(f"  fractions {(inside / sets).round(3).tolist()}, mean {(inside / sets).mean():.3f}")
        print(f"  median {parts[0] / fits:.3f}, dispersion {parts[1] / fits:.3f} of {fits} fits")
        yield size, inside / sets, parts / fits


@pytest.mark.long
def test_intervals_of_fifty_records_cover_the_population():
    """A thinned version of the long test: at a coverage of 95 %, less than 92 % of 300 sets has a probability of 1 %."""
    ((_, inside, parts),) = coverage(300, 300, (50,), 100)
    assert inside.min() >= 0.92
    assert parts.min() >= 0.87


@pytest.mark.long
@pytest.mark.timeout(1200)
def test_intervals_cover_the_population():
    for size, inside, parts in coverage(2000, 1000, (10, 20, 50), 1000):
        assert inside.min() >= 0.92
        if size == 50:
            assert parts.min() >= 0.92


def clustered_coverage(sets, as_records=False):
    """Return the coverage of median and dispersion for 60 records whose five runs share a part of their capacity.

    With `as_records` the runs are treated as independent.
    """
    median, between, within, levels = 5.0, 0.35, 0.2, np.geomspace(1.5, 15.0, 12)
    truth = (median, math.hypot(between, within))
    inside = np.zeros(2)
    for seed in range(sets):
        random = np.random.default_rng(seed)
        capacity = between * random.standard_normal((60, 1)) + within * random.standard_normal((60, 5))
        runs = levels > median * np.exp(capacity)[..., None]
        runs = runs.reshape(300, 1, 12) if as_records else runs
        rocking, weights = np.ones_like(runs), two_level_weights(*runs.shape[:2], 1000, random)
        one = lognormal_fits(levels, runs.sum(axis=(0, 1))[None], rocking.sum(axis=(0, 1))[None])
        many = lognormal_fits(levels, weighted_counts(runs, weights), weighted_counts(rocking, weights))
        for place, (value, bounds) in enumerate(
            ((one.median[0], many.median_bounds), (one.dispersion[0], many.dispersion_bounds))
        ):
            low, high = log_basic_interval(float(value), bounds, len(runs))
            inside[place] += low <= truth[place] <= high
    return inside / sets


@pytest.mark.long
@pytest.mark.timeout(1200)
def test_intervals_of_sixty_records_cover_both_parameters_in_a_thousand_simulations():
    inside, apart = clustered_coverage(1000), clustered_coverage(200, as_records=True)
    print(f"median {inside[0]:.3f}, dispersion {inside[1]:.3f}; as independent runs {apart}")
    assert np.abs(inside - 0.95).max() <= 0.03
    assert apart.max() < 0.9


def test_limits_that_are_not_there_have_no_fit(found):
    assert found.fit(0.5) is found.fits[1]
    with pytest.raises(ValueError, match=re.escape("limit must be one of 0.1, 0.5, inf; got 0.3")):
        found.fit(0.3)


def test_one_line_says_median_dispersion_and_runs(found):
    fit = found.fit()
    line = str(found)
    assert line.startswith(f"overturning over PGA: median {fit.median:.3g} m/s² ({fit.median_low:.3g}–")
    assert line.endswith("20 records, 9 levels, 180 runs")
    assert "\n" not in line
    assert str(fit).startswith(f"median {fit.median:.3g} (")


def test_a_store_keeps_the_runs(records, tmp_path):
    given = {"limits": (), "samples": 2, "width_spread": 0.1}
    folder = tmp_path / "runs"
    kept = rk.fragility(records[:4], BLOCK, LEVELS, **given, store=folder, model="slender")
    again = rk.fragility(records[:4], BLOCK, LEVELS, **given, store=folder, model="slender")
    plain = rk.fragility(records[:4], BLOCK, LEVELS, **given, model="slender")
    for each in (again, plain):
        assert np.array_equal(kept.dataset.peak.values, each.dataset.peak.values)
    with pytest.raises(ValueError, match="store"):
        rk.fragility(
            records[:4], BLOCK, LEVELS, **{**given, "width_spread": 0.2}, store=folder, model="slender"
        )


def test_fractions_that_hardly_grow_have_no_fit_and_no_warning():
    """The median of a nearly flat curve is not a number that a computer has."""
    exceeding = np.array([[3000, 3001, 3001], [7000, 7001, 7001]])
    fits = lognormal_fits(np.array([0.5, 1.0, 2.0]), exceeding, np.full((2, 3), 10_000))
    assert np.isnan(fits.median).all()
    assert np.isnan(fits.dispersion).all()


def test_two_levels_show_no_misfit():
    found = rk.fragility(
        rk.synthetic_ground_motions(12, seed=1), rk.Block(2.0, 0.5), [4.0, 6.0], limits=(), model="slender"
    )
    assert math.isnan(found.fit().misfit)
    assert "misfit" not in str(found)


@pytest.mark.parametrize("levels", [[[1.0], [2.0, 3.0]], [[1.0, 2.0]], [None], ["1"]])
def test_what_is_no_array_of_levels_is_refused(levels):
    with pytest.raises((TypeError, ValueError), match="^levels must "):
        rk.fragility(rk.synthetic_ground_motions(3, seed=1), rk.Block(2.0, 0.5), levels, model="slender")


def test_one_level_may_come_with_an_index():
    records = rk.synthetic_ground_motions(3, seed=1)
    found = rk.fragility(records, rk.Block(2.0, 0.5), pd.Series([2.0], index=[5]), limits=(), model="slender")
    assert found.dataset.level.values.tolist() == [2.0]
