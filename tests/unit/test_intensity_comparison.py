"""Comparison of intensity measures: lognormal fits and p-values against SciPy, bounds, and the table of each format."""

import math
import re

import numpy as np
import pytest
from scipy import stats

import rocking as rk
from rocking.survey.censored_fit import Censored, regression, slope_p_value

BLOCK = rk.Block(2.0, 0.5)
RECORDS = rk.RecordSet(
    rk.synthetic_ground_motions(12, seed=4),
    columns={
        "magnitude": np.linspace(6.0, 7.1, 12),
        "distance": [*np.linspace(5.0, 50.0, 11), np.nan],
        "one": np.ones(12),
        "own": np.geomspace(1.0, 3.0, 12),
    },
)
POWER = {"arias": 2}
MEASURES = ["pga", "pgv", "arias", "cav", "sa(0.5)", "sa-avg(0.5, 1)", "pga-ratio", "pgv-ratio", "own"]


LEVELS = np.linspace(0.8, 4.0, 65)


@pytest.fixture(scope="module")
def overturning():
    return rk.overturning_set(RECORDS, BLOCK, LEVELS)


def switch(result, number):
    """The one switch with the same length of standing levels, and the deviation about it, by sums over a fine grid of logarithms."""
    fine = np.linspace(*np.log(result.levels[[0, -1]]), 200_001)
    falls = np.zeros(fine.size, bool)
    for low, high in result.intervals(number):
        falls |= (fine >= math.log(low)) & (fine <= math.log(high))
    steps, fine = np.diff(falls.astype(float), prepend=0.0, append=1.0), np.append(fine, fine[-1])
    mean = (steps * fine).sum()
    return mean, math.sqrt(max((steps * fine**2).sum() - mean**2, 0.0))


@pytest.fixture(scope="module")
def compared(overturning):
    return rk.compare_intensities(overturning, MEASURES)


def values_of(name):
    """The measure of each record, by the methods of a ground motion."""
    alpha, lift_off = BLOCK.frequency_parameter, 9.80665 * math.tan(BLOCK.critical_angle)
    if name == "own":
        return RECORDS.columns["own"]
    formula = {
        "pga": lambda motion: motion.pga,
        "pgv": lambda motion: motion.pgv,
        "arias": lambda motion: motion.arias_intensity,
        "cav": lambda motion: motion.cav,
        "sa(0.5)": lambda motion: motion.response_spectrum(0.5),
        "sa-avg(0.5, 1)": lambda motion: motion.average_spectrum([0.5, 1.0]),
        "pga-ratio": lambda motion: motion.pga / lift_off,
        "pgv-ratio": lambda motion: alpha * motion.pgv / lift_off,
    }[name]
    return np.array([formula(motion) for motion in RECORDS])


@pytest.mark.parametrize("name", MEASURES)
def test_row_of_a_measure_is_that_of_a_normal_sample(name, overturning, compared):
    row = compared.dataset.sel(measure=name)
    power = POWER.get(name, 1)
    assert (compared.dataset.bound == "").all()
    assert (overturning.lowest <= compared.dataset.factor.values).all()
    logarithms = power * np.log(compared.dataset.factor.values) + np.log(values_of(name))
    np.testing.assert_allclose(row.capacity, np.exp(logarithms), rtol=1e-12)
    assert float(row["median"]) == pytest.approx(math.exp(logarithms.mean()), rel=1e-9)
    assert float(row.dispersion) == pytest.approx(logarithms.std(ddof=1), rel=1e-8)
    assert float(row.factor_dispersion) == pytest.approx(logarithms.std(ddof=1) / power, rel=1e-8)
    assert float(row.dispersion_low) < float(row.dispersion) < float(row.dispersion_high)
    assert float(row.median_low) < float(row["median"]) < float(row.median_high)
    known = RECORDS.columns["distance"] > 0
    for quantity, regressor, kept in (
        ("ln_duration", np.log([motion.significant_duration for motion in RECORDS]), slice(None)),
        ("ln_pgv_to_pga", np.log([motion.pgv / motion.pga for motion in RECORDS]), slice(None)),
        ("magnitude", RECORDS.columns["magnitude"], slice(None)),
        ("distance", RECORDS.columns["distance"], known),
    ):
        expected = stats.linregress(regressor[kept], logarithms[kept]).pvalue
        assert float(row.p_value.sel(quantity=quantity)) == pytest.approx(expected, rel=1e-6)
    assert math.isnan(row.p_value.sel(quantity="one"))


