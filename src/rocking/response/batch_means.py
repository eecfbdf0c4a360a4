"""The mean of a long sequence and how far it can be trusted: batch means, and what to say of sums that stay bounded."""

from __future__ import annotations

import math

import numpy as np
from attrs import frozen
from numpy.typing import ArrayLike, NDArray

from rocking.kernels.numerics import averages
from rocking.model import reals, refusal

MAX_BATCHES = 256
MIN_BATCHES = 32
MIN_GROUPS = 16
# Neighbouring groups of eight of the 256 batches are still bound to each other beyond this.
MAX_CORRELATION_TIME = 4.0


@frozen
class BatchMean:
    """The mean of a sequence, its error, and what the error rests on; made by `batch_mean`.

    Attributes
    ----------
    value : float
        The mean.
    error : float
        Its standard error where the sum spreads as a random walk does; where the sum stays within bounds, how far the
        running mean moved over the last three quarters; infinite where the sequence supports neither.
    correlation : float
        Integrated correlation time, in batches: by how much the variance of the mean exceeds that of independent
        batches.
    bounded : bool
        Whether the error is the second kind.
    batches : int
        How many batches were compared.
    """

    value: float
    error: float
    correlation: float
    bounded: bool
    batches: int


def batch_mean(sums: ArrayLike, lengths: ArrayLike | None = None) -> BatchMean:
    """Average a sequence and estimate the error from batches, halving their number while at least 16 remain.

    Chaotic sequences: with batches long against the correlation time, the error of the mean is the spread of the
    batches over the root of their number, and no longer changes when neighbours are joined; the largest of the
    values found on the way is taken. On a periodic or quasi-periodic motion the sum keeps within bounds of its
    mean growth, batches joined spread less and less, and no number of batches makes that a standard error: the
    mean of N terms is off by O(1/N), or by O(log N/N) where neighbours part linearly. There the error is the
    largest distance of the running mean from the last one over the last three quarters, which for each of these
    is at least the distance still to go.

    Parameters
    ----------
    sums : array_like, shape (n,)
        Consecutive terms, or sums over consecutive stretches.
    lengths : array_like, shape (n,), optional
        How long those stretches are; 1 by default.

    Returns
    -------
    BatchMean

    Raises
    ------
    TypeError, ValueError
        Where there are no terms, or they are not finite numbers.

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
        raise ValueError(refusal("lengths", f"be {len(terms)} positive numbers, one for each sum", lengths))
    batches = 2 ** int(math.log2(min(len(terms), MAX_BATCHES)))
    edges = np.linspace(0, len(terms), batches + 1).astype(int)[:-1]
    return _judged(np.add.reduceat(terms, edges), np.add.reduceat(spans, edges))


def _terms(name: str, values: ArrayLike) -> NDArray[np.float64]:
    terms = np.atleast_1d(np.asarray(reals(name, values), dtype=float))
    if terms.ndim != 1 or not terms.size or not np.isfinite(terms).all():
        raise ValueError(refusal(name, "be a sequence of finite numbers, one at least", values))
    return terms


def _judged(sums: NDArray[np.float64], lengths: NDArray[np.float64]) -> BatchMean:
    batches, value = len(sums), float(sums.sum() / lengths.sum())
    if batches < MIN_BATCHES:
        return BatchMean(value, math.inf, math.nan, bounded=False, batches=batches)
    errors = _errors(sums - value * lengths) / lengths.sum()
    last, finest, largest = errors[-1], errors[0], errors.max()
    # Joined r to one the spread of the mean stays, or falls by √r where sums are bounded: the line is between.
    joined = 2.0 ** (len(errors) - 1)
    bounded = bool(last * joined**0.25 < finest) or bool(finest == 0.0)
    correlation = float((largest / finest) ** 2) if finest > 0.0 else 1.0
    if bounded:
        error = _drift(sums, lengths)
    else:
        error = float(largest) if correlation <= MAX_CORRELATION_TIME else math.inf
    return BatchMean(value, error, correlation, bounded, batches)


def _errors(departures: NDArray[np.float64]) -> NDArray[np.float64]:
    """Standard error of the sum with batches joined to 1, 2, 4, … at a time, as long as 16 groups remain."""
    errors = []
    size = 1
    while len(departures) >= MIN_GROUPS * size:
        errors.append(averages.error_of_sum_plain(departures, size))
        size *= 2
    return np.array(errors)


def _drift(sums: NDArray[np.float64], lengths: NDArray[np.float64]) -> float:
    means = np.cumsum(sums) / np.cumsum(lengths)
    return float(np.abs(means[len(means) // 4 - 1 :] - means[-1]).max())
