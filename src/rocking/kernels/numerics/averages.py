"""Averages along a motion: weighted Birkhoff averages, and means of batches with their error."""

import math

import numpy as np
from numba import njit

from rocking.kernels.compile_options import ALLOCATING, ALLOCATING_ENTRY, ENTRY_POINT, INTERNAL, KERNEL, SIMD
from rocking.kernels.numerics.simd import both_exponentials

# Of a weight below e to minus this nothing is seen in a sum.
UNSEEN = 700.0


@njit(**SIMD)
def bumps(count, weights):
    """The weights of the first half of ``count`` values, several at a time; the other half has the same from its end.

    An odd count's middle one is halved: it comes from either end.
    """
    step, half = 1.0 / (count + 1), (count + 1) // 2
    for k in range(half):
        x = (k + 1) * step
        weights[k] = both_exponentials(max(-1.0 / (x * (1.0 - x)), -UNSEEN))[0]
    if count % 2 == 1:
        weights[half - 1] *= 0.5


@njit(**ALLOCATING)
def weighted_mean(values):
    """Birkhoff average with the weight exp(-1/(x(1 - x))), x from 0 to 1 along ``values``.

    Das, Saiki, Sander and Yorke (2017), Nonlinearity 30: on a quasi-periodic motion it converges faster than any
    power of the length.
    """
    total, count = 0.0, values.shape[0]
    weights = np.empty((count + 1) // 2)
    bumps(count, weights)
    for k in range(weights.shape[0]):
        total += weights[k] * (values[k] + values[count - 1 - k])
    return total / (2.0 * weights.sum())


@njit(**ALLOCATING)
def digits_of_agreement(values):
    """To how many decimal digits the weighted means of both halves of ``values`` agree, relative to their size."""
    half = values.shape[0] // 2
    return digits_alike(weighted_mean(values[:half]), weighted_mean(values[half : 2 * half]))


@njit(**INTERNAL)
def digits_with(values, weights):
    """``digits_of_agreement`` by the weights that ``bumps`` gives half as many values."""
    half, first, second = values.shape[0] // 2, 0.0, 0.0
    for k in range((half + 1) // 2):
        opposite = half - 1 - k
        first += weights[k] * (values[k] + values[opposite])
        second += weights[k] * (values[half + k] + values[half + opposite])
    return digits_alike(first, second)


@njit(**INTERNAL)
def digits_alike(first, second):
    """To how many decimal digits two numbers agree, relative to their size."""
    scale = max(abs(first), abs(second))
    if first == second or scale == 0.0:
        return 16.0
    return -math.log10(abs(first - second) / scale)


@njit(**KERNEL)
def error_of_sum(departures, width):
    """Standard error of a sum, from how far its terms depart from their mean, ``width`` neighbours taken together."""
    groups = departures.shape[0] // width
    spread = 0.0
    for k in range(groups):
        departure = departures[k * width : (k + 1) * width].sum()
        spread += departure * departure
    return math.sqrt(spread * groups / (groups - 1))


@njit(**ALLOCATING)
def batch_error(batches):
    """(mean, standard error, correlation) of a series from batch means: the largest error of all, half and a quarter as many.

    Where batches are long against the correlation time, merging them changes the error by chance only; where
    they are not, it grows: ``correlation`` is the factor by which that raises the variance.
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
    """``weighted_mean`` for Python."""
    return weighted_mean(values)


@njit(**ALLOCATING_ENTRY)
def digits_of_agreement_plain(values):
    """``digits_of_agreement`` for Python."""
    return digits_of_agreement(values)


@njit(**ENTRY_POINT)
def error_of_sum_plain(departures, width):
    """``error_of_sum`` for Python."""
    return error_of_sum(departures, width)
