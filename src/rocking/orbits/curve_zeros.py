"""Points of a bifurcation curve, and zeros of a test function between neighbours, also two of them within one step."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from rocking.kernels.orbits import arclength
from rocking.kernels.orbits import bifurcation_curve as kernel
from rocking.orbits.event_chain import Chain, Condition, End, Special, problem_of
from rocking.orbits.grazing import rotated, turning_time
from rocking.orbits.normal_form import Chains, Reduced, chains_of
from rocking.orbits.parameter import with_value


class CurveRows(NamedTuple):
    """Points of a bifurcation curve in the unknowns of its equations, and what continues it."""

    chain: Chain
    condition: Condition
    names: tuple[str, str]
    limits: tuple[tuple[float, float], tuple[float, float]]
    step: float
    rows: np.ndarray  # (n, k + 2): phases and both parameters
    ends: tuple[End, End]  # reasons for the ends
    local: bool = False  # whether the time of the touch in the condition is that at all points

    def chain_at(self, row: np.ndarray) -> Chain:
        """Return the chain at a point, with its parameters."""
        system = self.chain.system
        for name, value in zip(self.names, row[-2:].tolist(), strict=True):
            system = with_value(system, name, value)
        return self.chain._replace(system=system, phases=row[:-2])

    def chains(self, rows: np.ndarray) -> Chains:
        """Return the chains at points of the curve."""
        return chains_of(self.chain, self.names, rows)

    def rotated(self) -> CurveRows:
        """Return the same curve with chains that begin one event later."""
        first = self.rows[:, :1] + self.chain.turn
        rows = np.concatenate([self.rows[:, 1:-2], first, self.rows[:, -2:]], axis=1)
        condition = self.condition
        if condition.kind == Special.GRAZING:
            condition = condition._replace(arc=(condition.arc - 1) % len(self.chain.kinds))
        return self._replace(chain=rotated(self.chain, 1), rows=rows, condition=condition)

    def corrected(self, near: np.ndarray, direction: np.ndarray) -> np.ndarray | None:
        """Return the point of the curve in the plane through a point near it across a direction; None if it is not found."""
        spans = [high - low for low, high in self.limits]
        problem = problem_of(self.chain, self.names, self.limits, self.step, spans)
        condition = self.condition
        if condition.kind == Special.GRAZING and not self.local:
            condition = condition._replace(
                time=turning_time(self.chain_at(near), self.names[1], near, condition)
            )
        out = np.empty((1, len(near)))
        start = arclength.Tangent(near.copy(), direction.copy())
        count, _ = kernel.follow_curve(problem, start, condition, out)
        return out[0] if count else None


TOLERANCE = 1e-13
"""Width of a bracket of a zero, in units of the distance of two points of the curve, at which the search ends."""
BLOCK = 2_000_000
"""Largest number of entries of the matrices of a block of points."""
SMALL = 1e-6
"""Largest value of a test function at a zero, relative to those at the points around it: a pole is no zero."""
STEEPER = 1.5
"""Factor of the estimated slopes of a test function; at most as large that a straight line with one zero is not divided."""
MARGIN = 0.1
"""Error of a slope, relative to the difference of the slopes at the ends of a step."""
SHORTEST = 2.0**-12
"""Shortest part of a step that is divided, so that two zeros within such a part may be missed."""

Values = Callable[[CurveRows, np.ndarray], Reduced]


class Test(NamedTuple):
    """Test function of a point of codimension two."""

    kind: str
    # values at rows of the curve, with directions on which their signs depend
    values: Values
    # the same in the chain that begins at the next event, if they name an arc
    later: Values | None = None

    @property
    def rotated(self) -> Test:
        """The test function in the chain that begins at the next event."""
        return self if self.later is None else self._replace(values=self.later)


class Bracket(NamedTuple):
    """Part of a step in which a test function changes its sign."""

    place: int  # index of the point before
    low: float
    high: float
    size: float  # largest value at the ends of the step
    direction: np.ndarray  # at the point before


class _LostError(Exception):
    """No point of the curve was found."""


class _Step(NamedTuple):
    """Step of a curve, along which a test function is evaluated."""

    rows: CurveRows
    test: Test
    place: int
    direction: np.ndarray

    def at(self, share: float) -> np.ndarray:
        """Return the point of the curve at a part of the step."""
        start, stop = self.rows.rows[self.place : self.place + 2]
        row = self.rows.corrected(
            start + share * (stop - start), (stop - start) / np.linalg.norm(stop - start)
        )
        if row is None:
            raise _LostError
        return row

    def value(self, share: float) -> float:
        """Return the test function at a part of the step."""
        (result,), (along,) = self.test.values(self.rows, self.at(share)[None])
        return float(-result if self.test.kind == "cusp" and along @ self.direction < 0.0 else result)

    @staticmethod
    def may_hide(ends: tuple[float, float], slopes: tuple[float, float]) -> bool:
        """Return whether a function may have more zeros in [0, 1] than the signs at the ends show.

        The Bernstein coefficients of a cubic polynomial change their sign at least as often as it has zeros in [0, 1]. The
        slopes are estimates. Their error is proportional to the curvature.
        """
        one, other = ends
        inner = one + STEEPER * slopes[0] / 3.0, other - STEEPER * slopes[1] / 3.0
        if one * other < 0.0:
            return one * inner[0] < 0.0 < one * inner[1]
        margin, sign = MARGIN * abs(slopes[1] - slopes[0]), math.copysign(1.0, one)
        return one * other > 0.0 and min(sign * inner[0], sign * inner[1]) < margin

    def parts(
        self, low: float, high: float, ends: tuple[float, float], slopes: tuple[float, float]
    ) -> Iterator[tuple[float, float]]:
        """Yield the parts in which the function changes its sign once."""
        (one, other), width = ends, high - low
        if self.may_hide(ends, (slopes[0] * width, slopes[1] * width)) and width > SHORTEST:
            middle = 0.5 * (low + high)
            value = self.value(middle)
            start, slope, stop = (
                4.0 * value - 3.0 * one - other,
                other - one,
                one - 4.0 * value + 3.0 * other,
            )
            yield from self.parts(low, middle, (one, value), (start / width, slope / width))
            yield from self.parts(middle, high, (value, other), (slope / width, stop / width))
        elif one * other < 0.0:
            yield low, high


def along(rows: CurveRows, test: Test) -> tuple[np.ndarray, np.ndarray]:
    """Return a test function at all points of the curve, of one sense of its direction, and these directions."""
    # blocks of rows, which bound the memory for the matrices
    block = max(1, BLOCK // (4 * len(rows.chain.kinds) ** 2))
    parts = [test.values(rows, rows.rows[i : i + block]) for i in range(0, len(rows.rows), block)]
    values, directions = (np.concatenate(part) for part in zip(*parts, strict=True))
    if test.kind == "cusp":
        turned = (directions[:-1] * directions[1:]).sum(axis=1) < 0.0
        signs = np.cumprod(np.append(1.0, np.where(turned, -1.0, 1.0)))
        values, directions = signs * values, signs[:, None] * directions
    return values, directions


def find_brackets(rows: CurveRows, test: Test) -> Iterator[Bracket]:
    """Yield the parts of steps in which a test function changes its sign, in order along the curve.

    Two zeros within one step do not change the sign between its ends. A step is divided if the slopes at its ends allow
    more zeros than the signs show.
    """
    values, directions = along(rows, test)
    lengths = np.linalg.norm(np.diff(rows.rows, axis=0), axis=1)
    slopes = _slopes(values, lengths)
    for i, length in enumerate(lengths.tolist()):
        ends = float(values[i]), float(values[i + 1])
        size = max(map(abs, ends))
        step = _Step(rows, test, i, directions[i])
        try:
            parts = list(step.parts(0.0, 1.0, ends, (slopes[i] * length, slopes[i + 1] * length)))
        except _LostError:
            parts = [(0.0, 1.0)] if ends[0] * ends[1] < 0.0 else []
        if len(parts) == 1:
            parts = [(0.0, 1.0)]  # one zero does not depend on the division
        for low, high in parts:
            yield Bracket(i, low, high, size, directions[i])


def _slopes(values: np.ndarray, lengths: np.ndarray) -> np.ndarray:
    """Return the derivative of a function at points with the given distances, from the parabola through three of them."""
    if len(values) < 3:
        return np.full(len(values), (values[-1] - values[0]) / lengths.sum())
    return np.asarray(np.gradient(values, np.append(0.0, lengths.cumsum()), edge_order=2))


def locate_zero(rows: CurveRows, test: Test, part: Bracket) -> tuple[np.ndarray, tuple[float, float]] | None:
    """Return the point in a bracket at which a test function vanishes, and the errors of both parameters, or None.

    The error is the difference from the same search in the chain that begins at the next event, which rounds differently.
    """
    row = _zero(_Step(rows, test, part.place, part.direction), part)
    later = _Step(rows.rotated(), test.rotated, part.place, np.roll(part.direction, -1))
    other = _zero(later, part)
    if row is None or other is None:
        return None
    ulps = 8.0 * np.finfo(float).eps * np.abs(row[-2:])
    first, second = (2.0 * np.abs(row[-2:] - other[-2:]) + ulps).tolist()
    return row, (first, second)


def _zero(step: _Step, part: Bracket) -> np.ndarray | None:
    """Return the point of a step at which a test function vanishes, or None."""
    from scipy.optimize import brentq

    try:
        share = float(brentq(step.value, part.low, part.high, xtol=TOLERANCE, rtol=TOLERANCE))
        return step.at(share) if abs(step.value(share)) <= SMALL * part.size else None
    except (_LostError, ValueError):
        return None
