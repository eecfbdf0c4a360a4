"""Base acceleration in two directions, horizontal and vertical, both linear between the same equidistant samples.

The vertical acceleration changes the weight of the block: weight = 1 + vertical acceleration in units of g, positive upwards. Places
and tables of the horizontal one are those of samples. After the last sample both accelerations are 0.
"""

from typing import NamedTuple

from rocking.kernels import contract
from rocking.kernels.base.samples import (
    Samples,
    Tables,
    acceleration_at,
    change_of_samples,
    last_index,
    place_at,
)
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.library.signature import Floats1


class Biaxial(NamedTuple):
    """Horizontal base acceleration, samples times a scale, and the weight of the block at the same samples."""

    LIKE = Samples  # the base with the same drives and constants
    scale: float
    tables: Tables
    weights: Floats1  # (n,)
    lightest: Floats1  # (n,): least of 1 and of the weights from each sample on
    heaviest: Floats1  # (n,): largest of 1 and of their sizes


@kernel(inline=True)
def weight_in(p, index):
    """Return the weight at the start of an interval, and its rate: 1 and 0 after the last sample."""
    if index >= last_index(p):
        return 1.0, 0.0
    weights = p.forcing.weights
    return weights[index], (weights[index + 1] - weights[index]) / p.forcing.tables.step


@kernel(inline=True)
def weight_at(p, drive):
    """Return the weight at a place."""
    start, rate = weight_in(p, drive.index)
    return start + rate * drive.offset


@kernel
def change_of_weight(p, drive, time):
    """Return the largest change of the weight within a time: at samples, at its end, or at the jump after the last sample."""
    here, last, change = weight_at(p, drive), last_index(p), 0.0
    if drive.index >= last:
        return change
    end = place_at(p, drive.index, drive.offset + time)
    for index in range(drive.index + 1, end.index + 1):
        change = max(change, abs(p.forcing.weights[index] - here))
    return max(change, abs(weight_at(p, end) - here))


body(contract.acceleration_of, None, Biaxial)(acceleration_at)
body(contract.acceleration_change_bound, None, Biaxial)(change_of_samples)
