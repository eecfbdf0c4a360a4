"""Fractions of runs that are clustered by record, with intervals that treat only the records as independent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

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
