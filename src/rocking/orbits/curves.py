"""Bifurcation curves: their points, zeros of test functions between neighbours, and their ends.

Two zeros may lie within one step. A curve ends where its orbits merge with those from which they bifurcate, or at a grazing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from rocking.kernels.orbits import arclength
from rocking.kernels.orbits import bifurcation_curve as kernel
from rocking.orbits import grazing, normal_form
from rocking.orbits.event_chain import Chain, Condition, End, Special, equations, problem_of
from rocking.orbits.normal_form import Chains, Reduced, chains_of
from rocking.orbits.parameter import with_value
from rocking.orbits.special_points import (
    CONDITION,
    FOLD,
    GRAZING,
    doubling,
    half_differences,
    multiplier_test,
    parent_of,
)


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

    def equations_at(self, row: np.ndarray) -> tuple[np.ndarray, np.ndarray, float, float]:
        """Return the equations of the orbit at a point, as `equations` does."""
        return equations(self.chain_at(row), self.names[1], np.append(row[:-2], row[-1]))

    @property
    def kind(self) -> str:
        """Kind of the special points."""
        if self.condition.kind == Special.GRAZING:
            return GRAZING
        return FOLD if self.condition.kind == Special.FOLD else doubling(self.chain.mirrored)

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
        return self._replace(chain=grazing.rotated(self.chain, 1), rows=rows, condition=condition)

    def corrected(self, near: np.ndarray, direction: np.ndarray) -> np.ndarray | None:
        """Return the point of the curve in the plane through a point near it across a direction; None if it is not found."""
        spans = [high - low for low, high in self.limits]
        problem = problem_of(self.chain, self.names, self.limits, self.step, spans)
        condition = self.condition
        if condition.kind == Special.GRAZING and not self.local:
            condition = condition._replace(
                time=grazing.turning_time(self.chain_at(near), self.names[1], near, condition)
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
NEARBY, NEIGHBOURS = 1e-9, 13
"""Distance from a zero, in units of a step, and number of points there, from which the scatter of a test function is known."""
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


def at_each(value: Callable[[CurveRows, np.ndarray], float]) -> Values:
    """Return the values of a test function from that at one row; their signs depend on no direction."""
    return lambda rows, at: Reduced(np.array([value(rows, row) for row in at], float), np.ones((len(at), 1)))


def degenerate(kind: str) -> Test:
    """Return the test function of a degenerate period doubling or symmetry breaking: the cubic coefficient."""
    return Test(f"degenerate-{kind}", lambda rows, at: normal_form.doublings(rows.chains(at)))


def on_grazings(kind: str) -> Test:
    """Return the test function of a bifurcation on a curve of grazings: a multiplier is 1, or −1."""
    multiplier = 1.0 if kind == FOLD else -1.0
    return Test(
        f"{kind}-grazing", at_each(lambda rows, row: multiplier_test(*rows.equations_at(row)[2:], multiplier))
    )


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

    The error has two parts: the difference from the same search in the chain that begins at the next event, which rounds
    differently, and the scatter of the test function about a straight line, over its slope.
    """
    step = _Step(rows, test, part.place, part.direction)
    later = _Step(rows.rotated(), test.rotated, part.place, np.roll(part.direction, -1))
    one, other = _zero(step, part), _zero(later, part)
    if one is None or other is None:
        return None
    row, scatter = one
    ulps = 8.0 * np.finfo(float).eps * np.abs(row[-2:])
    first, second = (2.0 * np.abs(row - other[0])[-2:] + 3.0 * scatter + ulps).tolist()
    return row, (first, second)


def _zero(step: _Step, part: Bracket) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the point of a step at which a test function vanishes, and the scatter of both parameters there; None without one."""
    from scipy.optimize import brentq

    try:
        share = float(brentq(step.value, part.low, part.high, xtol=TOLERANCE, rtol=TOLERANCE))
        row = step.at(share)
        small = abs(step.value(share)) <= SMALL * part.size
        return (row, _scatter(step, share)) if small else None
    except (_LostError, ValueError):
        return None


def _scatter(step: _Step, share: float) -> np.ndarray:
    """Return the scatter of both parameters of a zero, from the values of the test function around it."""
    offsets = NEARBY * np.linspace(-1.0, 1.0, NEIGHBOURS)
    values = np.array([step.value(share + offset) for offset in offsets.tolist()])
    line = np.polyfit(offsets, values, 1)
    spread = math.sqrt(float(np.square(values - np.polyval(line, offsets)).sum()) / (NEIGHBOURS - 2))
    start, stop = step.rows.rows[step.place : step.place + 2, -2:]
    return np.abs(stop - start) * (spread / abs(float(line[0])))


LOST_WITHIN = 0.1
"""Largest distance of the halves of a chain, in rad, at the end of a curve that is lost because they become equal.

