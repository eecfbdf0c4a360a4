"""Rate of overturning: closed form, integrals, simulated years, catalogues with a known rate, and tables of hazards."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import quad
from scipy.stats import norm

import rocking as rk
from rocking.model.hazard import HazardCurve
from rocking.model.record_results import Fragility, LognormalFit
from rocking.survey.fragility_curve import (
    ALL_ABOVE,
    ALL_BELOW,
    DECREASING,
    DETERMINED,
    SEPARATED,
    lognormal_fits,
    two_level_weights,
)
from rocking.survey.overturning_rate import (
    fraction_weights,
    hazard_curve,
    rate_interval,
    rate_parts,
    replicate_bounds,
)

BLOCK = rk.Block(2.0, 0.5)
X = np.array([0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 13.0, 30.0])
H = np.array([0.12, 0.03, 0.006, 2.2e-3, 5e-4, 1.2e-4, 3e-5, 2e-6])
"""Levels in m/s² and annual rates of a hazard."""


def made(levels, capacities, fit, peak_of_others=0.3, unit="m/s²"):
    """Return a fragility whose records overturn the block above their capacities."""
    peak = np.where(np.asarray(levels) > np.asarray(capacities)[:, None], np.inf, peak_of_others)
    data = xr.Dataset(
        {
            "peak": (("record", "level"), peak),
            "certified": (("record", "level"), np.ones(peak.shape, np.int8)),
        },
        {
            "level": (
                "level",
                levels,
                {"units": unit, "symbol": "PGA", "long_name": "peak ground acceleration"},
            )
        },
        {"intensity": "pga"},
    )
    return Fragility(data, BLOCK, (fit,))


def with_fit(median, dispersion):
    nan = math.nan
    return LognormalFit(math.inf, median, nan, nan, dispersion, nan, nan, nan)


def drawn_capacities(count, seed, median=5.0, dispersion=0.4):
    return median * np.exp(dispersion * np.random.default_rng(seed).standard_normal(count))


def drawn(count=60, seed=0, levels=None, **how):
    """Return a fragility of records with lognormal capacities, and its levels."""
    levels = np.geomspace(1.2, 15.0, 12) if levels is None else levels
    capacities = drawn_capacities(count, seed)
    runs = (levels > capacities[:, None]).sum(axis=0)[None]
    one = lognormal_fits(levels, runs, np.full_like(runs, count))
    return made(levels, capacities, with_fit(float(one.median[0]), float(one.dispersion[0])), **how)


def by_quadrature(median, dispersion, rocking=lambda x: 1.0, breaks=()):
    """Integrate P |dH| over ln x, piece by piece; the slopes of both ends continue."""
    slopes = -np.diff(np.log(H)) / np.diff(np.log(X))
    edges = np.unique(np.concatenate((np.log(X), np.log(breaks), [math.log(1e-3), math.log(1e5)])))

    def integrand(place, row):
        rate = H[row] * math.exp(-slopes[row] * (place - math.log(X[row])))
        fit = norm.cdf((place - math.log(median)) / dispersion)
        return rocking(math.exp(place)) * fit * slopes[row] * rate

    total = 0.0
    for low, high in pairwise(edges):
        row = min(max(int(np.searchsorted(np.log(X), 0.5 * (low + high))) - 1, 0), len(X) - 2)
        total += quad(integrand, low, high, (row,), epsabs=0.0, epsrel=1e-11, limit=500)[0]
    return total


@pytest.mark.parametrize("slope", [0.5, 2.0, 3.5, 8.0])
@pytest.mark.parametrize("median, dispersion", [(3.0, 0.2), (5.0, 0.4), (0.3, 1.2)])
@pytest.mark.parametrize("rows", [2, 9])
def test_one_power_law_has_a_closed_form(slope, median, dispersion, rows):
    """λ = H(θ) e^{k²β²/2}, wherever the table ends."""
    levels = np.geomspace(0.5, 20.0, rows)
    fragility = made([1.0, 2.0, 4.0], [1.5, 3.0, 9.0], with_fit(median, dispersion))
    result = rk.overturning_rate(fragility, (levels, 0.01 * levels**-slope))
    closed = 0.01 * median**-slope * math.exp(0.5 * (slope * dispersion) ** 2)
    assert result.rate == pytest.approx(closed, rel=1e-12)


@pytest.mark.parametrize("median, dispersion", [(1.5, 0.3), (4.9, 0.26), (9.0, 0.8)])
def test_table_is_integrated_exactly(median, dispersion):
    result = rk.overturning_rate(made([1.0, 2.0, 4.0], [1.5, 3.0, 9.0], with_fit(median, dispersion)), (X, H))
    assert result.rate == pytest.approx(by_quadrature(median, dispersion), rel=1e-9)


def test_runs_that_stay_at_rest_do_not_overturn():
    """A level has the fraction that rocks of the nearest level in ln x."""
    levels = np.array([2.0, 3.0, 5.0])
    fractions, borders = np.array([0.0, 0.5, 1.0]), np.sqrt(levels[1:] * levels[:-1])
    _, parts = rate_parts(HazardCurve(X, H), levels, fractions, 4.0, 0.4)

    def rocking(x):
        return fractions[np.searchsorted(borders, x)]

    assert parts.sum() == pytest.approx(by_quadrature(4.0, 0.4, rocking, borders), rel=1e-9)
    assert parts.sum() < 0.9 * by_quadrature(4.0, 0.4)


def test_steep_tables_and_wide_fits_neither_overflow_nor_cancel():
    """Factors e^{k²β²/2} beyond the range of doubles."""
    curve = HazardCurve([1.0, 1.01, 30.0], [1.0, 1e-3, 1e-6])
    assert curve.slopes[0] > 600.0
    parts = rate_parts(curve, np.array([1.0, 2.0]), np.ones(2), 3.0, 1.5)[1]
    assert np.isfinite(parts[1:]).all()
    assert math.isinf(parts[0])
    with pytest.raises(
        ValueError, match=r"^hazard must begin at levels that hardly overturn the block; got 1\.0"
    ):
        rk.overturning_rate(made([1.0, 2.0], [1.5, 1.8], with_fit(3.0, 1.5)), (curve.levels, curve.rates))
    place = np.array([norm.cdf((math.log(x) - math.log(3.0)) / 1.5) for x in (1.0, 1.01)])
    # on the steep piece the rate falls by 0.999, at nearly one probability
    assert place[0] * 0.999 < parts[1] < place[1] * 0.999


def test_parts_add_up_and_ends_are_stated():
    fragility = drawn()
    result = rk.overturning_rate(fragility, (X[2:6], H[2:6]))
    data = result.dataset
    assert data.part_rate.sum().item() == pytest.approx(result.rate, rel=1e-12)
    assert data.part_low.values.tolist() == [0.0, *X[2:6]]
    assert data.part_high.values.tolist() == [*X[2:6], math.inf]
    assert data.share_below.item() == pytest.approx(data.part_rate.values[0] / result.rate)
    assert data.share_above.item() == pytest.approx(data.part_rate.values[-1] / result.rate)
    assert 0.05 < data.share_above.item() < 0.3
    assert "% of the rate from above the table of the hazard" in str(result)
    assert data.share_untested.item() < 0.05
    few = rk.overturning_rate(drawn(levels=np.array([3.0, 4.0, 5.0])), (X, H))
    assert "% of the rate from outside the levels of the fragility" in str(few)
    assert "table" not in str(few)
    fit = fragility.fits[0]
    assert data.probability.values.tolist() == fit.probability(X[2:6]).tolist()


def test_rate_by_fractions_is_that_of_straight_lines():
    """The integral of −P dH by a fine sum over P linear in ln x, 0 below the first level and flat above the last."""
    levels, fractions = np.array([1.5, 2.5, 4.0, 9.0]), np.array([0.1, 0.0, 0.4, 0.9])
    curve = HazardCurve(X, H)
    fine = np.linspace(math.log(1.5), math.log(9.0), 400_001)
    rates = curve.rate(np.exp(fine))
    middle = np.interp(0.5 * (fine[:-1] + fine[1:]), np.log(levels), fractions)
    expected = (middle * -np.diff(rates)).sum() + 0.9 * rates[-1]
    assert fraction_weights(curve, levels) @ fractions == pytest.approx(expected, rel=1e-8)


def test_both_rates_agree_for_lognormal_capacities():
    fragility = drawn(2000, levels=np.geomspace(0.8, 30.0, 60))
    result = rk.overturning_rate(fragility, (X, H)).dataset
    assert result.fraction_rate.item() == pytest.approx(result.rate.item(), rel=0.03)
    for name in ("rate", "fraction_rate"):
        assert result[f"{name}_low"] < result[name] < result[f"{name}_high"]


def test_probability_is_that_of_a_poisson_process():
    result = rk.overturning_rate(drawn(), (X, H))
    value, low, high = result.probability(50)
    ends = (result.rate, result.rate_low, result.rate_high)
    assert [value, low, high] == pytest.approx([1.0 - math.exp(-50.0 * each) for each in ends], rel=1e-9)
    assert result.probability(1).value == pytest.approx(result.rate, rel=1e-3)
    row = result.to_dict()
    assert (row["probability_50_years"], row["rate"]) == (value, result.rate)
    json.dumps(row, allow_nan=False)
    with pytest.raises(ValueError, match="years must"):
        result.probability(0.0)


def test_order_of_the_records_and_of_a_mapping_is_of_no_importance():
    fragility = drawn(20)
    reverse = Fragility(fragility.dataset.isel(record=slice(None, None, -1)), BLOCK, fragility.fits)
    one = rk.overturning_rate(fragility, (X, H)).dataset
    for other in (
        rk.overturning_rate(reverse, (X, H)),
        rk.overturning_rate(fragility, dict(zip(X[::-1], H[::-1], strict=True))),
        rk.overturning_rate(fragility, np.array([X, H])),
    ):
        xr.testing.assert_allclose(one, other.dataset, rtol=1e-14)
    assert rk.overturning_rate(fragility, (X, H), seed=1).rate_low != one.rate_low.item()


def test_limits_have_their_own_rates():
    records = rk.synthetic_ground_motions(20, seed=1)
    curves = rk.fragility(records, BLOCK, np.linspace(2, 10, 9), limits=0.5, model="slender")
    both = [rk.overturning_rate(curves, (X, H), limit=limit) for limit in (0.5, math.inf)]
    assert both[0].rate > both[1].rate
    assert str(both[0]).startswith("|Θ| > 0.5: annual rate ")
    assert both[0].dataset.attrs["median"] == curves.fit(0.5).median
    with pytest.raises(ValueError, match=r"limit must be one of 0\.5, inf"):
        rk.overturning_rate(curves, (X, H), limit=0.3)


def test_samples_and_polarities_of_a_record_stay_together():
    records = rk.synthetic_ground_motions(6, seed=1)
    given = {"limits": (), "model": "slender", "samples": 3, "width_spread": 0.1, "polarity": "both"}
    curves = rk.fragility(records, BLOCK, np.linspace(2, 10, 9), **given)
    result = rk.overturning_rate(curves, (X, H))
    assert result.rate_low < result.rate < result.rate_high
    fraction = curves.dataset.fraction.values[-1]
    expected = fraction_weights(HazardCurve(X, H), curves.dataset.level.values) @ fraction
    assert result.dataset.fraction_rate.item() == pytest.approx(expected, rel=1e-12)


def test_undetermined_fit_has_no_rate():
    curves = rk.fragility(
        rk.synthetic_ground_motions(5, seed=1), BLOCK, [1.0, 2.0, 3.0], limits=(), model="slender"
    )
    with pytest.raises(rk.TooShort, match="no run shows overturning: add higher levels"):
        rk.overturning_rate(curves, (X, H))


def test_replicates_without_a_fit_count_with_their_bounds():
    """Runs say only between which levels the median lies, or on which side of all levels."""
    levels, curve = np.array([2.0, 4.0, 8.0]), HazardCurve(X, H)
    exceeding = np.array([[0, 9, 9], [0, 0, 0], [9, 9, 9], [4, 4, 0], [1, 4, 8]])
    fits = lognormal_fits(levels, exceeding, np.full_like(exceeding, 9))
    assert fits.kind.tolist() == [SEPARATED, ALL_BELOW, ALL_ABOVE, DECREASING, DETERMINED]
    low, high = replicate_bounds(curve, levels, fits, np.ones((5, 3)))
    at = curve.rate(levels)
    assert low[:4] == pytest.approx([at[1], 0.0, at[0], 0.0], rel=1e-4)
    assert high[:4] == pytest.approx([at[0], at[2], math.inf, math.inf], rel=1e-4)
    assert (
        low[4]
        == high[4]
        == rate_parts(curve, levels, np.ones(3), fits.median[4], fits.dispersion[4])[1].sum()
    )


def covered(sets, slope, count=60):
    """Return below, in and above how many intervals the true rate lies, for catalogues with lognormal capacities."""
    levels, median, dispersion = np.geomspace(1.2, 15.0, 12), 5.0, 0.4
    table = np.geomspace(0.3, 80.0, 10)
    curve = HazardCurve(table, 0.02 * table**-slope)
    truth = 0.02 * median**-slope * math.exp(0.5 * (slope * dispersion) ** 2)
    result = np.zeros(3, int)
    for seed in range(sets):
        runs = (levels > drawn_capacities(count, seed)[:, None])[:, None]
        one = lognormal_fits(levels, runs.sum(axis=(0, 1))[None], np.full((1, levels.size), count))
        rate = float(
            rate_parts(curve, levels, np.ones(levels.size), one.median[0], one.dispersion[0])[1].sum()
        )
        weights = two_level_weights(count, 1, 1000, np.random.default_rng(seed))
        low, high = rate_interval(curve, levels, runs, np.ones_like(runs), weights, rate)
        result[int(truth > high) - int(truth < low) + 1] += 1
    return result


def test_interval_covers_the_rate():
    """At a coverage of 95 %, fewer than 51 of 60 have the probability 0.0004."""
    assert covered(60, 2.5)[1] >= 51


@pytest.mark.long
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("slope", [2.0, 3.5])
def test_interval_of_sixty_records_covers_the_rate_of_a_thousand_catalogues(slope):
    below, inside, above = covered(1000, slope)
    print(f"slope {slope}: {inside} of 1000 intervals cover; the rate is below {below} and above {above}")
    assert inside >= 920


def simulated_years(overturnings, records, seed):
    """Simulate earthquakes until about so many overturn the block; return the results of `overturning_rate` and the counts."""
    motions = rk.synthetic_ground_motions(records, seed=5)
    curves = rk.fragility(motions, BLOCK, np.geomspace(2.2, 30.0, 60), limits=(), model="slender")
    result = rk.overturning_rate(curves, (X, H))
    random, floor = np.random.default_rng(seed), 2.2  # below it no motion lifts the block
    assert floor < 9.8 * BLOCK.width / BLOCK.height
    rate = float(np.exp(np.interp(math.log(floor), np.log(X), np.log(H))))
    years = overturnings / result.rate
    count = random.poisson(rate * years)
    # H of the levels is uniform; the last slope continues
    last = math.log(H[-1] / H[-2]) / math.log(X[-1] / X[-2])
    far = H[-1] * (1e4 / X[-1]) ** last
    places = np.interp(
        -np.log(rate * random.random(count)), -np.log(np.append(H, far)), np.log(np.append(X, 1e4))
    )
    levels, chosen, fell = np.exp(places), random.integers(0, records, count), 0
    for number, motion in enumerate(motions):
        own = np.unique(levels[chosen == number])
        peaks = rk.incremental_dynamic_analysis(
            motion, BLOCK, own, intensity="pga", model="slender"
        ).dataset.peak
        fell += int(np.isinf(peaks).sum())
    return result, fell, years


def check_simulation(overturnings, records, seed):
    """Compare the rates with that of simulated overturnings, a Poisson number."""
    result, fell, years = simulated_years(overturnings, records, seed)
    print(f"{fell} overturnings in {years:.4g} years: {fell / years:.4g} per year; {result}")
    error = math.sqrt(fell) / years
    assert abs(result.dataset.fraction_rate.item() - fell / years) < 3.0 * error
    # the fractions of these records are not lognormal
    assert result.rate_low < fell / years < result.rate_high


def test_rate_is_that_of_simulated_years():
    check_simulation(1000, 12, seed=1)


@pytest.mark.long
def test_rate_is_that_of_ten_thousand_simulated_overturnings():
    check_simulation(10_000, 60, seed=1)


@pytest.mark.parametrize(
    "text, unit, factor",
    [
        ("PGA (g),annual rate\n0.1,0.01\n.2,.004\n", "m/s²", 9.80665),
        ("\ufeffpga_g;rate\r\n0,1;0,01\r\n0,2;0,004\r\n", "m/s²", 9.80665),
        ("PGA\trate\ng\t1/yr\n0.1\t0.01\n.2\t.004\n", "m/s²", 9.80665),
        ("# a site\n0.2 0.004\n\n0.1 1e-2\n", "m/s²", 1.0),
        ("PGA [cm/s^2],rate\n0.1,0.01\n.2,.004\n", "g", 0.01 / 9.80665),
        ("PGV (m/s),rate\n0.1,0.01\n.2,.004\n", "m/s", 1.0),
    ],
)
def test_table_is_read_from_a_file(tmp_path, text, unit, factor):
    path = tmp_path / "hazard.csv"
    path.write_text(text, encoding="utf-8")
    for given in (path, str(path)):
        curve = hazard_curve(given, unit)
        assert curve.levels == pytest.approx([0.1 * factor, 0.2 * factor], rel=1e-15)
        assert curve.rates.tolist() == [0.01, 0.004]


@pytest.mark.parametrize(
    "text, message",
    [
        (
            "PGV (cm/s),rate\n1,.1\n2,.01",
            r"^h\.csv, line 1: the levels are in cm/s; those of the fragility are in m/s²$",
        ),
        (
            "PGA (g),years\n.1,10\n.2,100",
            r"^h\.csv: hazard rates must be positive and descending, .* return period",
        ),
        ("PGA (g),rate\n.1,10,3\n", r"^h\.csv, line 2: a level and an annual rate expected; got '\.1,10,3'"),
        ("PGA (g),rate\n.1,x\n", r"^h\.csv, line 2: a rate must be a number; got 'x'"),
        ("PGA (g)\n", r"^h\.csv: no row with a level and an annual rate"),
        (".1,.1\n.1,.01\n", r"^h\.csv: hazard levels must be two positive numbers or more, ascending"),
    ],
)
def test_what_is_no_table_is_refused_with_its_line(tmp_path, text, message):
    path = tmp_path / "h.csv"
    path.write_text(text)
    with pytest.raises(rk.RecordError, match=message):
        hazard_curve(path, "m/s²")


def test_rows_of_a_table_may_have_any_order(tmp_path):
    path = tmp_path / "h.csv"
    path.write_text("\n".join(f"{x},{h}" for x, h in reversed([*zip(X, H, strict=True)])))
    order = np.random.default_rng(1).permutation(len(X))
    for given in (
        (X, H),
        (X[::-1], H[::-1]),
        (X[order], H[order]),
        dict(zip(X[::-1], H[::-1], strict=True)),
        path,
    ):
        curve = hazard_curve(given, "m/s²")
        assert curve.levels == pytest.approx(X, rel=1e-15)
        assert curve.rates == pytest.approx(H, rel=1e-15)


@pytest.mark.parametrize(
    "hazard, message",
    [
        (
            3.0,
            r"^hazard must be a pair of arrays \(levels, annual rates\), a mapping .* or the path of a CSV file; got 3\.0",
        ),
        ([X, H, H], "^hazard must be a pair of arrays"),
        ({}, "^hazard levels must be two positive numbers or more"),
        ({1.0: 0.1}, "^hazard levels must be two positive numbers or more"),
        ((X, H[:-1]), "^hazard rates must be positive and descending, one per level"),
        ((X, H[::-1]), "^hazard rates must be positive and descending"),
        ((X, np.append(H[:-1], 0.0)), "^hazard rates must be positive and descending"),
        ((X[::-1], H), "^hazard rates must be positive and descending"),
        ((X, ["a"] * 8), "^hazard rates must"),
        ((X, np.append(H[:-1], np.nan)), "^hazard rates must"),
    ],
)
def test_other_hazards_are_refused(hazard, message):
    with pytest.raises((TypeError, ValueError), match=message):
        rk.overturning_rate(drawn(), hazard)


def test_other_fragilities_are_refused():
    with pytest.raises(TypeError, match="fragility must be a Fragility"):
        rk.overturning_rate(3, (X, H))
    with pytest.raises(ValueError, match="replicates must"):
        rk.overturning_rate(drawn(), (X, H), replicates=3)
