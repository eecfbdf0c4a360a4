"""Uncertainty exponents of basin boundaries: the fraction of states whose outcome changes under a small error."""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np
from attrs import frozen

from rocking.kernels.classify import verdict as kernel
from rocking.model.share import LEVEL, shares_of
from rocking.model.survey_results import UncertaintyExponent
from rocking.model.system import System
from rocking.survey.attractors import label_attractors
from rocking.survey.engine import Engine
from rocking.survey.measurement import Measurement
from rocking.survey.random_points import MAX_SAMPLES, sampled
from rocking.survey.spec import by_period

FINEST, COARSEST = 13, 6
"""Range of k of the distances, which are 2⁻ᵏ times the mean width of the range of initial states."""
MIN_BOUNDARY = 10
"""Minimum number of uncertain initial states at all distances for an estimate of the exponent."""
MAX_STEPS = 50


def distances(widths: tuple[float, float]) -> np.ndarray:
    """Return the tested errors ε in descending order."""
    return np.sqrt(widths[0] * widths[1]) * 0.5 ** np.arange(COARSEST, FINEST + 1)


def perturbed_triples(
    low: tuple[float, float], high: tuple[float, float], runs: int, random: np.random.Generator
) -> np.ndarray:
    """Return triples of initial states (distances, n, 3, 2): a random one and two neighbours in opposite directions.

    Each distance has its own random initial states.
    """
    reach = distances((high[0] - low[0], high[1] - low[1]))
    each = max(runs // (3 * reach.size), 1)
    middle = random.uniform(low, high, (reach.size, each, 2))
    turned = random.uniform(0.0, np.pi, (reach.size, each))
    beside = reach[:, None, None] * np.stack([np.cos(turned), np.sin(turned)], axis=-1)
    return np.stack([middle, middle - beside, middle + beside], axis=2)


def exponent(reach: np.ndarray, labels: np.ndarray) -> UncertaintyExponent | None:
    """Estimate the uncertainty exponent from the labels (distances, n, 3) of triples; None if too few are uncertain.

    The counts are binomial with log f = a + α log ε. The likelihood is maximised by Fisher's scoring. The interval
    follows from the Fisher information. It is widened by the square root of the misfit if the counts scatter more than
    binomial ones.
    """
    elsewhere = (labels[..., 1:] != labels[..., :1]).any(axis=-1)
    counts, each = elsewhere.sum(axis=1), elsewhere.shape[1]
    informative = counts < each
    if counts[informative].sum() < MIN_BOUNDARY or np.count_nonzero(counts[informative]) < 3:
        return None
    logs = np.log(reach[informative])
    design = np.column_stack([np.ones(logs.size), logs - logs.mean()])
    fitted, information = _scored(design, counts[informative].astype(float), float(each))
    shares = np.minimum(np.exp(design @ fitted), 1.0 - 1e-9)
    squares = (counts[informative] - each * shares) ** 2 / (each * shares * (1.0 - shares))
    misfit = float(squares.sum() / max(logs.size - 2, 1))
    error = float(np.sqrt(np.linalg.inv(information)[1, 1] * max(misfit, 1.0)))
    half = NormalDist().inv_cdf(0.5 + 0.5 * LEVEL) * error
    value = float(fitted[1])
    ends = value - half, value + half
    return UncertaintyExponent(value, *ends, tuple(reach.tolist()), shares_of(counts, each), misfit)


def _scored(design: np.ndarray, counts: np.ndarray, each: float) -> tuple[np.ndarray, np.ndarray]:
    """Fit a binomial model with a logarithmic link by Fisher's scoring.

    Returns
    -------
    tuple of (array (2,), array (2, 2))
        Parameters and their Fisher information.
    """
    weights = counts + 0.5
    start = np.log(weights / (each + 1.0))
    fitted = np.linalg.lstsq(design * np.sqrt(weights)[:, None], start * np.sqrt(weights), rcond=None)[0]
    for _ in range(MAX_STEPS):
        shares = np.clip(np.exp(design @ fitted), 1e-12, 1.0 - 1e-6)
        weights = each * shares / (1.0 - shares)
        information = design.T @ (design * weights[:, None])
        step = np.linalg.solve(information, design.T @ ((counts - each * shares) / (1.0 - shares)))
        fitted = fitted + step
        if np.abs(step).max() < 1e-10:
            break
    return fitted, information


Exponents = tuple[UncertaintyExponent | None, UncertaintyExponent | None]
WIDTHS = (1e-4, 1.0)
# Further runs beyond the number that the width so far suggests, and the largest factor at once: a first width is uncertain.
SPARE, AT_ONCE = 1.2, 8.0
# Largest ratio of the widths after and before more runs, of which there are at least this many as before; about one half is usual.
NARROWER, LEAST = 0.85, 2.0


@frozen
class Boundaries:
    """Boundaries of the basins of a system, in a range of initial states from ``low`` to ``high``."""

    system: System
    low: tuple[float, float]
    high: tuple[float, float]
    random: np.random.Generator
    measure: Measurement
    executor: Engine | None
    progress: bool

    def exponents(self, runs: int, width: float) -> Exponents:
        """Return the uncertainty exponents of the boundary of overturning and of all boundaries.

        Runs are added until both intervals are narrower than ``width``. Where the fractions follow no power law, further runs do
        not narrow an interval, and none are added. An exponent without enough uncertain states is None.
        """
        if runs == 0:
            return None, None
        result, starts = self._followed(runs)
        before = math.inf
        while True:
            both = self._fitted(result, starts)
            widest = max((one.high - one.low for one in both if one is not None), default=0.0)
            if widest <= width or widest > NARROWER * before or starts.size // 2 >= MAX_SAMPLES:
                return both
            before = widest
            requested = starts.size // 2 * min(max(SPARE * (widest / width) ** 2, LEAST), AT_ONCE)
            more, others = self._followed(int(min(requested, MAX_SAMPLES)) - starts.size // 2)
            joined = {
                name: _appended(result[name], more[name], starts.shape, others.shape) for name in result
            }
            result, starts = joined, np.concatenate([starts, others], axis=1)

    def _followed(self, runs: int) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """Return the results of new triples of initial states, and the states (distances, n, 3, 2)."""
        tried = perturbed_triples(self.low, self.high, runs, self.random)
        starts = tried.reshape(-1, 2)
        if self.system.braces is not None:
            starts[:, 0] = np.clip(starts[:, 0], -self.system.braces.angle, self.system.braces.angle)
        title = "boundary runs" if self.progress else ""
        drawn = {"angle": starts[:, 0], "velocity": starts[:, 1]}
        return sampled(drawn, by_period(self.system), self.measure, self.executor, title), tried

    def _fitted(self, rows: dict[str, np.ndarray], starts: np.ndarray) -> Exponents:
        labels, _ = label_attractors(self.system, rows)
        (a, c), (b, d) = self.low, self.high
        reach = distances((b - a, d - c))
        overturned = (rows["kind"] == kernel.OVERTURNS).reshape(starts.shape[:3])
        return exponent(reach, overturned), exponent(reach, labels.reshape(starts.shape[:3]))


def _appended(
    before: np.ndarray, more: np.ndarray, shape: tuple[int, ...], added: tuple[int, ...]
) -> np.ndarray:
    """Return results of triples with more of them at each distance."""
    rest = before.shape[1:]
    return np.concatenate(
        [before.reshape(*shape[:3], *rest), more.reshape(*added[:3], *rest)], axis=1
    ).reshape(-1, *rest)
