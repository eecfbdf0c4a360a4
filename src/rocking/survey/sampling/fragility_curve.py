"""Lognormal fit of one fragility curve, with bootstrap intervals of its parameters and the band of the curve."""

from __future__ import annotations

import math

import numpy as np

from rocking.model.record_results import LognormalFit, limit_name
from rocking.survey.sampling.clustered_fractions import ENDS, weighted_counts
from rocking.survey.sampling.lognormal_fit import (
    ALL_ABOVE,
    ALL_BELOW,
    DECREASING,
    DETERMINED,
    SEPARATED,
    Fits,
    lognormal_fits,
)


def fitted(
    limit: float, levels: np.ndarray, exceeding: np.ndarray, rocking: np.ndarray, weights: np.ndarray
) -> tuple[LognormalFit, np.ndarray]:
    """Return the fit of one limit, and its curve with the ends of the band, shape (3, levels)."""
    one = lognormal_fits(levels, exceeding.sum(axis=(0, 1))[None], rocking.sum(axis=(0, 1))[None])
    problem = _problem(one, limit, len(rocking)) if levels.size > 1 else "give two levels or more"
    if problem:
        nan = math.nan
        return LognormalFit(limit, nan, nan, nan, nan, nan, nan, nan, problem), np.full(
            (3, levels.size), np.nan
        )
    median, dispersion = float(one.median[0]), float(one.dispersion[0])
    nan = math.nan
    curve = rocking.mean(axis=(0, 1)) * LognormalFit(
        limit, median, nan, nan, dispersion, nan, nan, nan
    ).probability(levels)
    rocks, exceeds = (weighted_counts(each, weights) for each in (rocking, exceeding))
    many = lognormal_fits(levels, exceeds, rocks)
    total = rocking.shape[0] * rocking.shape[1]
    # two parameters fit two levels exactly
    misfit = float(np.abs(exceeding.mean(axis=(0, 1)) - curve).max()) if levels.size > 2 else math.nan
    count = rocking.shape[0]
    band = _band(levels, many, exceeds / total, rocks / total, _tails(count))
    ends = (
        log_basic_interval(median, many.median_bounds, count),
        log_basic_interval(dispersion, many.dispersion_bounds, count),
    )
    return LognormalFit(limit, median, *ends[0], dispersion, *ends[1], misfit), np.array([curve, *band])


def _band(
    levels: np.ndarray, many: Fits, exceeding: np.ndarray, rocking: np.ndarray, tails: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the percentiles of the curves of all replicates at each level."""
    from scipy.special import ndtr

    found, falling = (many.kind[:, None] == kind for kind in (DETERMINED, DECREASING))
    scores = np.log(levels / many.median[:, None]) / many.dispersion[:, None]
    # the limit of the fit is the fraction itself, where no maximum is finite
    curves = np.where(found, rocking * ndtr(scores), exceeding)
    return (
        np.quantile(np.where(falling, 0.0, curves), tails[0], axis=0),
        np.quantile(np.where(falling, rocking, curves), tails[1], axis=0),
    )


def _tails(records: int) -> tuple[float, float]:
    """Return the probabilities of the percentiles of a bootstrap, wider for few records: Hesterberg (2015)."""
    from scipy.special import ndtr, stdtrit

    reach = math.sqrt(records / (records - 1.0)) * stdtrit(records - 1.0, ENDS[1])
    return float(ndtr(-reach)), float(ndtr(reach))


def log_basic_interval(
    estimate: float, bounds: tuple[np.ndarray, np.ndarray], records: int
) -> tuple[float, float]:
    """Return the basic bootstrap interval of the logarithm of a parameter.

    A replicate without a fit gives only bounds of the parameter: it counts with the bound that widens the interval.
    """
    low, high = np.sort(bounds[0]), np.sort(bounds[1])
    last, tails = low.size - 1, _tails(records)
    least, most = float(low[math.floor(tails[0] * last)]), float(high[math.ceil(tails[1] * last)])
    return (
        0.0 if math.isinf(most) else estimate * (estimate / most),
        math.inf if least == 0.0 else estimate * (estimate / least),
    )


def _problem(fit: Fits, limit: float, records: int) -> str:
    """Return the reason why the data do not determine a fit, or nothing."""
    kind = int(fit.kind[0])
    if records == 1 and kind == DETERMINED:
        return "one record shows no scatter between records: give several"
    event = limit_name(limit)
    return {
        DETERMINED: "",
        ALL_BELOW: f"no run shows {event}: add higher levels",
        ALL_ABOVE: f"all runs that rock show {event}: add lower levels",
        SEPARATED: f"levels with and without {event} overlap at one level at most: add levels there",
        DECREASING: f"the fraction of {event} does not grow with the level: add levels or records",
    }[kind]
