"""Base acceleration that is linear between equidistant samples: places in it, and tables that are made once for samples and step.

The tables hold the bounded solution P of P'' - P = -a, and its derivative. Both are linear in a: scale, sign, slenderness and
restitution share the tables. With L' = -L + a from the left and R' = R - a from the right, P = (L + R)/2 and
P' = (R - L)/2. Either recursion contracts and has positive weights, so that nothing cancels. It adds changes: a rounded factor
e^-h would act at each sample as a step that is a little wrong.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from rocking.kernels import contract
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.library.signature import Floats1
from rocking.kernels.numerics.elementary import exponential, hyperbolic

# Samples in a block of the search for a lift-off.
BLOCK = 16
# Terms of the series of the weights, for a step up to 1.
TERMS = 18
KNOT = np.dtype([(name, float) for name in ("mean", "rate", "lowest", "highest")], align=True)
Knots = Annotated[np.ndarray, KNOT, 1]
# From each sample to the next: the rate of a, and what a adds to u + u' and takes from u - u'.
INTERVAL = np.dtype([(name, float) for name in ("rate", "ahead", "behind")], align=True)
Intervals = Annotated[np.ndarray, INTERVAL, 1]
# ``ahead`` and ``behind`` over several intervals.
STRIDE = np.dtype([(name, float) for name in ("ahead", "behind")], align=True)
Strides = Annotated[np.ndarray, STRIDE, 1]
# Longest stride in units of time, and in intervals. The bound of a longer one holds less often, and there are more shorter ones.
STRIDE_TIME, LONGEST = 0.12, 64


class Passage(NamedTuple):
    """From a sample to one a time t later: u + u' and u - u' without base acceleration, and the bound of ``search_samples``."""

    gain: float  # e^t - 1
    loss: float  # 1 - e^-t
    ahead: float  # what a = 1 adds to u + u'
    behind: float  # what it takes from u - u'
    bend: float  # q/(1 - q), q = t^2/8


class TableFields(NamedTuple):
    """Fields of ``Tables``."""

    step: float
    sinh: float  # of the step
    versinh: float  # cosh - 1
    excess: float  # sinh - step
    growth: float  # e^step
    decay: float  # e^-step
    largest: float  # |a| of all samples
    # Rounding error of P, in units of the largest |P|: each step adds its own, and the recursion forgets it in a unit of time.
    error: float
    single: Passage  # over one interval
    several: Passage  # over ``stride`` intervals
    stride: int
    samples: Floats1  # (n,)
    intervals: Intervals  # (n,), the last is 0
    strides: Strides  # (n,), over ``stride`` intervals from each sample on; without meaning near the last one
    # (n,): P and P' at each sample; least and greatest of 0 and of P from this sample on
    knots: Knots
    blocks: Floats1  # largest |a| in each block of samples
    variation: Floats1  # (n,): sum of the changes |a_k - a_(k-1)| up to each sample


class Tables(TableFields):
    """Samples at unit scale, with all that depends on them and on the step alone. They never change, so they keep their words."""

    words = None  # those of ``library.signature``, once an entry point has asked for them

    def __getstate__(self) -> None:
        """Leave the words out of a copy, which has other addresses."""


@kernel
def weights(step):
    """Return the integrals of e^-x (1 - x/step) and of e^-x x/step over a step, to relative accuracy."""
    if step > 1.0:
        decay = exponential(-step)
        return 1.0 - (1.0 - decay) / step, (1.0 - decay * (1.0 + step)) / step
    near, far, term = 0.0, 0.0, 0.5 * step
    for k in range(TERMS):
        near += term
        far += (k + 1) * term
        term *= -step / (k + 3)
    return near, far


@kernel
def fill_intervals(samples, step, growth, near, far, intervals):
    """Fill the rows of the intervals."""
    last = samples.shape[0] - 1
    for k in range(last):
        start, end, interval = samples[k], samples[k + 1], intervals[k]
        interval.rate = (end - start) / step
        interval.ahead, interval.behind = growth * (near * start + far * end), near * end + far * start
    intervals[last].rate = intervals[last].ahead = intervals[last].behind = 0.0


@kernel
def passage_over(time, ahead, behind):
    """Return the ``Passage`` over a time."""
    sinh, versinh, _, _ = hyperbolic(time)
    decay, gain, q = exponential(-time), sinh + versinh, 0.125 * time * time
    loss = 1.0 - decay if time > 1.0 else decay * gain
    return Passage(gain, loss, ahead, behind, q / (1.0 - q))


@kernel
def fill_strides(intervals, single, stride, time, strides):
    """Fill the rows of ``strides`` and return their ``Passage``. Each round doubles the number of intervals."""
    n, passed, several = intervals.shape[0], 1, single
    for k in range(n):
        strides[k].ahead, strides[k].behind = intervals[k].ahead, intervals[k].behind
    while passed < stride:
        growth, decay = 1.0 + several.gain, 1.0 - several.loss
        for k in range(n - passed):
            row, later = strides[k], strides[k + passed]
            row.ahead, row.behind = growth * row.ahead + later.ahead, decay * row.behind + later.behind
        passed *= 2
        several = passage_over(time * passed, (growth + 1.0) * several.ahead, (decay + 1.0) * several.behind)
    return several


@entry_point
def fill(
    samples: Floats1,
    step: float,
    stride: int,
    intervals: Intervals,
    strides: Strides,
    knots: Knots,
    blocks: Floats1,
    variation: Floats1,
) -> tuple[float, float, float, float, float, float, float, Passage, Passage]:
    """Fill the arrays of the tables; return the values from ``sinh`` to ``several``."""
    n = samples.shape[0]
    sinh, versinh, excess, _ = hyperbolic(step)
    growth, decay, (near, far) = exponential(step), exponential(-step), weights(step)
    fill_intervals(samples, step, growth, near, far, intervals)
    weight = near + far
    single = passage_over(step, growth * weight, weight)
    loss = single.loss
    several = fill_strides(intervals, single, stride, step, strides)
    left = variation[0] = 0.0
    for k in range(n):
        if k > 0:
            left -= loss * left - (near * samples[k] + far * samples[k - 1])
            variation[k] = variation[k - 1] + abs(samples[k] - samples[k - 1])
        knots[k].mean = left
    right, lowest, highest, largest = 0.0, 0.0, 0.0, 0.0
    for j in range(n):
        k = n - 1 - j
        if j > 0:
            right -= loss * right - (near * samples[k] + far * samples[k + 1])
        left = knots[k].mean
        mean = 0.5 * (left + right)
        lowest, highest = min(lowest, mean), max(highest, mean)
        largest = max(largest, abs(samples[k]))
        knots[k].mean, knots[k].rate = mean, 0.5 * (right - left)
        knots[k].lowest, knots[k].highest = lowest, highest
    for k in range(blocks.shape[0]):
        blocks[k] = 0.0
    for k in range(n):
        blocks[k // BLOCK] = max(blocks[k // BLOCK], abs(samples[k]))
    error = 1.0 / math.sqrt(min(step, 1.0))
    return sinh, versinh, excess, growth, decay, largest, error, single, several


def tables_of(samples: np.ndarray, step: float) -> Tables:
    """Make the tables of samples (n,), n >= 1, at a step in normalised time."""
    n, stride = len(samples), 1
    while 2 * stride * step <= STRIDE_TIME and stride < LONGEST:
        stride *= 2
    intervals, strides, knots = np.empty(n, INTERVAL), np.empty(n, STRIDE), np.empty(n, KNOT)
    blocks, variation = np.empty(-(-n // BLOCK)), np.empty(n)
    numbers = fill(samples, step, stride, intervals, strides, knots, blocks, variation)
    return Tables(step, *numbers, stride, samples, intervals, strides, knots, blocks, variation)


# Default length of a cycle of the clock, in samples: a time within it is accurate however long the record.
CYCLE = 64


class Samples(NamedTuple):
    """Base acceleration: samples times a scale, which may be negative."""

    scale: float
    tables: Tables


class SampledDrive(NamedTuple):
    """Place in a sampled forcing: interval between samples, and the time since its first sample."""

    index: int
    offset: float


class SampledConstants(NamedTuple):
    """Constants of an arc under samples: u = 1 + side scale P + (grow e^t + shrink e^-t)/2. Zeros for a full block."""

    grow: float
    shrink: float


@kernel(inline=True)
def last_index(p):
    """Return the index of the interval after the last sample."""
    return p.forcing.tables.samples.shape[0] - 1


@kernel(inline=True)
def interval(p, index):
    """Return the base acceleration at the start of an interval, and its rate: 0 after the last sample."""
    if index >= last_index(p):
        return 0.0, 0.0
    tables, scale = p.forcing.tables, p.forcing.scale
    return scale * tables.samples[index], scale * tables.intervals[index].rate


@body(contract.acceleration_of, None, Samples, inline=True)
def acceleration_at(p, drive):
    """Return the base acceleration at a place."""
    start, rate = interval(p, drive.index)
    return start + rate * drive.offset


@kernel(inline=True)
def place_at(p, index, offset):
    """Return the place a time ``offset`` >= 0 after a sample."""
    step, last = p.forcing.tables.step, last_index(p)
    if index >= last or offset < step:
        return SampledDrive(index, offset)
    passed = min(math.floor(offset / step), float(last - index))
    return SampledDrive(index + int(passed), max(offset - passed * step, 0.0))


@kernel(inline=True)
def time_between(p, first, last):
    """Return the time from one place to another."""
    return (last.index - first.index) * p.forcing.tables.step + (last.offset - first.offset)


@body(contract.acceleration_change_bound, None, Samples)
def change_of_samples(p, drive, time):
    """Provide ``contract.acceleration_change_bound``: the largest change at samples and at the end."""
    here, last, change = acceleration_at(p, drive), last_index(p), 0.0
    if drive.index >= last:
        return change
    end = place_at(p, drive.index, drive.offset + time)
    for index in range(drive.index + 1, end.index + 1):
        change = max(change, abs(p.forcing.scale * p.forcing.tables.samples[index] - here))
    return max(change, abs(acceleration_at(p, end) - here))