With any step, curves were lost at distances from 0.005 to 0.01.
"""
REACHES = (2.0, 4.0, 8.0)
"""Lengths beyond the last point, in units of the extrapolated one, in which an end is searched for."""


class CurveEnd(NamedTuple):
    """End of a curve, on the same curve or on that of the orbits from which its orbits bifurcate."""

    kind: str  # of the test function
    rows: CurveRows
    row: np.ndarray
    errors: tuple[float, float]


def until_parent(rows: CurveRows, start: int) -> CurveRows:
    """Return a curve of folds up to the points at which its orbits merge with those from which they bifurcate.

    Both halves of the chain are equal at such a point, and change places beyond. The curve then has the same orbits again,
    one half of a chain later, or their mirror images. The equations are singular at this point, so that rounding decides if the
    kernel passes it.

    Parameters
    ----------
    rows : CurveRows
        Points of the curve.
    start : int
        Index of the point from which it was followed.

    Returns
    -------
    CurveRows
        Points between two such points, and those that do not lie beyond one.
    """
    if rows.kind != FOLD or parent_of(rows.chain) is None:
        return rows
    points, (first, last) = rows.rows, rows.ends
    differences = half_differences(rows.chain, points[:, :-1])
    swaps = np.flatnonzero((differences[:-1] * differences[1:]).sum(axis=1) < 0.0)
    before, after = swaps[swaps < start], swaps[swaps >= start]
    if last == End.CLOSED and len(swaps):
        # the last point lies beyond the first one
        points = np.concatenate([points[swaps[-1] + 1 : -1], points[: swaps[0] + 1]])
        return rows._replace(rows=points, ends=(End.MERGED, End.MERGED))
    low, high = 0, len(points)
    if len(before):
        low, first = int(before[-1]) + 1, End.MERGED
    if len(after):
        high, last = int(after[0]) + 1, End.MERGED
    cut = rows._replace(rows=points[low:high])
    first = End.MERGED if first == End.LOST and _nears_merger(cut.rows, cut) else first
    last = End.MERGED if last == End.LOST and _nears_merger(cut.rows[::-1], cut) else last
    return cut._replace(ends=(first, last))


def _nears_merger(inwards: np.ndarray, rows: CurveRows) -> bool:
    """Return whether both halves of the chain are almost equal at an end of a curve, and less so inwards."""
    distance = np.linalg.norm(half_differences(rows.chain, inwards[:1, :-1]))
    return bool(distance <= LOST_WITHIN) and _extrapolate_merger(inwards, rows) is not None


def _extrapolate_merger(inwards: np.ndarray, rows: CurveRows) -> tuple[int, float] | None:
    """Extrapolate the points at an end of a curve to the place at which both halves of the chain are equal.

    The parameters are linear in the squared distance of the halves.

    Returns
    -------
    tuple of (int, float) or None
        Index of a point whose squared distance is more than twice that of the first point.
        Distance of the place from the first point, as a fraction of the distance of these two points.
        None if there is no such point.
    """
    squares = (half_differences(rows.chain, inwards[:, :-1]) ** 2).sum(axis=1)
    far = int(np.argmax(squares > 2.0 * squares[0]))
    if far == 0:
        return None
    return far, float(squares[0] / (squares[far] - squares[0]))


def degenerate_end(rows: CurveRows, inwards: np.ndarray) -> CurveEnd | None:
    """Return the end of a curve of folds at which its orbits merge with those from which they bifurcate, or None.

    The bifurcation of the other orbits is degenerate there. The point is solved on their curve, which is regular.

    Parameters
    ----------
    rows : CurveRows
        Curve of folds.
    inwards : ndarray, shape (n, k + 2)
        Its points, beginning at this end.
    """
    parent, result = parent_of(rows.chain), _extrapolate_merger(inwards, rows)
    if parent is None or result is None:
        return None
    far, share = result
    other = rows._replace(chain=parent, condition=CONDITION)
    chord = mean_halves(inwards[0], parent) - mean_halves(inwards[far], parent)
    start = other.corrected(mean_halves(inwards[far], parent), chord / np.linalg.norm(chord))
    test = degenerate(doubling(parent.mirrored))
    reaches = [1.0 + reach * share for reach in REACHES]
    return None if start is None else zero_between(other, test, start, chord, reaches)


def mean_halves(row: np.ndarray, parent: Chain) -> np.ndarray:
    """Return a point with the mean phases of both halves of a chain."""
    half = len(parent.kinds)
    return np.append(0.5 * (row[:half] + row[half:-2] - parent.turn), row[-2:])


def zero_between(
    rows: CurveRows, test: Test, start: np.ndarray, chord: np.ndarray, reaches: Sequence[float]
) -> CurveEnd | None:
    """Return the zero of a test function between a point and one at some chords from it, or None."""
    for reach in reaches:
        stop = rows.corrected(start + reach * chord, chord / np.linalg.norm(chord))
        if stop is None:
            continue
        part = rows._replace(rows=np.stack([start, stop]))
        (first, last), directions = test.values(part, part.rows)
        if first * last < 0.0:
            result = locate_zero(part, test, Bracket(0, 0.0, 1.0, max(abs(first), abs(last)), directions[0]))
            return None if result is None else CurveEnd(test.kind, part, *result)
    return None


AHEAD = (3.0, 5.0, 9.0, -3.0)
"""Distances from the last point, in units of the last step before a grazing, in which it is searched for."""
AROUND = (3.0, -3.0, 9.0, -9.0, 27.0, -27.0, 81.0, -81.0)
"""Distances from the last point on another curve through the end, on both sides."""
EQUAL_AT_GRAZING = 1e-2
"""Largest distance of the halves of a chain, in rad, at the last point of a curve before a grazing at which they are equal.

