"""Judged by experiment: the overturning of two granite rocks on a shake table, predicted on motions held out.

The measured motions and outcomes are those of Chen et al. (2024), in two files that are not part of the package: ``granite.csv`` and
``granite.npz``. The page "Judged by experiment" states the model, the prior, the split and the scores. They were fixed before the first
score. Run ``python examples/shake_table.py DATA [FILE] [--full]`` with the folder of the files. It prints the scores, and writes the
figure to FILE. Default: ``shake-table.png`` in the current folder. With ``--full`` the blocks follow the full equation of motion.
"""

import argparse
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.optimize import minimize
from scipy.signal import butter, sosfiltfilt
from scipy.special import expit, logsumexp, ndtr, ndtri
from scipy.stats import qmc

import rocking as rk

SEED, OTHER_SEEDS, REPLICATES = 2021, range(40), 2_000
STEP, UNIT = 0.005, 2e-4 * 9.80665
"""Time step of the traces in s, and their unit in m/s²."""
SHAPES, TANGENT = 136, 0.2
FACTORS = np.linspace(-1.65, 1.65, 23)
"""Logarithms of the factors of the motion: −ln c for a block of strength c."""
CENTRES = np.abs(FACTORS) < 1.0
STRENGTH, ASYMMETRY, RESTITUTION = 0.5, 0.4, (0.7, 1.0)
HEIGHT, GYRATION = 0.29, 0.23 / 0.29
SPREADS = {1: (0.05, 0.05), 2: (0.3, 0.1)}
"""Deviations of ln h and ln(k/h) of each rock."""
OF_MOTIONS, OF_TESTS = (0.1, 0.2, 0.3, 0.45), (0.1, 0.2, 0.3)
"""Deviations of ln c from motion to motion, and from test to test."""
UNEXPLAINED, AGREEMENT = 0.01, 0.95
CORNER = 0.4
"""Corner of the filter before a measured acceleration is integrated, Hz. It was added after the score, for the measured PGV."""
BINS = np.array([0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0])


def read(folder):
    """Return the table of the tests, and their measured motions."""
    tests = pd.read_csv(Path(folder) / "granite.csv")
    with np.load(Path(folder) / "granite.npz") as traces:
        motions = [
            rk.GroundMotion(traces[name] * UNIT, step=STEP, name=name) for name in tests.test.astype(str)
        ]
    tests["measured_pgv"] = [measured_pgv(motion) for motion in motions]
    return tests, rk.RecordSet(motions)


def measured_pgv(motion):
    """Return the largest velocity in m/s of a trace without its slow drift."""
    passed = sosfiltfilt(butter(4, CORNER, "high", fs=1 / STEP, output="sos"), motion.acceleration)
    return rk.GroundMotion(passed, step=STEP).pgv


def shapes(rock, count=SHAPES):
    """Return blocks of mean strength 1, drawn from the prior."""
    places = qmc.LatinHypercube(4, seed=SEED + rock).random(count)
    asymmetry, height, gyration = ndtri(places[:, :3]).T * [[ASYMMETRY], *np.vstack(SPREADS[rock])]
    blocks = []
    for d, h, k, e in zip(
        asymmetry, HEIGHT * np.exp(height), GYRATION * np.exp(gyration), places[:, 3], strict=True
    ):
        right, left = h * TANGENT * np.exp(d / 2), h * TANGENT * np.exp(-d / 2)
        blocks.append(
            rk.Block(
                2 * h,
                right + left,
                np.interp(e, (0, 1), RESTITUTION),
                offset=(left - right) / 2,
                radius_of_gyration=k * h,
            )
        )
    return blocks


def overturned(records, blocks, model):
    """Return whether each block overturns in each test at each factor of the motion, shape (blocks, tests, factors)."""
    fallen = list(rk.Outcome).index(rk.Outcome.OVERTURNED)
    runs = (rk.rocking_spectrum(records, block, np.exp(FACTORS), model=model) for block in blocks)
    return np.array([each.dataset.outcome.values == fallen for each in runs])


