"""Averages along a motion: weighted Birkhoff averages, and batch means with their standard error."""

import math

from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats1
from rocking.kernels.numerics.elementary import both_exponentials, logarithm_10

# A weight below e to the power of minus this does not change a sum.
UNSEEN = 700.0


@kernel
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


@kernel
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


@entry_point
def mean_and_digits(values: Floats1, weights: Floats1) -> tuple[float, float]:
    """Return the ``weighted_mean``, and the number of decimal digits to which those of both halves of ``values`` agree."""
    half = values.shape[0] // 2
    first, second = weighted_mean(values[:half], weights), weighted_mean(values[half : 2 * half], weights)
    return weighted_mean(values, weights), digits_alike(first, second)


@kernel
def digits_with(values, weights):
    """Return the digits of ``mean_and_digits`` from the weights that ``bumps`` computes for half the number of values."""
    half, first, second = values.shape[0] // 2, 0.0, 0.0
    for k in range((half + 1) // 2):
        opposite = half - 1 - k
        first += weights[k] * (values[k] + values[opposite])
        second += weights[k] * (values[half + k] + values[half + opposite])
    return digits_alike(first, second)


@kernel
def digits_alike(first, second):
    """Return the number of decimal digits to which two numbers agree, relative to their size."""
    scale = max(abs(first), abs(second))
    if first == second or scale == 0.0:
        return 16.0
    return -logarithm_10(abs(first - second) / scale)


@entry_point
def error_of_sum(departures: Floats1, width: int) -> float:
    """Return the standard error of a sum from the deviations of its terms, in groups of ``width`` neighbours.

    ``departures`` holds the deviation of each term from the mean of the terms.
    """
    groups = departures.shape[0] // width
    spread = 0.0
    for k in range(groups):
        departure = departures[k * width : (k + 1) * width].sum()
        spread += departure * departure
    return math.sqrt(spread * groups / (groups - 1))


@kernel
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