This point lies within `arclength.GRAZING_STEP`. With any step, such distances were below 2e-4, and others above 0.5.
"""


def grazing_end(rows: CurveRows, inwards: np.ndarray) -> CurveEnd | None:
    """Return the end of a curve at a grazing, or None if its place is not known.

    Parameters
    ----------
    rows : CurveRows
        Curve.
    inwards : ndarray, shape (n, k + 2)
        Its points, beginning at this end. The grazing lies within the last step, which is `arclength.GRAZING_STEP` at most.

    Returns
    -------
    CurveEnd or None
        The end; its kind is "grazing" where a further contact touches.
    """
    if len(inwards) < 2:
        return None
    for search in (_merged_end, _vanished_end, _touching_end):
        result = search(rows, inwards)
        if result is not None:
            return result
    return None


def _merged_end(rows: CurveRows, inwards: np.ndarray) -> CurveEnd | None:
    """Return the end of a curve of grazings, at which its orbits merge with those from which they bifurcate, or None.

    Both halves of such an orbit touch there. The point is solved on the curve of grazings of the other orbits, where a multiplier
    is −1.
    """
    if rows.kind != GRAZING:
        return None
    own = _locally(rows, inwards[0]).condition
    result = _half_of(rows.chain, own, inwards[0])
    if result is None:
        return None
    parent, touch, near = result
    other = rows._replace(chain=parent, condition=touch, local=True)
    return _around(other, on_grazings(doubling(parent.mirrored)), near)


def _half_of(chain: Chain, touch: Condition, row: np.ndarray) -> tuple[Chain, Condition, np.ndarray] | None:
    """Return the chain, the touch and the phases of an orbit that repeats after half a chain, almost; None if it does not."""
    parent = parent_of(chain)
    if parent is None or np.abs(half_differences(chain, row[None, :-1])).max() > EQUAL_AT_GRAZING:
        return None
    return parent, touch._replace(arc=touch.arc % len(parent.kinds)), mean_halves(row, parent)


def _vanished_end(rows: CurveRows, inwards: np.ndarray) -> CurveEnd | None:
    """Return the end of a curve at a grazing, where a contact of its orbits vanishes, or None.

    The orbits without this contact are regular there. On a curve of grazings they touch at two instants, which may be the same
    one of a shorter period. On another curve, and there, their return map is degenerate: with the contact, the multipliers of
    other orbits nearby are without bound.
    """
    chain = rows.chain_at(inwards[0])
    links = rows.equations_at(inwards[0])[1]
    for touch in grazing.slow_event(chain, links):
        kept, near = touch.chain, np.append(touch.chain.phases, inwards[0, -2:])
        other, test = rows._replace(chain=kept, condition=touch.condition, local=True), DEGENERATE_GRAZING
        if rows.kind == GRAZING:
            own = _without(_locally(rows, inwards[0]).condition, chain, kept)
            result = _half_of(kept, touch.condition, near)
            if result is not None:
                parent, condition, near = result
                other = other._replace(chain=parent, condition=condition)
            else:
                other = other._replace(condition=own)
                test = _touches(other, touch.condition)
        end = _around(other, test, near)
        if end is not None:
            return end
    return None


def _touching_end(rows: CurveRows, inwards: np.ndarray) -> CurveEnd | None:
    """Return the end of a curve at a grazing, where a turning point of an arc reaches the base or a brace, or None.

    Beyond this end the equations of the chain remain regular, so that the clearance of the turning point changes its sign.
    """
    here = _locally(rows, inwards[0])
    chord = _shortest(rows, inwards[0] - inwards[1])
    for contact in _contacts(here, inwards[0]):
        result = zero_between(here, _touches(here, contact), inwards[0], chord, AHEAD)
        if result is not None:
            return result
    return None


def _around(rows: CurveRows, test: Test, near: np.ndarray) -> CurveEnd | None:
    """Return the zero of a test function on a curve close to a point near it, in either direction, or None."""
    across = np.zeros(len(near))
    for which in (-1, -2):
        across[:], across[which] = 0.0, 1.0
        start = rows.corrected(near, across)
        if start is None:
            continue
        off = start.copy()
        off[which] += arclength.GRAZING_STEP * rows.step * (rows.limits[which][1] - rows.limits[which][0])
        other = rows.corrected(off, across)
        if other is None:
            continue
        result = zero_between(rows, test, start, _shortest(rows, other - start), AROUND)
        if result is not None:
            return result
    return None


def _shortest(rows: CurveRows, chord: np.ndarray) -> np.ndarray:
    """Return a chord with the length of the last step before a grazing."""
    spans = np.array([high - low for low, high in rows.limits])
    size = math.sqrt(np.mean(chord[:-2] ** 2) + ((chord[-2:] / spans) ** 2).sum())
    return arclength.GRAZING_STEP * rows.step / size * chord


def _locally(rows: CurveRows, row: np.ndarray) -> CurveRows:
    """Return a curve with the time of the touch at one point, near which a second turning point may be as close."""
    if rows.kind != GRAZING:
        return rows
    time = grazing.turning_time(rows.chain_at(row), rows.names[1], row, rows.condition)
    return rows._replace(condition=rows.condition._replace(time=time), local=True)


def _without(own: Condition, chain: Chain, kept: Chain) -> Condition:
    """Return the condition of a chain in the same one without a contact, which begins at another event."""
    begins = int(np.flatnonzero(chain.phases == kept.phases[0])[0])
    k, last = len(chain.kinds), len(kept.kinds) - 1
    arc, phases = (own.arc - begins) % k, grazing.rotated(chain, begins).phases
    if arc <= last:
        return own._replace(arc=arc)
    later = float(phases[arc] - phases[last]) / chain.system.harmonic.frequency
    return own._replace(arc=last, time=own.time + later)


def _touches(rows: CurveRows, contact: Condition) -> Test:
    """Return the test function that is the clearance of a turning point."""
    later = contact._replace(arc=(contact.arc - 1) % len(rows.chain.kinds))
    return Test(GRAZING, _clearance_of(contact), _clearance_of(later))


def _contacts(rows: CurveRows, row: np.ndarray) -> list[Condition]:
    """Return the turning points of the arcs at a point of a curve, the closest to the base or a brace first."""
    chain = rows.chain_at(row)
    links = rows.equations_at(row)[1]
    own = rows.condition
    return [
        touch.condition
        for touch in grazing.near_contacts(chain, links)
        if own.kind != Special.GRAZING
        or (touch.condition.arc, touch.condition.level) != (own.arc, own.level)
        or abs(touch.condition.time - own.time) > grazing.CLOSE
    ]


def _clearance_of(contact: Condition) -> Values:
    """Return the values of the test function that is the clearance of a turning point."""
    return at_each(lambda rows, row: grazing.clearance(rows.chain_at(row), rows.names[1], row, contact))


def _slope_of_return(rows: CurveRows, row: np.ndarray) -> float:
    """Return the derivative of the angle at a touch by the velocity at the touch before.

    With the contact, this derivative is multiplied by the inverse of its speed in the trace of the return map.
    """
    chain, condition = rows.chain_at(row), rows.condition
    _, time = grazing.turning_point(chain, rows.names[1], row, condition)
    return grazing.slope_of_return(chain, rows.names[1], row, condition._replace(time=time))


DEGENERATE_GRAZING = Test("degenerate-grazing", at_each(_slope_of_return))