def spread(deviation):
    """Return the probabilities of the factors (to) about each factor (from), for normal deviations of their logarithms."""
    edges = np.concatenate(([-np.inf], (FACTORS[1:] + FACTORS[:-1]) / 2, [np.inf]))
    return np.diff(ndtr((edges - FACTORS[:, None]) / deviation))


class Ensemble:
    """Blocks with their outcomes in all tests, and the probabilities that follow from the outcomes of some.

    The parameters are (deviation from test to test, deviation from motion to motion, shape, strength).
    """

    def __init__(self, falls):
        self.falls = falls.astype(float)
        self.by_test = np.array([self.falls @ spread(each).T for each in OF_TESTS])
        self.by_motion = np.array([spread(each) for each in OF_MOTIONS])
        prior = np.where(CENTRES, -((FACTORS / STRENGTH) ** 2) / 2, -np.inf)
        self.prior = prior - logsumexp(prior)

    def posterior(self, outcomes, motions):
        """Return the weights of the parameters; `outcomes` are NaN where they are not known."""
        probability = UNEXPLAINED + (1 - 2 * UNEXPLAINED) * self.by_test
        known = np.isfinite(outcomes)
        right = np.where((outcomes == 1)[:, None], np.log(probability), np.log1p(-probability))[:, :, known]
        total = np.zeros((len(OF_TESTS), len(OF_MOTIONS), *self.falls.shape[::2])) + self.prior
        for motion in np.unique(motions[known]):
            likelihood = np.exp(right[:, :, motions[known] == motion].sum(axis=2))
            with np.errstate(divide="ignore"):
                total += np.log(np.einsum("tsz,mcz->tmsc", likelihood, self.by_motion))
        return np.exp(total - logsumexp(total))

    def probabilities(self, weights):
        """Return the probability that the rock overturns in each test, and the share of the blocks that overturn."""
        at = np.einsum("tmsc,mcz->tsz", weights, self.by_motion)
        probability = np.einsum("tsz,tsnz->n", at, self.by_test)
        share = np.einsum("sc,snc->n", weights.sum(axis=(0, 1)), self.falls)
        return UNEXPLAINED + (1 - 2 * UNEXPLAINED) * probability, share


def logistic(features, outcomes, known):
    """Return the probabilities of the rule whose likelihood of the known outcomes is largest, linear in the features."""
    columns = np.column_stack([np.ones(len(features)), features - features.mean(axis=0)])
    signs = 1 - 2 * outcomes[known]
    fit = minimize(lambda b: np.logaddexp(0, signs * (columns[known] @ b)).sum(), np.zeros(columns.shape[1]))
    return expit(columns @ fit.x)


class Prediction(NamedTuple):
    """Predictions of all tests, and the tests that were known."""

    rules: dict
    share: np.ndarray
    known: np.ndarray
    weights: np.ndarray


