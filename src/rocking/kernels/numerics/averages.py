"""Averages along a motion: weighted Birkhoff averages, and batch means with their standard error."""

import math

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.numerics.simd import both_exponentials
from rocking.kernels.signature import Floats1

# A weight below e to the power of minus this does not change a sum.
UNSEEN = 700.0


@njit(**INTERNAL)
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


@njit(**INTERNAL)
def weighted_mean(values, weights):
    """Return the Birkhoff average with the weight exp(-1/(x(1 - x))), where x runs from 0 to 1 along ``values``.

    ``weights`` takes half the number of weights, rounded up.
    Das, Saiki, Sander and Yorke (2017), Nonlinearity 30: on a quasi-periodic motion it converges faster than
    any power of the length.
    """
    total, count = 0.0, values.shape[0]
    bumps(count, weights)
    half = weights[: (count + 1) // 2]
    for k in range(half.shape[0]):
        total += half[k] * (values[k] + values[count - 1 - k])
    return total / (2.0 * half.sum())


@njit(**INTERNAL)
def digits_of_agreement(values, weights):
    """Return the number of decimal digits to which the weighted means of both halves of ``values`` agree."""
    half = values.shape[0] // 2
    return digits_alike(
        weighted_mean(values[:half], weights), weighted_mean(values[half : 2 * half], weights)
    )


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


@njit(**KERNEL)
def batch_error(batches):
    """Estimate the mean of a series and its standard error from batch means.

    The error is the largest of three estimates: from all batches, from pairs and from groups of four. If the
    batches are long compared with the correlation time, merging them changes the error by chance only.
    Otherwise the error grows; ``correlation`` is the factor by which merging raises the variance. The batches
    are replaced by their deviations from the mean.

    Returns
    -------
    tuple of (float, float, float)
        Mean, standard error and correlation.
    """
    mean = batches.mean()
    for k in range(batches.shape[0]):
        batches[k] -= mean
    finest = error_of_sum(batches, 1)
    largest = finest
    for width in (2, 4):
        largest = max(largest, error_of_sum(batches, width))
    correlation = (largest / finest) ** 2 if finest > 0.0 else 1.0
    return mean, largest / batches.shape[0], correlation


@entry_point(**KERNEL)
def weighted_mean_plain(values: Floats1, weights: Floats1) -> float:
    """Return ``weighted_mean``; entry point for Python."""
    return weighted_mean(values, weights)


@entry_point(**KERNEL)
def digits_of_agreement_plain(values: Floats1, weights: Floats1) -> float:
    """Return ``digits_of_agreement``; entry point for Python."""
    return digits_of_agreement(values, weights)


@entry_point(**KERNEL)
def error_of_sum_plain(departures: Floats1, width: int) -> float:
    """Return ``error_of_sum``; entry point for Python."""
    return error_of_sum(departures, width)