def test_measures_are_sorted_and_constants_of_the_block_do_not_matter(compared):
    data = compared.dataset
    assert (np.diff(data.factor_dispersion) >= -1e-12).all()
    for one, other in (("pga", "pga-ratio"), ("pgv", "pgv-ratio")):
        assert float(data.dispersion.sel(measure=one)) == pytest.approx(
            float(data.dispersion.sel(measure=other)), rel=1e-9
        )
    assert float(data.most_efficient.sum()) == pytest.approx(1.0)
    assert "own" not in data["quantity"].values


def test_switch_of_a_record_has_the_moments_of_its_switches(overturning, compared):
    expected = [switch(overturning, number) for number in range(12)]
    found = np.transpose([np.log(compared.dataset.factor), compared.dataset.within])
    np.testing.assert_allclose(
        found, expected, atol=2e-3
    )  # each end of an interval is rounded to the grid, 8e-6
    within = math.sqrt(np.mean(compared.dataset.within.values**2))
    assert compared.dataset.attrs["within_dispersion"] == pytest.approx(within)


def test_mean_and_variance_are_those_of_the_mean_fraction(overturning, compared):
    """∫(1 − F) d ln s and its second moment, with the mean F of the fractions over the records."""
    fine = np.linspace(*np.log(LEVELS[[0, -1]]), 50_001)
    falls = np.zeros((12, fine.size))
    for number in range(12):
        for low, high in overturning.intervals(number):
            falls[number] += (fine >= math.log(low)) & (fine <= math.log(high))
    steps = np.diff(falls.mean(axis=0), prepend=0.0)
    mean = (steps * fine).sum()
    variance = (steps * fine**2).sum() - mean**2
    places, within = np.log(compared.dataset.factor.values), compared.dataset.attrs["within_dispersion"]
    assert mean == pytest.approx(places.mean(), abs=1e-3)
    assert variance == pytest.approx(places.var() + within**2, rel=1e-2)


def test_one_switch_is_its_own_level():
    """A push of one sign has one switch, so the level is the lowest overturning one, to its last digits."""
    pushes = [
        rk.GroundMotion([1.0, 1.0, 0.0], step=step, name=f"{step} s") for step in np.linspace(0.3, 0.6, 6)
    ]
    levels = rk.overturning_set(pushes, BLOCK, np.linspace(1.0, 20.0, 20), intensity="pga")
    result = rk.compare_intensities(levels, ["pga"]).dataset
    np.testing.assert_allclose(result.capacity.sel(measure="pga"), levels.lowest, rtol=1e-12)
    np.testing.assert_allclose(result.within, 0.0, atol=1e-7)


def test_levels_of_another_measure_give_nearly_the_same_table(overturning, compared):
    levels = rk.overturning_set(RECORDS, BLOCK, np.linspace(2.4, 12.0, 161), intensity="pga")
    other = rk.compare_intensities(levels, MEASURES).dataset
    # the grids find other narrow intervals, so that the lowest levels differ by up to a fifth, and the switches by 0.07
    assert np.max(overturning.lowest / (levels.lowest / 3.0)) > 1.15
    np.testing.assert_allclose(np.log(other.factor), np.log(compared.dataset.factor), atol=0.08)
    for name in MEASURES:
        found, expected = (each.dispersion.sel(measure=name) for each in (other, compared.dataset))
        assert float(found) == pytest.approx(float(expected), rel=0.1)