def predict(tests, rock, ensemble, seed=SEED):
    """Return the predictions for one rock from half of the motions."""
    names = np.unique(tests.motion)
    chosen = np.random.default_rng(seed).permutation(names)[: len(names) // 2]
    known = tests.motion.isin(chosen).values
    outcomes = tests[f"overturned_{rock}"].values.astype(float)
    weights = ensemble.posterior(np.where(known, outcomes, np.nan), tests.motion.values)
    probability, share = ensemble.probabilities(weights)
    pga, pgv = np.log(tests.pga_g.values), np.log(tests.pga_g.values * tests.pgv_over_pga_s.values)
    rules = {
        "block": probability,
        "PGV": logistic(pgv[:, None], outcomes, known),
        "PGA and PGV": logistic(np.column_stack([pga, pgv]), outcomes, known),
        "DEM": tests[f"dem_{rock}"].values.astype(float),
        "measured PGV": logistic(np.log(tests.measured_pgv.values)[:, None], outcomes, known),
        "constant": np.full(len(tests), outcomes[known].mean()),
    }
    return Prediction(rules, share, known, weights)


def ratio(numerator, denominator, motions):
    """Return a ratio of sums over tests, and the 95 % interval of a bootstrap of the motions."""
    numbers, places = np.unique(motions, return_inverse=True)
    draws = np.random.default_rng(SEED).multinomial(
        len(numbers), np.full(len(numbers), 1 / len(numbers)), REPLICATES
    )
    over, under = (draws @ np.bincount(places, each, len(numbers)) for each in (numerator, denominator))
    low, high = np.percentile((over / np.where(under, under, np.nan))[under > 0], [2.5, 97.5])
    return np.sum(numerator) / np.sum(denominator), low, high


def scores(tests, rock, prediction):
    """Return rows (what, value, lower end, upper end) on the tests that were not known."""
    held = ~prediction.known
    motions, outcomes = tests.motion.values[held], tests[f"overturned_{rock}"].values[held].astype(float)
    ones = np.ones(held.sum())
    right = {name: ((each[held] > 0.5) == outcomes) * 1.0 for name, each in prediction.rules.items()}
    error = {name: (each[held] - outcomes) ** 2 for name, each in prediction.rules.items()}
    certain = np.abs(2 * prediction.share[held] - 1) >= 2 * AGREEMENT - 1
    correct = ((prediction.share[held] > 0.5) == outcomes) * 1.0
    rows = [(f"accuracy, {name}", *ratio(each, ones, motions)) for name, each in right.items()]
    rows += [(f"Brier score, {name}", *ratio(each, ones, motions)) for name, each in error.items()]
    for one, other in (("block", "PGV"), ("DEM", "PGV"), ("block", "measured PGV"), ("block", "DEM")):
        rows.append((f"accuracy, {one} − {other}", *ratio(right[one] - right[other], ones, motions)))
        rows.append((f"Brier score, {one} − {other}", *ratio(error[one] - error[other], ones, motions)))
    rows.append(("share of certain tests", *ratio(certain * 1.0, ones, motions)))
    rows.append(("accuracy, certain tests", *ratio(correct * certain, certain * 1.0, motions)))
    rows.append(("accuracy, other tests", *ratio(right["block"] * ~certain, ~certain * 1.0, motions)))
    for name in ("PGV", "DEM"):
        rows.append(
            (f"accuracy, certain tests, {name}", *ratio(right[name] * certain, certain * 1.0, motions))
        )
    return rows


def calibration(tests, rock, prediction):
    """Return rows (number of tests, mean probability, fraction that overturned, its interval), one for each bin with tests."""
    held = ~prediction.known
    motions, outcomes = tests.motion.values[held], tests[f"overturned_{rock}"].values[held]
    probability = prediction.rules["block"][held]
    places = np.digitize(probability, BINS[1:-1])
    inside = [places == number for number in np.unique(places)]
    return [
        (each.sum(), probability[each].mean(), *ratio(outcomes * each, each * 1.0, motions))
        for each in inside
    ]


COMPARED = ("block", "PGV", "measured PGV")


def other_splits(tests, rock, ensemble):
    """Return the means of accuracy and Brier score of the rules COMPARED over other splits, shape (2, 3)."""
    outcomes, found = tests[f"overturned_{rock}"].values, []
    for seed in OTHER_SEEDS:
        prediction = predict(tests, rock, ensemble, seed)
        each = np.array([prediction.rules[name] for name in COMPARED])[:, ~prediction.known]
        own = outcomes[~prediction.known]
        found.append([((each > 0.5) == own).mean(axis=1), ((each - own) ** 2).mean(axis=1)])
    return np.mean(found, axis=0)


def report(tests, rock, prediction, ensemble):
    """Print the scores, the calibration, the strengths that remain plausible, and the means over other splits."""
    held = ~prediction.known
    print(f"\nRock {rock}: {held.sum()} tests of {tests.motion[held].nunique()} motions held out")
    for what, *values in scores(tests, rock, prediction):
        print(f"  {what:32} {{:7.3f}}  [{{:.3f}}, {{:.3f}}]".format(*values))
    print("  calibration: tests, mean probability, fraction overturned [95 % interval]")
    for count, *values in calibration(tests, rock, prediction):
        print(f"    {count:3}  {{:.3f}}  {{:.3f}}  [{{:.3f}}, {{:.3f}}]".format(*values))
    over = prediction.weights.sum(axis=(0, 1, 2)).cumsum()
    low, middle, high = TANGENT * np.exp(-np.interp([0.975, 0.5, 0.025], over, FACTORS))
    print(f"  tan θcr: {middle:.3f} [{low:.3f}, {high:.3f}]")
    print(f"  independent shapes: {1 / (prediction.weights.sum(axis=(0, 1, 3)) ** 2).sum():.1f}")
    for what, values in zip(("accuracy", "Brier score"), other_splits(tests, rock, ensemble), strict=True):
        told = ", ".join(f"{name} {value:.3f}" for name, value in zip(COMPARED, values, strict=True))
        print(f"  mean of {len(OTHER_SEEDS)} other splits: {what}, {told}")


def draw(tests, predictions):
    """Draw the calibration curve of each rock, and the probability against the outcome over the PGV."""
    figure, axes = rk.plot.panels(rows=len(predictions), columns=2, height=2.6)
    for (rock, prediction), left, right in zip(predictions.items(), axes[::2], axes[1::2], strict=True):
        _, mean, fraction, low, high = np.array(calibration(tests, rock, prediction)).T
        left.plot([0, 1], [0, 1], color="#9A9A9A", linewidth=0.6)
        left.errorbar(
            mean, fraction, [fraction - low, high - fraction], fmt="o", color="#0072B2", markersize=4
        )
        left.set(xlabel="probability of overturning", ylabel="fraction overturned", xlim=(-0.03, 1.03))
        held = ~prediction.known
        pgv = (tests.pga_g * 9.80665 * tests.pgv_over_pga_s).values[held]
        fell = tests[f"overturned_{rock}"].values[held] == 1
        probability = prediction.rules["block"][held]
        for name, which, size, mark in (("stood", ~fell, 10, "o"), ("overturned", fell, 16, "x")):
            colour = "#D55E00" if mark == "x" else "#0072B2"
            right.scatter(
                pgv[which], probability[which], size, colour, marker=mark, linewidth=0.8, label=name
            )
        order = np.argsort(pgv)
        right.plot(
            pgv[order], prediction.rules["PGV"][held][order], color="#262626", linewidth=0.8, label="PGV rule"
        )
        right.set(xscale="log", xlabel="PGV (m/s)", ylabel="probability of overturning")
        for ax in (left, right):
            rk.plot.title(ax, f"rock {rock}")
            ax.set(ylim=(-0.03, 1.03))
            ax.spines[["top", "right"]].set_visible(False)
    axes[1].legend(frameon=False)
    return figure


def main(folder, file, model="slender"):
    """Print the scores of both rocks, and write the figure."""
    tests, records = read(folder)
    predictions = {}
    for rock in SPREADS:
        begun, busy = time.perf_counter(), time.process_time()
        falls = overturned(records, shapes(rock), model)
        seconds, busy = time.perf_counter() - begun, time.process_time() - busy
        print(f"{falls.size:,} {model} runs in {seconds:.0f} s, {busy:.0f} s of processor time")
        ensemble = Ensemble(falls)
        predictions[rock] = predict(tests, rock, ensemble)
        report(tests, rock, predictions[rock], ensemble)
    print(rk.plot.save(draw(tests, predictions), file))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", metavar="DATA")
    parser.add_argument("file", metavar="FILE", nargs="?", default="shake-table.png")
    parser.add_argument("--full", action="store_true", help="follow the full equation of motion")
    given = parser.parse_args()
    if not given.file.endswith((".png", ".svg", ".pdf")):
        parser.error(f"FILE must end in .png, .svg or .pdf; got {given.file!r}")
    main(given.folder, given.file, "full" if given.full else "slender")
