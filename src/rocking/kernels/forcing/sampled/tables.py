"""Tables of a sampled base acceleration, made once for its samples and its step.

They hold the bounded solution P of P'' - P = -a, and its derivative. Both are linear in a: scale, sign, slenderness and
restitution share the tables. With L' = -L + a from the left and R' = R - a from the right, P = (L + R)/2 and
P' = (R - L)/2. Either recursion contracts and has positive weights, so that nothing cancels. It adds changes: a rounded factor
e^-h would act at each sample as a step that is a little wrong.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.numerics.elementary import hyperbolic
from rocking.kernels.signature import Floats1

# Samples in a block of the search for a lift-off.
BLOCK = 16
# Terms of the series of the weights, for a step up to 1.
TERMS = 18
KNOT = np.dtype([(name, float) for name in ("mean", "rate", "lowest", "highest")], align=True)
Knots = Annotated[np.ndarray, KNOT, 1]
# From each sample to the next: the rate of a, and what a adds to u + u' and takes from u - u'.
INTERVAL = np.dtype([(name, float) for name in ("rate", "ahead", "behind")], align=True)
Intervals = Annotated[np.ndarray, INTERVAL, 1]


class Tables(NamedTuple):
    """Samples at unit scale, with all that depends on them and on the step alone."""

    step: float
    sinh: float  # of the step
    versinh: float  # cosh - 1
    excess: float  # sinh - step
    growth: float  # e^step
    decay: float  # e^-step
    gain: float  # e^step - 1
    loss: float  # 1 - e^-step
    near: float  # the two weights of the samples
    far: float
    bend: float  # of the bound in ``search``
    largest: float  # |a| of all samples
    # Rounding error of P, in units of the largest |P|: each step adds its own, and the recursion forgets it in a unit of time.
    error: float
    samples: Floats1  # (n,)
    intervals: Intervals  # (n,), the last is 0
    # (n,): P and P' at each sample; least and greatest of 0 and of P from this sample on
    knots: Knots
    blocks: Floats1  # largest |a| in each block of samples
    variation: Floats1  # (n,): sum of the changes |a_k - a_(k-1)| up to each sample


@njit(**INTERNAL)
def weights(step):
    """Return the integrals of e^-x (1 - x/step) and of e^-x x/step over a step, to relative accuracy."""
    if step > 1.0:
        decay = math.exp(-step)
        return 1.0 - (1.0 - decay) / step, (1.0 - decay * (1.0 + step)) / step
    near, far, term = 0.0, 0.0, 0.5 * step
    for k in range(TERMS):
        near += term
        far += (k + 1) * term
        term *= -step / (k + 3)
    return near, far


@njit(**INTERNAL)
def fill_intervals(samples, step, growth, near, far, intervals):
    """Fill the rows of the intervals."""
    last = samples.shape[0] - 1
    for k in range(last):
        start, end, interval = samples[k], samples[k + 1], intervals[k]
        interval.rate = (end - start) / step
        interval.ahead, interval.behind = growth * (near * start + far * end), near * end + far * start
    intervals[last].rate = intervals[last].ahead = intervals[last].behind = 0.0


@entry_point(**KERNEL)
def fill(
    samples: Floats1, step: float, intervals: Intervals, knots: Knots, blocks: Floats1, variation: Floats1
) -> tuple[float, float, float, float, float, float, float, float, float, float, float, float]:
    """Fill the arrays of the tables; return the numbers from ``sinh`` to ``error``."""
    n = samples.shape[0]
    sinh, versinh, excess, _ = hyperbolic(step)
    growth, decay, (near, far) = math.exp(step), math.exp(-step), weights(step)
    gain = sinh + versinh
    loss = 1.0 - decay if step > 1.0 else decay * gain
    fill_intervals(samples, step, growth, near, far, intervals)
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
    quarter = 0.125 * step * step
    bend = quarter / (1.0 - quarter)
    return (
        sinh,
        versinh,
        excess,
        growth,
        decay,
        gain,
        loss,
        near,
        far,
        bend,
        largest,
        1.0 / math.sqrt(min(step, 1.0)),
    )


def tables_of(samples: np.ndarray, step: float) -> Tables:
    """Make the tables of samples (n,), n >= 1, at a step in normalised time."""
    n = len(samples)
    intervals, knots = np.empty(n, INTERVAL), np.empty(n, KNOT)
    blocks, variation = np.empty(-(-n // BLOCK)), np.empty(n)
    numbers = fill(samples, step, intervals, knots, blocks, variation)
    return Tables(step, *numbers, samples, intervals, knots, blocks, variation)
