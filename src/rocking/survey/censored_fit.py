"""Regression with normal residuals, of which some values are known only to lie above or below a bound: maximum likelihood."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

MAX_STEPS, HALVINGS = 100, 40
CLOSE = 1e-10
"""Last change of the parameters, standardised, at which an iteration ends."""


class Censored(NamedTuple):
    """Values of n observations, arrays (n,)."""

    values: np.ndarray
    """Value, or its bound."""
    above: np.ndarray
    """Flag: the value is only known to be at least the bound."""
    below: np.ndarray
    """Flag: the value is only known to be at most the bound, unless it is at least the bound."""

    @property
    def seen(self) -> np.ndarray:
        """Flag: the value itself is known."""
        return ~(self.above | self.below)

    def chosen(self, places: np.ndarray) -> Censored:
        """Return some of the observations."""
        return Censored(*(each[places] for each in self))


class Regression(NamedTuple):
    """Maxima of m likelihoods; NaN where there is none, because the known values do not determine it."""

    coefficients: np.ndarray
    """Shape (m, k)."""
    deviation: np.ndarray
    """Standard deviation of the residuals, without correction for the number of coefficients; shape (m,)."""
    likelihood: np.ndarray
    """Logarithm of the largest likelihood, shape (m,)."""


def regression(data: Censored, design: np.ndarray, weights: np.ndarray) -> Regression:
    """Fit values = design · coefficients + deviation · (normal numbers) to m sets of weights.

    Parameters
    ----------
    data : Censored
        n observations.
    design : array (n, k)
        Regressors.
    weights : array (m, n)
        How often each observation counts.

    Notes
    -----
    With γ = 1/deviation and δ = γ · coefficients the log-likelihood is concave: Olsen, Econometrica 46, 1211–1215 (1978).
    Newton's method finds its maximum, with steps halved until the likelihood does not fall.
    """
    counts = np.asarray(weights, float)
    seen = counts[:, data.seen]
    kept = (seen > 0.0) & np.isfinite(data.values[data.seen])
    # as many different known values as parameters: fewer are met exactly
    lowest = np.where(kept, data.values[data.seen], np.inf).min(axis=1, initial=np.inf)
    highest = np.where(kept, data.values[data.seen], -np.inf).max(axis=1, initial=-np.inf)
    possible = (highest > lowest) & (kept.sum(axis=1) > design.shape[1])
    coefficients = np.full((len(counts), design.shape[1]), np.nan)
    deviation, likelihood = (np.full(len(counts), np.nan) for _ in range(2))
    if possible.any():
        centre, width = data.values.mean(), data.values.std()
        scaled = data._replace(values=(data.values - centre) / width)
        terms = np.column_stack([-design, scaled.values])
        found, value = _maximum(scaled, terms, counts[possible])
        deviation[possible] = width / found[:, -1]
        coefficients[possible] = width * found[:, :-1] / found[:, -1:]
        shift = np.linalg.lstsq(design, np.full(len(design), centre), rcond=None)[0]
        coefficients[possible] += shift
        likelihood[possible] = value - seen[possible].sum(axis=1) * math.log(width)
    return Regression(coefficients, deviation, likelihood)


def _maximum(data: Censored, terms: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the maxima (m, k + 1) over (δ, γ), and the log-likelihoods (m,)."""
    parameters = np.zeros((len(weights), terms.shape[1]))
    parameters[:, -1] = 1.0
    value = _likelihood(parameters, data, terms, weights)
    for _ in range(MAX_STEPS):
        step = _newton(parameters, data, terms, weights)
        length = np.ones((len(weights), 1))
        for _ in range(HALVINGS):
            tried = _likelihood(parameters + length * step, data, terms, weights)
            worse = ~(tried >= value - 1e-12 * np.abs(value))
            if not worse.any():
                break
            length[worse] *= 0.5
        length[worse] = 0.0
        parameters = parameters + length * step
        value = np.where(worse, value, tried)
        if np.abs(length * step).max() < CLOSE:
            break
    return parameters, value


def _likelihood(parameters: np.ndarray, data: Censored, terms: np.ndarray, weights: np.ndarray) -> np.ndarray:
    from scipy.special import log_ndtr

    residuals, gamma = parameters @ terms.T, parameters[:, -1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        own = np.log(gamma) - 0.5 * residuals**2 - 0.5 * math.log(2.0 * math.pi)
    each = np.where(data.seen, own, log_ndtr(np.where(data.above, -residuals, residuals)))
    return np.asarray(np.where(gamma[:, 0] > 0.0, (weights * each).sum(axis=1), -np.inf))


def _newton(parameters: np.ndarray, data: Censored, terms: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the steps of Newton's method (m, k + 1)."""
    from scipy.special import log_ndtr

    residuals, gamma = parameters @ terms.T, parameters[:, -1]
    sign = np.where(data.above, -1.0, 1.0)
    towards = sign * residuals
    ratio = np.exp(-0.5 * residuals**2 - 0.5 * math.log(2.0 * math.pi) - log_ndtr(towards))
    slope = weights * np.where(data.seen, -residuals, sign * ratio)
    bend = weights * np.where(data.seen, 1.0, ratio * (ratio + towards))
    seen = (weights * data.seen).sum(axis=1)
    gradient = slope @ terms
    gradient[:, -1] += seen / gamma
    curvature = np.einsum("mn,ni,nj->mij", bend, terms, terms)
    curvature[:, -1, -1] += seen / gamma**2
    return np.asarray(np.linalg.solve(curvature, gradient[..., None])[..., 0])


def slope_p_value(data: Censored, regressor: np.ndarray) -> float:
    """Return the p-value of the hypothesis that values do not depend on a regressor; NaN if the data say nothing about it.

    It is that of the t-test of the slope. With bounds among the values, t is that of the same ratio of likelihoods, and the
    degrees of freedom are those of the known values.
    """
    from scipy.special import stdtr

    known = np.isfinite(regressor)
    chosen, places = data.chosen(known), regressor[known]
    count = int(chosen.seen.sum())
    spread = places[chosen.seen].std() if count else 0.0
    if count < 3 or not spread > 1e-12 * np.abs(places).max():
        return math.nan
    constant = np.ones((places.size, 1))
    line = np.column_stack([constant, (places - places.mean()) / places.std()])
    once = np.ones((1, places.size))
    without, having = (regression(chosen, design, once).likelihood[0] for design in (constant, line))
    t = math.sqrt((count - 2) * math.expm1(max(2.0 * (having - without), 0.0) / count))
    return float(2.0 * stdtr(count - 2, -t))
