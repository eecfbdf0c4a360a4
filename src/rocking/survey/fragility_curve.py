"""Fragility curves: fractions clustered by record, lognormal fits by maximum likelihood, and bootstrap intervals."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from rocking.model.record_results import LognormalFit, limit_name
from rocking.model.share import LEVEL, wilson

ENDS = ((1.0 - LEVEL) / 2.0, (1.0 + LEVEL) / 2.0)
AT_ONCE = 2_000_000
"""Largest number of weights that are multiplied at once."""


class Fractions(NamedTuple):
    """Fractions with the ends of their 95 % intervals and the effective numbers of records, arrays of one shape."""

    value: np.ndarray
    low: np.ndarray
    high: np.ndarray
    effective: np.ndarray

    def columns(self, name: str, meaning: str) -> dict[str, tuple[np.ndarray, str]]:
        """Return the fraction and the ends of its interval, each with its description, by the names of the variables."""
        return {
            name: (self.value, meaning),
            f"{name}_low": (self.low, "lower end of the 95 % interval"),
            f"{name}_high": (self.high, "upper end of the 95 % interval"),
        }


def two_level_weights(records: int, samples: int, replicates: int, random: np.random.Generator) -> np.ndarray:
    """Return how often each run counts in each replicate of a two-level bootstrap, shape (replicates, records, samples).

    A replicate draws records with replacement. Each drawn record draws its own runs with replacement, independently.
    The sum over a replicate is always records × samples.
    """
    drawn = random.multinomial(records, np.full(records, 1.0 / records), size=replicates)
    if samples == 1:
        return drawn[..., None]
    return random.multinomial(drawn * samples, np.full(samples, 1.0 / samples))


def weighted_counts(runs: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the weighted number of runs with a property in each replicate.

    `runs` has the shape (records, samples, …), `weights` is that of `two_level_weights`. The result has the shape
    (replicates, …).
    """
    rows = runs.reshape(runs.shape[0] * runs.shape[1], -1).astype(float)
    flat = weights.reshape(weights.shape[0], -1)
    step = max(AT_ONCE // flat.shape[1], 1)
    parts = [flat[first : first + step].astype(float) @ rows for first in range(0, len(flat), step)]
    return np.concatenate(parts).reshape(len(flat), *runs.shape[2:])


def clustered_fractions(
    members: np.ndarray, weights: np.ndarray, undecided: np.ndarray | None = None
) -> Fractions:
    """Return fractions of runs with 95 % intervals.

    The interval is the union of two. The first is the percentile interval of the two-level bootstrap. The second is Wilson's
    with the effective number of records in place of the number of runs.

    Parameters
    ----------
    members : array of bool (records, samples, …)
        Flag: the run counts.
    weights : array (replicates, records, samples)
        Weights of the bootstrap.
    undecided : array of bool (records, samples, …), optional
        Flag: the run may or may not count. The lower end counts none of these runs, the upper end all of them.
    """
    value, low, high, effective = _interval(members, weights)
    if undecided is not None and undecided.any():
        low = _interval(members & ~undecided, weights).low
        high = _interval(members | undecided, weights).high
    return Fractions(value, low, high, effective)


def _interval(members: np.ndarray, weights: np.ndarray) -> Fractions:
    value = members.mean(axis=(0, 1))
    counts = weighted_counts(members, weights) / (members.shape[0] * members.shape[1])
    low, high = np.quantile(counts, ENDS, axis=0)
    effective = effective_records(members)
    other = wilson(np.atleast_1d(value * effective), np.atleast_1d(effective))
    lower, upper = (np.reshape(each, value.shape) for each in other)
    exact = (value == 0.0, value == 1.0)  # the product above rounds
    return Fractions(
        value,
        np.where(exact[0], 0.0, np.minimum(low, lower)),
        np.where(exact[1], 1.0, np.maximum(high, upper)),
        effective,
    )


def effective_records(members: np.ndarray) -> np.ndarray:
    """Return the number of independent records that would give the observed variance of a fraction, array (…).

    With the variance s² between the fractions pᵢ of n records, it is p(1 − p)n/s², in [1, n]. If all records agree it is n.
    """
    count = members.shape[0]
    each = members.mean(axis=1)
    value = each.mean(axis=0)
    if count == 1:
        return np.ones(value.shape)
    between = each.var(axis=0, ddof=1) / count
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(between > 0.0, value * (1.0 - value) / between, count)
    return np.clip(ratio, 1.0, count)


MAX_STEPS, HALVINGS = 60, 30
CLOSE = 1e-10
"""Last change of both parameters at which an iteration ends."""
ALL_BELOW, ALL_ABOVE, SEPARATED, DECREASING, DETERMINED = range(5)
"""No run exceeds; all runs exceed; those that exceed lie above all others; the fraction falls; a finite maximum exists."""


class Fits(NamedTuple):
    """Fits of n sets of counts, and what the counts say about both parameters; each an array (n,).

    Median and dispersion are NaN unless `kind` is DETERMINED. Bounds are equal to the estimates of a fit that is determined.
    """

    kind: np.ndarray
    median: np.ndarray
    dispersion: np.ndarray
    median_bounds: tuple[np.ndarray, np.ndarray]
    dispersion_bounds: tuple[np.ndarray, np.ndarray]


def lognormal_fits(levels: np.ndarray, exceeding: np.ndarray, rocking: np.ndarray) -> Fits:
    """Fit Φ(ln(level/median)/dispersion) to the numbers of runs that exceed among those that rock.

    Parameters
    ----------
    levels : array (k,)
        Levels, positive and ascending.
    exceeding, rocking : array (n, k)
        Numbers of runs, ``0 <= exceeding <= rocking``.

    Notes
    -----
    The log-likelihood is concave in a and b of Φ(a + b ln level). It has a finite maximum exactly if the levels of runs that
    exceed and of runs that do not overlap: Silvapulle, J. R. Stat. Soc. B 43, 310–313 (1981).
    """
    remaining = rocking - exceeding
    above, below = exceeding > 0, remaining > 0
    last = levels.size - 1
    lowest_above, highest_above = above.argmax(axis=1), last - above[:, ::-1].argmax(axis=1)
    lowest_below, highest_below = below.argmax(axis=1), last - below[:, ::-1].argmax(axis=1)
    kind = np.full(len(exceeding), DETERMINED)
    kind[lowest_below >= highest_above] = DECREASING
    kind[lowest_above >= highest_below] = SEPARATED
    kind[~below.any(axis=1)] = ALL_ABOVE
    kind[~above.any(axis=1)] = ALL_BELOW
    median, dispersion = (np.full(len(exceeding), np.nan) for _ in range(2))
    fitted = kind == DETERMINED
    if fitted.any():
        logarithms = np.log(levels)
        centre, width = logarithms.mean(), logarithms.std()
        a, b = _maximum((logarithms - centre) / width, exceeding[fitted], remaining[fitted])
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            median[fitted], dispersion[fitted] = np.exp(centre - width * a / b), width / b
        # a fraction that hardly grows has its median far outside all numbers
        possible = (b > 0.0) & (median[fitted] > 0.0) & np.isfinite(median[fitted])
        kind[np.flatnonzero(fitted)[~possible]] = DECREASING
    median[kind != DETERMINED] = dispersion[kind != DETERMINED] = np.nan
    # between the levels of the runs on both sides; a separated set has its maximum at a dispersion of 0
    least = np.select([kind == SEPARATED, kind == ALL_BELOW], [levels[highest_below]] * 2, 0.0)
    most = np.select([kind == SEPARATED, kind == ALL_ABOVE], [levels[lowest_above]] * 2, np.inf)
    widest = np.where(kind == SEPARATED, 0.0, np.inf)
    determined = kind == DETERMINED
    return Fits(
        kind,
        median,
        dispersion,
        (np.where(determined, median, least), np.where(determined, median, most)),
        (np.where(determined, dispersion, 0.0), np.where(determined, dispersion, widest)),
    )


def _maximum(
    places: np.ndarray, exceeding: np.ndarray, remaining: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return a and b of the maxima by Newton's method, with steps halved until the likelihood does not fall."""
    coefficients = np.zeros((2, len(exceeding)))
    value = _likelihood(coefficients, places, exceeding, remaining)
    for _ in range(MAX_STEPS):
        step = _newton(coefficients, places, exceeding, remaining)
        length = np.ones(step.shape[1])
        for _ in range(HALVINGS):
            tried = _likelihood(coefficients + length * step, places, exceeding, remaining)
            worse = tried < value - 1e-12 * np.abs(value)
            if not worse.any():
                break
            length[worse] *= 0.5
        coefficients += length * step
        value = tried
        if np.abs(length * step).max() < CLOSE:
            break
    return coefficients[0], coefficients[1]


def _likelihood(
    values: np.ndarray, places: np.ndarray, exceeding: np.ndarray, remaining: np.ndarray
) -> np.ndarray:
    from scipy.special import log_ndtr

    score = values[0][:, None] + values[1][:, None] * places
    return np.asarray((exceeding * log_ndtr(score) + remaining * log_ndtr(-score)).sum(axis=1))


def _newton(
    values: np.ndarray, places: np.ndarray, exceeding: np.ndarray, remaining: np.ndarray
) -> np.ndarray:
    """Return the steps of Newton's method (2, n)."""
    from scipy.special import log_ndtr

    score = values[0][:, None] + values[1][:, None] * places
    density = -0.5 * score * score - 0.5 * np.log(2.0 * np.pi)
    up, down = np.exp(density - log_ndtr(score)), np.exp(density - log_ndtr(-score))
    slope = exceeding * up - remaining * down
    bend = exceeding * up * (up + score) + remaining * down * (down - score)
    first = np.array([slope.sum(axis=1), (slope * places).sum(axis=1)])
    whole, mixed, square = (
        bend.sum(axis=1),
        (bend * places).sum(axis=1),
        (bend * places * places).sum(axis=1),
    )
    determinant = whole * square - mixed * mixed
    return np.array([square * first[0] - mixed * first[1], whole * first[1] - mixed * first[0]]) / determinant


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
    band = _band(levels, many, exceeds / total, rocks / total, count)
    ends = (
        log_basic_interval(median, many.median_bounds, count),
        log_basic_interval(dispersion, many.dispersion_bounds, count),
    )
    return LognormalFit(limit, median, *ends[0], dispersion, *ends[1], misfit), np.array([curve, *band])


def _band(
    levels: np.ndarray, many: Fits, exceeding: np.ndarray, rocking: np.ndarray, records: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the percentiles of the curves of all replicates at each level."""
    from scipy.special import ndtr

    determined, falling = (many.kind[:, None] == kind for kind in (DETERMINED, DECREASING))
    scores = np.log(levels / many.median[:, None]) / many.dispersion[:, None]
    # the limit of the fit is the fraction itself, where no maximum is finite
    curves = np.where(determined, rocking * ndtr(scores), exceeding)
    low, high = tails(records)
    return (
        np.quantile(np.where(falling, 0.0, curves), low, axis=0),
        np.quantile(np.where(falling, rocking, curves), high, axis=0),
    )


def tails(records: int) -> tuple[float, float]:
    """Return the probabilities of the percentiles of a bootstrap, wider for few records: Hesterberg (2015)."""
    from scipy.special import ndtr

    reach = reach_of(records)
    return float(ndtr(-reach)), float(ndtr(reach))


def reach_of(records: int) -> float:
    """Return the number of standard deviations of the ends of an interval, more for few records: Hesterberg (2015)."""
    from scipy.special import stdtrit

    return float(math.sqrt(records / (records - 1.0)) * stdtrit(records - 1.0, ENDS[1]))


def log_basic_interval(
    estimate: float, bounds: tuple[np.ndarray, np.ndarray], records: int
) -> tuple[float, float]:
    """Return the basic bootstrap interval of the logarithm of a parameter.

    A replicate without a fit gives only bounds of the parameter: it counts with the bound that widens the interval.
    """
    low, high = np.sort(bounds[0]), np.sort(bounds[1])
    last, (least_tail, most_tail) = low.size - 1, tails(records)
    least, most = float(low[math.floor(least_tail * last)]), float(high[math.ceil(most_tail * last)])
    return (
        0.0 if math.isinf(most) else estimate * (estimate / most),
        math.inf if least == 0.0 else estimate * (estimate / least),
    )


def accelerated_interval(
    estimate: float, bounds: tuple[np.ndarray, np.ndarray], without: np.ndarray, records: int
) -> tuple[float, float]:
    """Return the bias-corrected and accelerated bootstrap interval: Efron, J. Am. Stat. Assoc. 82, 171–185 (1987).

    Parameters
    ----------
    estimate : float
        Estimate.
    bounds : pair of arrays (replicates,)
        Bounds of the estimates of the replicates, equal for one that is determined.
    without : array (records,)
        Estimates without each record; those that are not finite count as the mean of the others.
    records : int
        Number of records.
    """
    from scipy.special import ndtr, ndtri

    low, high = np.sort(bounds[0]), np.sort(bounds[1])
    count = low.size
    below = 0.5 * ((low < estimate).sum() + (high < estimate).sum())
    shift = ndtri(np.clip(below, 0.5, count - 0.5) / count)
    known = without[np.isfinite(without)]
    deviations = known.mean() - known if known.size else np.zeros(1)
    square = (deviations**2).sum()
    acceleration = (deviations**3).sum() / (6.0 * square**1.5) if square > 0.0 else 0.0
    reach = shift + np.array([-1.0, 1.0]) * reach_of(records)
    scale = 1.0 - acceleration * reach
    with np.errstate(divide="ignore"):
        # beyond the pole of the formula an end is that of all replicates
        moved = np.where(scale > 0.0, shift + reach / scale, np.copysign(np.inf, reach))
    first, second = ndtr(moved) * (count - 1)
    return float(low[math.floor(first)]), float(high[math.ceil(second)])


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