def test_records_beyond_the_levels_count_with_their_bounds(overturning, compared):
    places = np.sort(compared.dataset.factor.values)
    first, last = 0.9 * places[2], 1.2 * places[-3]
    levels = rk.overturning_set(RECORDS, BLOCK, np.linspace(first, last, 9))
    result = rk.compare_intensities(levels, ["pga"])
    bound = result.dataset.bound.values
    stands, falls = ~levels.overturned[:, -1], levels.overturned[:, 0]
    assert stands.any()
    assert (falls & ~stands).any()
    assert bound.tolist() == np.select([stands, falls], ["at least", "at most"], "").tolist()
    known = bound == ""
    level = np.array([switch(levels, number)[0] for number in range(12)]) + np.log(values_of("pga"))
    data = stats.CensoredData(
        uncensored=level[known], left=level[bound == "at most"], right=level[bound == "at least"]
    )
    mean, deviation = stats.norm.fit(data)
    row = result.dataset.sel(measure="pga")
    assert float(row["median"]) == pytest.approx(math.exp(mean), rel=1e-3)
    m = known.sum()
    assert float(row.dispersion) == pytest.approx(deviation * math.sqrt(m / (m - 1)), rel=1e-2)
    counts = (bound == "at least").sum(), (bound == "at most").sum()
    assert f"12 records, {counts[0]} above the levels, {counts[1]} below the levels;" in str(result)


def test_table_is_one_for_all_measures_with_a_column_for_each_quantity(compared):
    frame = compared.to_dataframe()
    assert frame["measure"].tolist() == compared.dataset.measure.values.tolist()
    assert [name for name in frame if name.startswith("p_")] == [
        "p_ln_duration", "p_ln_pgv_to_pga", "p_magnitude", "p_distance", "p_one",
    ]  # fmt: skip
    assert frame["symbol"].tolist()[0] in str(compared).splitlines()[2]
    rows = str(compared).splitlines()[2:-1]
    assert len(rows) == len(MEASURES)
    assert all(row.endswith("–") for row in rows)  # no p-value against a constant
    written = compared.to_dict()
    assert len(written["measure"]) == len(MEASURES)
    assert written["measure"][0]["p_one"] is None


def test_seed_decides_the_intervals_and_nothing_else(overturning, compared):
    again, other = (rk.compare_intensities(overturning, MEASURES, seed=seed).dataset for seed in (0, 1))
    np.testing.assert_array_equal(again.dispersion_high, compared.dataset.dispersion_high)
    assert (other.dispersion_high != again.dispersion_high).any()
    np.testing.assert_array_equal(other.dispersion, again.dispersion)


def few():
    return rk.overturning_set(RECORDS, BLOCK, [0.1, 0.2])


@pytest.mark.parametrize(
    "change, error, message",
    [
        ({"overturning": RECORDS}, TypeError, "overturning must be an OverturningSet"),
        ({"measures": "pga"}, TypeError, "measures must be a list of names; got 'pga'"),
        ({"measures": []}, ValueError, "measures must name one measure at least"),
        ({"measures": ["pgx"]}, ValueError, "intensity must be one of 'scale', 'pga', "),
        ({"measures": ["sa(0)"]}, ValueError, "the period of intensity 'sa(0)' must lie in"),
        (
            {"measures": ["distance"]},
            ValueError,
            "intensity 'distance' must be positive for each record, unlike",
        ),
        (
            {"against": ["pgv"]},
            ValueError,
            "against must be one of 'ln_duration', 'ln_pgv_to_pga', 'magnitude', ",
        ),
        ({"against": "magnitude"}, TypeError, "against must be a list of names; got 'magnitude'"),
        ({"replicates": 10}, ValueError, "replicates must "),
        ({"seed": -1}, ValueError, "seed must "),
    ],
)
def test_wrong_argument_is_refused_in_one_line(change, error, message, overturning):
    with pytest.raises(error, match=f"^{re.escape(message)}") as caught:
        rk.compare_intensities(**({"overturning": overturning} | change))
    assert "\n" not in str(caught.value)


def test_levels_that_overturn_too_few_are_refused():
    message = "overturning must hold levels between which 5 records at least switch from standing to overturning; got 0 "
    with pytest.raises(ValueError, match=f"^{message}"):
        rk.compare_intensities(few())


def test_copies_of_a_record_are_refused():
    both = rk.overturning_set(RECORDS, BLOCK, [1.0, 2.0], polarity="both")
    with pytest.raises(
        ValueError, match=r"^records must hold independent motions; got 'synthetic 1 reversed, "
    ):
        rk.compare_intensities(both)


# The regression with bounds.


def sample(seed, count=60, deviation=0.4):
    random = np.random.default_rng(seed)
    return random.normal(3.0, deviation, count), random.normal(size=count)


