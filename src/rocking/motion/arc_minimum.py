"""Extremes of a function along a motion: a grid on every arc, refined around each possible extreme."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Measure = Callable[[Array, Array], Array]

POINTS_PER_PERIOD = 32
POINTS_AT_ONCE = 500_000


class Arcs(NamedTuple):
    """Arcs of a motion between two events, with the side (−1, 0 at rest, 1) of the block on each."""

    starts: Array
    ends: Array
    sides: Array

    def where(self, chosen: NDArray[np.bool_]) -> Arcs:
        """Return the selected arcs."""
        return Arcs(*(column[chosen] for column in self))


class Extreme(NamedTuple):
    """Value and time of an extreme; of equal values, the earlier one is the smaller."""

    value: float
    time: float


NOTHING = Extreme(math.inf, 0.0)


def global_minimum(measure: Measure, arcs: Arcs, scale: float) -> Extreme:
    """Return the smallest value of a function of times and sides over all arcs.

    The function varies over times of `scale`. The minimum can lie next to a grid point that is no higher than its
    neighbours. It is then no further below this point than the neighbours are above it, because the function is convex
    there. Only points where this bound is not above the lowest grid value are refined.
    """
    from scipy.optimize import elementwise

    best = NOTHING
    for times, sides, which in grids(arcs, scale):
        values = measure(times, sides)
        best = min(best, lowest(values, times))
        before, here, after = values[:-2], values[1:-1], values[2:]
        bracketed = (which[:-2] == which[2:]) & (here <= before) & (here <= after) & np.isfinite(here)
        chosen = np.flatnonzero(bracketed)
        chosen = chosen[2 * here[chosen] - np.maximum(before, after)[chosen] <= best.value]
        if chosen.size:
            bracket = (times[chosen], times[chosen + 1], times[chosen + 2])
            refined = elementwise.find_minimum(measure, bracket, args=(sides[chosen + 1],))
            best = min(best, lowest(refined.f_x, refined.x))
    return best


def lowest(values: Array, times: Array) -> Extreme:
    """Return the smallest of the given values, with its time."""
    index = int(np.argmin(values))
    return Extreme(float(values[index]), float(times[index]))


def grids(arcs: Arcs, scale: float) -> Iterator[tuple[Array, Array, NDArray[np.intp]]]:
    """Yield times on the arcs, both ends included, with the side and the index of the arc of each.

    The last time on an arc is the floating-point number before its final event.
    """
    steps = 8 + np.ceil(POINTS_PER_PERIOD * (arcs.ends - arcs.starts) / scale)
    steps = np.minimum(steps, POINTS_AT_ONCE).astype(int)
    batches = np.cumsum(steps) // POINTS_AT_ONCE
    for batch in np.unique(batches):
        chosen, points = arcs.where(batches == batch), steps[batches == batch] + 1
        which = np.repeat(np.arange(points.size), points)
        step = np.arange(which.size) - (np.cumsum(points) - points)[which]
        times = chosen.starts[which] + (chosen.ends - chosen.starts)[which] * (step / (points[which] - 1))
        yield np.minimum(times, np.nextafter(chosen.ends, -math.inf)[which]), chosen.sides[which], which
