"""Branch and bound: the smallest value of a smooth quotient along a motion, and the first time at which it is below a level.

A cell of time is divided as long as a lower bound, from the Chebyshev series on it, admits a smaller value.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

Array = NDArray[np.float64]
Quotient = Callable[[Array, Array], tuple[Array, Array]]
"""Function of times and sides (n,). It returns numerators (k, n) and their common denominator (n,), all of them smooth."""

CELLS_PER_SCALE = 8
CELLS_AT_ONCE = 60_000
HALVINGS = 14
"""Largest number of divisions of a cell. After them, a cell is so short that the quotient changes by rounding alone."""
TOLERANCE = 1e-12
"""Relative error of the smallest value."""
DEGREE = 6
NODES = chebyshev.chebpts2(DEGREE + 1)
TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(NODES, DEGREE)).T
_ORDER = np.arange(DEGREE + 1.0)
BELOW_CHORD = 2 * np.max(np.diff(NODES)) ** 2 / 8 * _ORDER**2 * (_ORDER**2 - 1) / 3
"""Depth below the chords between nodes, for each coefficient of a Chebyshev series, doubled for what the series omits.

It is at most an eighth of the squared distance of the nodes, times the largest second derivative.
"""


class Arcs(NamedTuple):
    """Pieces of a motion without an event, on which the base acceleration is smooth, with the side (−1, 0 at rest, 1) on each."""

    starts: Array
    ends: Array
    sides: Array

    def where(self, chosen: NDArray[np.bool_]) -> Arcs:
        """Return the selected arcs."""
        return Arcs(*(column[chosen] for column in self))

    def divided(self, parts: NDArray[np.intp]) -> Arcs:
        """Divide each arc into a number of equal parts."""
        which = np.repeat(np.arange(parts.size), parts)
        step = np.arange(which.size) - (np.cumsum(parts) - parts)[which]
        starts, lengths = self.starts[which], (self.ends - self.starts)[which]
        begins = starts + lengths * (step / parts[which])
        ends = np.where(
            step + 1 == parts[which], self.ends[which], starts + lengths * ((step + 1) / parts[which])
        )
        return Arcs(begins, ends, self.sides[which])


class Extreme(NamedTuple):
    """Value and time of an extreme; of equal values, the earlier one is the smaller."""

    value: float
    time: float


NOTHING = Extreme(math.inf, 0.0)


def global_minimum(quotient: Quotient, arcs: Arcs, scale: float) -> Extreme:
    """Return the smallest value of a quotient over all arcs; −∞ where its denominator is not positive.

    Numerators and denominator vary over times of `scale`. A value below μ, the smallest one found so far, means that a
    numerator minus μ times the denominator is negative. This difference is smooth, also where the denominator is nearly 0.
    A cell is divided in two as long as the Chebyshev series of the difference admits a negative value between its nodes.
    """
    best = NOTHING
    for batch in _cells(arcs, scale):
        cells = batch
        for _ in range(HALVINGS):
            best, open_ = _improved(quotient, cells, best)
            cells = cells.where(open_)
            if best.value == -math.inf or not cells.starts.size:
                break
            cells = cells.divided(np.full(cells.starts.size, 2))
    return best


def first_time(quotient: Quotient, level: float, arcs: Arcs, scale: float) -> float:
    """Return the first time at which a quotient is below a level, or its denominator is not positive; infinite if there is none.

    Then a numerator minus the level times the denominator is negative. Cells without a negative value by the bound of
    `global_minimum` are left out, and so are those after the first one with a negative value. The others are divided in two.
    """
    for batch in _cells(arcs, scale):
        cells = batch
        for halving in range(HALVINGS + 1):
            times = _nodes(cells)
            tops, bottom = quotient(times.ravel(), np.repeat(cells.sides, NODES.size))
            over, allowed = _over(tops, level, bottom, times.shape)
            below: NDArray[np.bool_] = np.any(over < -allowed[..., None], axis=0)
            open_ = _can_be_negative(over, allowed)
            fallen = np.flatnonzero(np.any(below, axis=1))
            if fallen.size:
                open_[fallen[0] + 1 :] = False
            if not open_.any():
                break
            if halving == HALVINGS and fallen.size:
                which = fallen[0]
                return _crossing(
                    quotient, level, times[which], int(np.argmax(below[which])), cells.sides[which]
                )
            cells = cells.where(open_).divided(np.full(np.count_nonzero(open_), 2))
    return math.inf


def _crossing(quotient: Quotient, level: float, nodes: Array, node: int, side: float) -> float:
    """Return the time at which a quotient falls below a level, before a node where it is below."""
    from scipy.optimize import brentq

    def least(time: float) -> float:
        tops, bottom = quotient(np.array([time]), np.array([side]))
        return float((tops - level * bottom).min())

    before = float(nodes[max(node - 1, 0)])
    return float(brentq(least, before, float(nodes[node]), xtol=1e-300)) if least(before) > 0 else before


def _improved(quotient: Quotient, cells: Arcs, best: Extreme) -> tuple[Extreme, NDArray[np.bool_]]:
    """Return the smallest value at the nodes of all cells and before, and the cells that can hold a smaller one."""
    times = _nodes(cells)
    tops, bottom = quotient(times.ravel(), np.repeat(cells.sides, NODES.size))
    values = np.divide(tops.min(axis=0), bottom, out=np.full(bottom.size, -math.inf), where=bottom > 0)
    lowest = int(np.argmin(values))
    best = min(best, Extreme(float(values[lowest]), float(times.flat[lowest])))
    if best.value == -math.inf:
        return best, np.zeros(cells.starts.size, bool)
    return best, _can_be_negative(*_over(tops, best.value, bottom, times.shape))


def _nodes(cells: Arcs) -> Array:
    """Return the times of the nodes of all cells."""
    middles, halves = (cells.starts + cells.ends) / 2, (cells.ends - cells.starts) / 2
    return np.clip(middles[:, None] + halves[:, None] * NODES, cells.starts[:, None], cells.ends[:, None])


def _over(tops: Array, level: float, bottom: Array, shape: tuple[int, ...]) -> tuple[Array, Array]:
    """Return numerators minus the level times the denominator at the nodes of each cell, and their rounding error in each."""
    over = (tops - level * bottom).reshape(len(tops), *shape)
    size = (np.abs(tops) + abs(level) * np.abs(bottom)).reshape(over.shape).max(axis=-1)
    return over, TOLERANCE * size


def _can_be_negative(over: Array, allowed: Array) -> NDArray[np.bool_]:
    """Return the cells whose Chebyshev series admit a value below the rounding error between the nodes."""
    least = over.min(axis=-1) - np.abs(over @ TO_COEFFICIENTS) @ BELOW_CHORD
    return (least < -allowed).any(axis=0)


def _cells(arcs: Arcs, scale: float) -> Iterator[Arcs]:
    """Yield the arcs, divided into cells that are short against `scale`, some at a time."""
    parts = np.clip(np.ceil(CELLS_PER_SCALE * (arcs.ends - arcs.starts) / scale), 1, CELLS_AT_ONCE).astype(
        int
    )
    batches = np.cumsum(parts) // CELLS_AT_ONCE
    for batch in np.unique(batches):
        yield arcs.where(batches == batch).divided(parts[batches == batch])