def cut(values, low=-np.inf, high=np.inf):
    return Censored(np.clip(values, low, high), values > high, values < low)


def test_regression_without_bounds_is_that_of_least_squares():
    values, regressor = sample(1)
    line = np.column_stack([np.ones(60), regressor])
    found = regression(cut(values), line, np.ones((1, 60)))
    expected, rest, *_ = np.linalg.lstsq(line, values, rcond=None)
    np.testing.assert_allclose(found.coefficients[0], expected, rtol=1e-10)
    assert found.deviation[0] == pytest.approx(math.sqrt(rest[0] / 60), rel=1e-10)
    residuals = values - line @ expected
    assert found.likelihood[0] == pytest.approx(stats.norm.logpdf(residuals, 0, found.deviation[0]).sum())
    assert slope_p_value(cut(values), regressor) == pytest.approx(
        stats.linregress(regressor, values).pvalue, rel=1e-8
    )


@pytest.mark.parametrize("low, high", [(-np.inf, 3.2), (2.8, np.inf), (2.6, 3.4), (2.9, 3.1)])
def test_regression_with_bounds_maximises_the_likelihood(low, high):
    values, regressor = sample(2)
    data, line = cut(values, low, high), np.column_stack([np.ones(60), regressor])
    found = regression(data, line, np.ones((1, 60)))

    def likelihood(first, slope, deviation):
        mean = first + slope * regressor
        total = stats.norm.logpdf(data.values[data.seen], mean[data.seen], deviation).sum()
        total += stats.norm.logsf(data.values[data.above], mean[data.above], deviation).sum()
        return total + stats.norm.logcdf(data.values[data.below], mean[data.below], deviation).sum()

    best = np.array([*found.coefficients[0], found.deviation[0]])
    assert found.likelihood[0] == pytest.approx(likelihood(*best), rel=1e-10)
    for place in range(3):
        for step in (-1e-3, 1e-3):
            other = best.copy()
            other[place] += step
            assert likelihood(*other) < found.likelihood[0]


def test_weights_are_repetitions():
    values, _ = sample(3, 20)
    data, ones = cut(values, 2.6, 3.4), np.ones((20, 1))
    weights = np.random.default_rng(5).multinomial(20, np.full(20, 0.05), 30)
    found = regression(data, ones, weights)
    for row, (mean, deviation) in enumerate(zip(found.coefficients[:, 0], found.deviation, strict=True)):
        repeated = data.chosen(np.repeat(np.arange(20), weights[row]))
        alone = regression(repeated, ones, np.ones((1, 20)))
        assert (mean, deviation) == pytest.approx((alone.coefficients[0, 0], alone.deviation[0]), rel=1e-7)


def test_values_that_determine_no_deviation_give_nan():
    values = np.array([1.0, 2.0, 3.0, 4.0])
    ones = np.ones((4, 1))
    data = cut(values, high=2.5)
    weights = np.array([[1, 1, 1, 1], [1, 0, 2, 1], [0, 0, 2, 2], [2, 2, 0, 0]])
    assert np.isnan(regression(data, ones, weights).deviation).tolist() == [False, True, True, False]
    assert math.isnan(slope_p_value(data, np.arange(4.0)))
    assert math.isnan(slope_p_value(cut(values), np.full(4, 7.0)))
    assert math.isnan(slope_p_value(cut(values), np.full(4, np.nan)))


@pytest.mark.parametrize("high, seed", [(np.inf, 1), (3.25, 2), (3.0, 3)])
def test_p_values_of_unrelated_quantities_are_uniform(high, seed):
    random = np.random.default_rng(seed)
    found = np.array(
        [
            slope_p_value(cut(random.normal(3.0, 0.4, 40), high=high), random.normal(size=40))
            for _ in range(1_000)
        ]
    )
    # shares with their deviations: .05 ± .007, .5 ± .016
    assert (found < 0.05).mean() == pytest.approx(0.05, abs=0.02)
    assert (found < 0.5).mean() == pytest.approx(0.5, abs=0.05)


def test_p_value_of_a_strong_relation_is_small():
    values, regressor = sample(6)
    assert slope_p_value(cut(values + 0.5 * regressor, 2.5, 3.5), regressor) < 1e-6
