"""Mean of a long sequence with an error: batch means, and a drift estimate for sums that stay bounded."""

from __future__ import annotations

import math

import numpy as np
from attrs import frozen
from numpy.typing import ArrayLike, NDArray

from rocking.kernels.numerics import averages
from rocking.model.validation import Refusal, reals

MAX_BATCHES = 256
MIN_BATCHES = 32
MIN_GROUPS = 16
# Above this, neighbouring groups of eight of the 256 batches are still correlated.
MAX_CORRELATION_TIME = 4.0


@frozen
class BatchMean:
    """Mean of a sequence with its error; returned by `batch_mean`.

    Attributes
    ----------
    value : float
        Mean.
    error : float
        Standard error if the sum spreads like a random walk. If the sum stays bounded, the largest drift of the running
        mean over the last three quarters. Infinite if the sequence supports neither.
    correlation : float
        Integrated correlation time, in batches: ratio of the variance of the mean to that of independent batches.
    bounded : bool
        True if `error` is the drift.
    batches : int
        Number of batches compared.
    """

    value: float
    error: float
    correlation: float
    bounded: bool
    batches: int


def batch_mean(sums: ArrayLike, lengths: ArrayLike | None = None) -> BatchMean:
    """Average a sequence and estimate the error from batches, halving their number while at least 16 remain.

    For a chaotic sequence, the error of the mean is the spread of the batches over the square root of their number. Merging
    neighbours no longer changes it once the batches are longer than the correlation time. The largest of the estimates
    found on the way is returned.

    On a periodic or quasi-periodic motion, the sum stays within bounds of its mean growth. The spread of merged batches
    decreases, and no number of batches gives a standard error. The mean of N terms is off by O(1/N), or by O(log N/N) if
    nearby trajectories diverge linearly. The error is then the largest distance of the running mean from its last value
    over the last three quarters. It is an upper bound of the remaining error in these cases.

    Parameters
    ----------
    sums : array_like, shape (n,)
        Consecutive terms, or sums over consecutive intervals.
    lengths : array_like, shape (n,), optional
        Lengths of these intervals. Default: 1.

    Returns
    -------
    BatchMean
        Mean and error.

    Raises
    ------
    TypeError
        If the terms are not real numbers.
    ValueError
        If there are no terms, or if some are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> steps = np.random.default_rng(1).normal(2.0, 1.0, 10_000)
    >>> mean = batch_mean(steps)
    >>> abs(mean.value - 2.0) < 3 * mean.error, bool(0.008 < mean.error < 0.013)
    (True, True)
    """
    terms = _terms("sums", sums)
    spans = np.ones_like(terms) if lengths is None else _terms("lengths", lengths)
    if spans.shape != terms.shape or not (spans > 0.0).all():
        raise Refusal("lengths", f"be {len(terms)} positive numbers, one for each sum", lengths)
    batches = 2 ** int(math.log2(min(len(terms), MAX_BATCHES)))
    edges = np.linspace(0, len(terms), batches + 1).astype(int)[:-1]
    return _judged(np.add.reduceat(terms, edges), np.add.reduceat(spans, edges))


def _terms(name: str, values: ArrayLike) -> NDArray[np.float64]:
    terms = np.atleast_1d(np.asarray(reals(name, values), dtype=float))
    if terms.ndim != 1 or not terms.size or not np.isfinite(terms).all():
        raise Refusal(name, "be a sequence of at least one finite number", values)
    return terms


def _judged(sums: NDArray[np.float64], lengths: NDArray[np.float64]) -> BatchMean:
    batches, value = len(sums), float(sums.sum() / lengths.sum())
    if batches < MIN_BATCHES:
        return BatchMean(value, math.inf, math.nan, bounded=False, batches=batches)
    errors = _errors(sums - value * lengths) / lengths.sum()
    last, finest, largest = errors[-1], errors[0], errors.max()
    # With r batches merged into one, the spread of the mean is constant, or falls by √r if sums are bounded.
    # The criterion lies in between.
    joined = 2.0 ** (len(errors) - 1)
    bounded = bool(last * joined**0.25 < finest) or bool(finest == 0.0)
    correlation = float((largest / finest) ** 2) if finest > 0.0 else 1.0
    if bounded:
        error = _drift(sums, lengths)
    else:
        error = float(largest) if correlation <= MAX_CORRELATION_TIME else math.inf
    return BatchMean(value, error, correlation, bounded, batches)


def _errors(departures: NDArray[np.float64]) -> NDArray[np.float64]:
    """Standard error of the sum with 1, 2, 4, … batches merged into one, as long as 16 groups remain."""
    errors = []
    size = 1
    while len(departures) >= MIN_GROUPS * size:
        errors.append(averages.error_of_sum(departures, size))
        size *= 2
    return np.array(errors)


def _drift(sums: NDArray[np.float64], lengths: NDArray[np.float64]) -> float:
    means = np.cumsum(sums) / np.cumsum(lengths)
    return float(np.abs(means[len(means) // 4 - 1 :] - means[-1]).max())
