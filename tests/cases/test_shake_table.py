"""The example that is judged by experiment: its Bayesian model against plain sums, its files, and its score on the measured tests."""

import math
import runpy
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.stats import norm

ROOT = Path(__file__).parents[2]
EXAMPLE = runpy.run_path(str(ROOT / "examples" / "shake_table.py"))
DATA = ROOT.parent / "shared" / "experiments"
measured = pytest.mark.skipif(not (DATA / "granite.csv").exists(), reason="file absent")
FACTORS, OF_MOTIONS, OF_TESTS = (EXAMPLE[name] for name in ("FACTORS", "OF_MOTIONS", "OF_TESTS"))
STRENGTHS = np.flatnonzero(EXAMPLE["CENTRES"])


def invented(motions=8, levels=6, seed=0):
    """Tests of blocks that fall above a factor, which differs from shape to shape and from motion to motion."""
    random = np.random.default_rng(seed)
    names = np.repeat([f"RSN{number}" for number in range(motions)], levels)
    strength = np.tile(np.linspace(-1.0, 1.0, levels), motions)
    own = np.repeat(random.normal(0.0, 0.2, motions), levels)
    shapes = np.array([-0.4, 0.0, 0.5])
    falls = (shapes[:, None] - strength - own)[:, :, None] < FACTORS
    tests = pd.DataFrame({"test": np.arange(names.size), "motion": names, "pga_g": np.exp(strength)})
    tests["pgv_over_pga_s"] = random.uniform(0.03, 0.1, names.size)
    tests["measured_pgv"] = tests.pga_g * tests.pgv_over_pga_s
    for rock in (1, 2):
        tests[f"overturned_{rock}"] = (strength + random.normal(0.0, 0.3, names.size) > 0.1).astype(int)
        tests[f"dem_{rock}"] = (strength > 0.0).astype(int)
    return tests, falls


def cells(centre, deviation):
    """Return the probabilities of the factors for a normal deviation about a centre."""
    edges = [-math.inf, *((FACTORS[1:] + FACTORS[:-1]) / 2), math.inf]
    return np.diff(norm.cdf(edges, loc=centre, scale=deviation))


def test_the_posterior_is_that_of_plain_sums():
    """Each motion is weighted by the sum over its own deviation, of the product over its tests."""
    tests, falls = invented(motions=3, levels=3)
    falls, motions = falls[:2], tests.motion.values
    outcomes = np.where(motions == "RSN2", np.nan, tests.overturned_1.values.astype(float))
    weights = EXAMPLE["Ensemble"](falls).posterior(outcomes, motions)
    expected = np.zeros_like(weights)
    # two deviations and five strengths, of all that there are; each weight is relative to the first
    chosen = list(product((0, 2), (0, 3), (0, 1), STRENGTHS[::3].tolist()))
    for test, motion, shape, strength in chosen:
        total = math.exp(-((FACTORS[strength] / 0.5) ** 2) / 2)
        for name in ("RSN0", "RSN1"):
            of_motion = 0.0
            for chance, centre in zip(cells(FACTORS[strength], OF_MOTIONS[motion]), FACTORS, strict=True):
                likelihood = chance
                for number in np.flatnonzero(motions == name):
                    falling = float((cells(centre, OF_TESTS[test]) * falls[shape, number]).sum())
                    falling = 0.01 + 0.98 * falling
                    likelihood *= falling if outcomes[number] else 1 - falling
                of_motion += likelihood
            total *= of_motion
        expected[test, motion, shape, strength] = total
    first = chosen[0]
    for each in chosen:
        assert weights[each] / weights[first] == pytest.approx(
            expected[each] / expected[first], rel=1e-9, abs=0
        )
    assert weights.sum() == pytest.approx(1.0, rel=1e-12)
    assert weights.sum(axis=(0, 1, 2))[~EXAMPLE["CENTRES"]].max() == 0.0


