"""Averages along a motion: weighted Birkhoff averages, and batch means with their standard error."""

import math

import numpy as np
from numba import njit

from rocking.kernels.compile_options import ALLOCATING, ALLOCATING_ENTRY, ENTRY_POINT, INTERNAL, KERNEL, SIMD
from rocking.kernels.numerics.simd import both_exponentials

# A weight below e to the power of minus this does not change a sum.
UNSEEN = 700.0


@njit(**SIMD)
def bumps(count, weights):
    """Write the weights of the first half of ``count`` values.

    The second half has the same weights in reverse order. The middle weight of an odd count is halved because
    it is used from both ends.
    """
    step, half = 1.0 / (count + 1), (count + 1) // 2
    for k in range(half):
        x = (k + 1) * step
        weights[k] = both_exponentials(max(-1.0 / (x * (1.0 - x)), -UNSEEN))[0]
    if count % 2 == 1:
        weights[half - 1] *= 0.5


@njit(**ALLOCATING)
def weighted_mean(values):
    """Return the Birkhoff average with the weight exp(-1/(x(1 - x))), where x runs from 0 to 1 along ``values``.

    Das, Saiki, Sander and Yorke (2017), Nonlinearity 30: on a quasi-periodic motion it converges faster than
    any power of the length.
    """
    total, count = 0.0, values.shape[0]
    weights = np.empty((count + 1) // 2)
    bumps(count, weights)
    for k in range(weights.shape[0]):
        total += weights[k] * (values[k] + values[count - 1 - k])
    return total / (2.0 * weights.sum())


@njit(**ALLOCATING)
def digits_of_agreement(values):
    """Return the number of decimal digits to which the weighted means of both halves of ``values`` agree."""
    half = values.shape[0] // 2
    return digits_alike(weighted_mean(values[:half]), weighted_mean(values[half : 2 * half]))


@njit(**INTERNAL)
def digits_with(values, weights):
    """Return ``digits_of_agreement`` from the weights that ``bumps`` computes for half the number of values."""
    half, first, second = values.shape[0] // 2, 0.0, 0.0
    for k in range((half + 1) // 2):
        opposite = half - 1 - k
        first += weights[k] * (values[k] + values[opposite])
        second += weights[k] * (values[half + k] + values[half + opposite])
    return digits_alike(first, second)


@njit(**INTERNAL)
def digits_alike(first, second):
    """Return the number of decimal digits to which two numbers agree, relative to their size."""
    scale = max(abs(first), abs(second))
    if first == second or scale == 0.0:
        return 16.0
    return -math.log10(abs(first - second) / scale)


@njit(**KERNEL)
def error_of_sum(departures, width):
    """Return the standard error of a sum from the deviations of its terms, in groups of ``width`` neighbours.

    ``departures`` holds the deviation of each term from the mean of the terms.
    """
    groups = departures.shape[0] // width
    spread = 0.0
    for k in range(groups):
        departure = departures[k * width : (k + 1) * width].sum()
        spread += departure * departure
    return math.sqrt(spread * groups / (groups - 1))


@njit(**ALLOCATING)
def batch_error(batches):
    """Estimate the mean of a series and its standard error from batch means.

    The error is the largest of three estimates: from all batches, from pairs and from groups of four. If the
    batches are long compared with the correlation time, merging them changes the error by chance only.
    Otherwise the error grows; ``correlation`` is the factor by which merging raises the variance.

    Returns
    -------
    tuple of (float, float, float)
        Mean, standard error and correlation.
    """
    mean = batches.mean()
    departures = batches - mean
    finest = error_of_sum(departures, 1)
    largest = finest
    for width in (2, 4):
        largest = max(largest, error_of_sum(departures, width))
    correlation = (largest / finest) ** 2 if finest > 0.0 else 1.0
    return mean, largest / batches.shape[0], correlation


@njit(**ALLOCATING_ENTRY)
def weighted_mean_plain(values):
    """Return ``weighted_mean``; entry point for Python."""
    return weighted_mean(values)


@njit(**ALLOCATING_ENTRY)
def digits_of_agreement_plain(values):
    """Return ``digits_of_agreement``; entry point for Python."""
    return digits_of_agreement(values)


@njit(**ENTRY_POINT)
def error_of_sum_plain(departures, width):
    """Return ``error_of_sum``; entry point for Python."""
    return error_of_sum(departures, width)