def test_no_prediction_depends_on_an_outcome_that_was_held_out():
    tests, falls = invented()
    ensemble = EXAMPLE["Ensemble"](falls)
    one = EXAMPLE["predict"](tests, 1, ensemble)
    assert not set(tests.motion[one.known]) & set(tests.motion[~one.known])
    assert tests.motion[one.known].nunique() == tests.motion[~one.known].nunique() == 4
    changed = tests.assign(overturned_1=np.where(one.known, tests.overturned_1, 1 - tests.overturned_1))
    other = EXAMPLE["predict"](changed, 1, ensemble)
    for name in one.rules:
        np.testing.assert_array_equal(one.rules[name], other.rules[name])
    np.testing.assert_array_equal(one.share, other.share)
    changed = tests.assign(overturned_1=np.where(one.known, 1 - tests.overturned_1, tests.overturned_1))
    other = EXAMPLE["predict"](changed, 1, ensemble)
    assert all(
        (one.rules[name] != other.rules[name]).any() for name in ("block", "PGV", "PGA and PGV", "constant")
    )


def test_a_block_of_one_strength_falls_with_the_probability_of_both_deviations():
    """Its share is 0, because it stands without them."""
    ensemble = EXAMPLE["Ensemble"]((FACTORS > 0.3)[None, None])
    weights = np.zeros((len(OF_TESTS), len(OF_MOTIONS), 1, FACTORS.size))
    weights[1, 0, 0, FACTORS.size // 2] = 1.0
    probability, share = ensemble.probabilities(weights)
    edge = FACTORS[np.argmax(FACTORS > 0.3)] - 0.075
    falling = (cells(0.0, OF_MOTIONS[0]) * norm.sf((edge - FACTORS) / OF_TESTS[1])).sum()
    assert share.tolist() == [0.0]
    assert float(probability[0]) == pytest.approx(0.01 + 0.98 * falling, rel=1e-12)


def test_interval_of_independent_tests_is_that_of_the_binomial_distribution():
    random = np.random.default_rng(3)
    right = (random.random(900) < 0.3).astype(float)
    share, low, high = EXAMPLE["ratio"](right, np.ones(900), np.arange(900))
    assert share == right.mean()
    assert (high - low) / 2 == pytest.approx(1.96 * math.sqrt(share * (1 - share) / 900), rel=0.1)


def test_interval_of_motions_whose_tests_agree_is_that_of_the_motions():
    random = np.random.default_rng(3)
    right = np.repeat(random.random(100) < 0.3, 9).astype(float)
    share, low, high = EXAMPLE["ratio"](right, np.ones(900), np.repeat(np.arange(100), 9))
    assert (high - low) / 2 == pytest.approx(1.96 * math.sqrt(share * (1 - share) / 100), rel=0.1)


def test_files_of_the_described_form_are_read_and_scored(tmp_path, monkeypatch, capsys):
    tests, _ = invented(levels=3)
    tests.drop(columns="measured_pgv").to_csv(tmp_path / "granite.csv", index=False)
    random = np.random.default_rng(0)
    traces = {
        str(test): np.round(5000 * pga * random.normal(0.0, 0.2, 400)).astype(np.int16)
        for test, pga in zip(tests.test, tests.pga_g, strict=True)
    }
    np.savez(tmp_path / "granite.npz", **traces)
    _, records = EXAMPLE["read"](tmp_path)
    assert records[3].acceleration.tolist() == pytest.approx(
        (traces["3"] * 2e-4 * 9.80665).tolist(), rel=1e-15
    )
    assert records[3].step == 0.005
    shapes = EXAMPLE["shapes"]
    monkeypatch.setitem(EXAMPLE["main"].__globals__, "shapes", lambda rock: shapes(rock, 3))
    monkeypatch.setitem(EXAMPLE["main"].__globals__, "OTHER_SEEDS", range(2))
    EXAMPLE["main"](tmp_path, tmp_path / "figure.png")
    printed = capsys.readouterr().out
    assert "1,656 slender runs" in printed
    assert printed.count("12 tests of 4 motions held out") == 2
    assert (tmp_path / "figure.png").stat().st_size > 10_000


@pytest.mark.parametrize("rock", [1, 2])
def test_shapes_have_the_deviations_of_the_prior(rock):
    blocks = EXAMPLE["shapes"](rock, 200)
    heights = np.log([block.centre_height for block in blocks])
    gyrations = np.log([block.radius_of_gyration / block.centre_height for block in blocks])
    tangents = np.log(np.tan([block.critical_angles for block in blocks]))
    kept = np.array([(block.restitution, block.left_restitution) for block in blocks])
    of_height, of_gyration = {1: (0.05, 0.05), 2: (0.3, 0.1)}[rock]
    assert [heights.mean(), heights.std()] == pytest.approx([math.log(0.29), of_height], abs=0.01)
    assert [gyrations.mean(), gyrations.std()] == pytest.approx(
        [math.log(0.23 / 0.29), of_gyration], abs=0.01
    )
    assert tangents.mean(axis=1) == pytest.approx(math.log(0.2), abs=1e-9)
    assert (tangents[:, 0] - tangents[:, 1]).std() == pytest.approx(0.4, abs=0.01)
    assert (kept[:, 0] == kept[:, 1]).all()
    assert [kept.min(), kept.max(), kept.mean()] == pytest.approx([0.7, 1.0, 0.85], abs=0.002)


@measured
@pytest.mark.parametrize(("rock", "of_dem", "of_limit"), [(1, 0.854, 0.978), (2, 0.913, 0.988)])
def test_other_predictors_have_the_known_accuracy_on_all_tests(rock, of_dem, of_limit):
    """The authors' model, and the best threshold of each motion, which no prediction from PGA can exceed."""
    tests, _ = EXAMPLE["read"](DATA)
    outcomes = tests[f"overturned_{rock}"]
    assert (tests[f"dem_{rock}"] == outcomes).mean() == pytest.approx(of_dem, abs=5e-4)
    right = 0
    for _, own in tests.groupby("motion"):
        thresholds = [-1.0, *own.pga_g]
        right += max(((own.pga_g > each) == (own[f"overturned_{rock}"] == 1)).sum() for each in thresholds)
    assert right / len(tests) == pytest.approx(of_limit, abs=5e-4)
    pgv = np.log(tests.pga_g * tests.pgv_over_pga_s).values[:, None]
    known = np.ones(len(tests), bool)
    rule = EXAMPLE["logistic"](pgv, outcomes.values.astype(float), known)
    assert ((rule - outcomes) ** 2).mean() == pytest.approx(0.0812, abs=0.0015)


@measured
def test_few_shapes_predict_better_than_a_constant_on_motions_held_out():
    tests, records = EXAMPLE["read"](DATA)
    falls = EXAMPLE["overturned"](records, EXAMPLE["shapes"](1, 3), "slender")
    rows = {
        what: value
        for what, value, *_ in EXAMPLE["scores"](
            tests, 1, EXAMPLE["predict"](tests, 1, EXAMPLE["Ensemble"](falls))
        )
    }
    assert rows["Brier score, block"] < rows["Brier score, constant"] / 2


# Of 176 tests of 17 motions, as the page states: accuracy and Brier score of block, PGV rule and distinct-element model, and share and
# accuracy of the certain tests.
SCORES = {
    1: [(0.909, 0.869, 0.841), (0.069, 0.090, 0.159), (0.790, 0.950)],
    2: [(0.915, 0.898, 0.915), (0.052, 0.071, 0.085), (0.750, 1.000)],
}


@measured
@pytest.mark.long
@pytest.mark.timeout(1_800)
@pytest.mark.parametrize("rock", [1, 2])
def test_score_is_that_of_the_page(rock):
    tests, records = EXAMPLE["read"](DATA)
    ensemble = EXAMPLE["Ensemble"](EXAMPLE["overturned"](records, EXAMPLE["shapes"](rock), "slender"))
    prediction = EXAMPLE["predict"](tests, rock, ensemble)
    rows = {what: value for what, value, *_ in EXAMPLE["scores"](tests, rock, prediction)}
    names = ("block", "PGV", "DEM")
    found = [[rows[f"{what}, {name}"] for name in names] for what in ("accuracy", "Brier score")]
    found.append([rows["share of certain tests"], rows["accuracy, certain tests"]])
    for values, stated in zip(found, SCORES[rock], strict=True):
        assert values == pytest.approx(stated, abs=5.1e-4)
