"""Special points of a branch: their kinds, the tests that find and name them, and where two passages are the same point.

A bifurcation lies where a multiplier of the return map is 1 or −1, and a grazing where an arc just touches the base or a brace. The
compiled loop of chains of events finds both, and `KINDS` names them. `special_points` corrects its list where a branch passes the branch
from which it bifurcates. `special_points_between` finds the bifurcations of the return map of the full block.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple, Protocol, TypeVar

import numpy as np
from attrs import field, frozen

from rocking.kernels.orbits import continuation as kernel
from rocking.model.orbit import Orbit
from rocking.model.validation import WrongType
from rocking.orbits.event_chain import IMPACT, Chain, Condition, Special, equations, orbit_at, sides_of
from rocking.orbits.grazing import GrazingContact, grazing_at, special_row

FOLD, SYMMETRY_BREAKING, PERIOD_DOUBLING, GRAZING = (
    "fold",
    "symmetry-breaking",
    "period-doubling",
    "grazing",
)
KINDS = {
    Special.FOLD: FOLD,
    Special.SYMMETRY_BREAKING: SYMMETRY_BREAKING,
    Special.PERIOD_DOUBLING: PERIOD_DOUBLING,
    Special.GRAZING: GRAZING,
}
"""Names of the special points that the compiled loop of chains finds."""
BEGINS_BRANCH = (SYMMETRY_BREAKING, PERIOD_DOUBLING)
"""Bifurcations at which another branch begins."""


def doubling(mirrored: bool) -> str:
    """Return the kind of the bifurcation where a multiplier of a return map is −1: over half a period, if it is mirrored."""
    return SYMMETRY_BREAKING if mirrored else PERIOD_DOUBLING


def multiplier_test(trace: float, determinant: float, multiplier: float) -> float:
    """Return the test function that vanishes where a multiplier of a return map is 1, or −1."""
    return 1.0 - multiplier * trace + determinant


class Origin(NamedTuple):
    """Branch on which a special point was met."""

    counts: tuple[int, int]  # impacts and brace impacts per period
    side: float  # on which side of the special point the parameter of its points lies: -1 or 1


@frozen(eq=False)
class SpecialPoint:
    """Special point of a branch: a bifurcation or a grazing.

    Attributes
    ----------
    kind : str
        Type of the point:

        - "fold": two orbits meet and vanish;
        - "symmetry-breaking": two asymmetric orbits, mirror images of each other, branch off a symmetric one;
        - "period-doubling": an orbit of twice the period branches off;
        - "grazing": the block just touches the base or a brace. Beyond, the orbit has an impact more or less.
    parameter : float
        Value of the parameter.
    orbit : Orbit
        Orbit at this point. At a grazing, it is the orbit without the grazing impact, because its multipliers would be
        infinite with it.
    name : str
        Name of the parameter.
    index : int
        The point lies between the points `index - 1` and `index` of its branch. A grazing is the first or last point, unless
        the orbit rests: its branch then continues.

    Notes
    -----
    A branch turns where it meets the branch from which it bifurcates. There it has a symmetry breaking or a period doubling, as
    the other branch has, and `orbit` is the orbit of the other branch.

    In a simulation of a grazing orbit, rounding decides if the grazing impact occurs. If it does, with a speed of about
    10⁻⁸, the motion leaves the orbit, and `orbit.residual` is the resulting distance. `continue_orbit` therefore rejects this
    orbit. Use a neighbouring one, `branch.orbit(index)`.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    >>> print(branch.special[0])
    symmetry-breaking at amplitude 23.18505548: symmetric orbit of period 1 with 2 impacts
    """

    kind: str
    parameter: float
    orbit: Orbit
    name: str
    index: int
    _chain: Chain | None = field(repr=False)  # None for a full or an unsymmetric block
    _row: np.ndarray = field(repr=False)
    _touch: GrazingContact | None = field(default=None, repr=False)
    _origin: Origin | None = field(default=None, repr=False)

    def __str__(self) -> str:
        return f"{self.kind} at {self.name} {self.parameter:.10g}: {self.orbit}"


def chain_at(special: SpecialPoint) -> Chain:
    """Return the chain of events at a special point; TypeError for a full block or an orbit that rests, which have none."""
    if special.orbit.superstable:
        allowed = "be that of an orbit without rest and without sustained contact with a brace"
        raise WrongType("special", allowed, f"a {special.kind} of an orbit that rests")
    if special._chain is None:
        allowed = "be that of a slender, symmetric block, whose orbits are chains in closed form"
        full = special.orbit.system.critical_angle
        got = "an unsymmetric block" if full is None else f"critical_angle {full}"
        raise WrongType("special", allowed, got)
    return special._chain


# Largest distance of the two halves of a chain, in rad of phase, at which they are equal to rounding.
EQUAL = 1e-8
# The same at a special point from the kernel, which rounding moves along the branch.
NEARLY_EQUAL = 1e-4
# Largest relative difference of the parameter of such a point from the solved one; it is quadratic in the distance.
SAME_VALUE = 1e-5
# Largest difference of phases for two solved points to be identical.
SAME_PHASE = 1e-6
# Largest test function at a special point, relative to the sum of its terms. This ratio is 1 where the trace is infinite.
VANISHES = 0.5
CONDITION = Condition(Special.PERIOD_DOUBLING, -1, IMPACT, 0.0)
"""Condition of a multiplier −1 of the chains from which others bifurcate."""


class Found(NamedTuple):
    """Special point of a branch of chains, in the unknowns of its equations."""

    chain: Chain
    row: np.ndarray
    kind: str
    place: int  # index of the point of the branch after it


def special_points(chain: Chain, parameter: str, table: kernel.BranchTable) -> tuple[SpecialPoint, ...]:
    """Return the special points of a branch of chains, with one at each passage of the branch from which it bifurcates.

    The branch turns where it meets that one. The test function of a fold vanishes there without a change of sign. Rounding
    therefore decides if the compiled loop finds the point, how often, and under which name. Here it is found by the two halves of
    the chain, which are equal there and change places. The orbit there is one of the other branch, on which the point is solved.
    """
    found = [
        Found(chain, row, KINDS[Special(kind)], index)
        for row, (kind, index) in zip(table.specials, table.changes.tolist(), strict=True)
        if kind == Special.GRAZING or _is_zero(chain, parameter, row)
    ]
    parent = parent_of(chain)
    if parent is not None:
        found = _with_passages(found, chain, parent, parameter, table.rows)
    return tuple(_special_point(one, parameter, _beside(table.rows, one.place)) for one in found)


def _with_passages(
    found: list[Found], chain: Chain, parent: Chain, parameter: str, rows: np.ndarray
) -> list[Found]:
    """Return special points in order along a branch, with one at each passage of the branch of other orbits."""
    passages: list[Found] = []
    others = []
    for one in found:
        near = None
        if _has_multiplier_one(one, parameter):
            near = _solved(parent, parameter, one.row, one.place, NEARLY_EQUAL)
        if near is None or not abs(near.row[-1] - one.row[-1]) <= SAME_VALUE * abs(one.row[-1]):
            others.append(one)
        else:
            _add(passages, near)
    differences = half_differences(chain, rows)
    clear = np.flatnonzero(np.abs(differences).max(axis=1) > EQUAL)
    for before, after in zip(clear[:-1].tolist(), clear[1:].tolist(), strict=True):
        if differences[before] @ differences[after] < 0.0:
            near = _between(parent, parameter, rows[before], rows[after], after)
            if near is not None:
                _add(passages, near)
    return sorted(others + passages, key=lambda one: one.place)


def parent_of(chain: Chain) -> Chain | None:
    """Return the chain of the orbits that repeat, or mirror themselves, after half a chain; None if there are none."""
    half, odd = divmod(len(chain.kinds), 2)
    if odd or chain.mirrored or not np.array_equal(chain.kinds[:half], chain.kinds[half:]):
        return None
    mirrored = chain.period % 2 == 1
    if (chain.kinds[:half] == IMPACT).sum() % 2 != mirrored:
        return None
    period = chain.period if mirrored else chain.period // 2
    return chain._replace(
        period=period, mirrored=mirrored, kinds=chain.kinds[:half].copy(), phases=chain.phases[:half]
    )


def _is_zero(chain: Chain, parameter: str, row: np.ndarray) -> bool:
    """Return whether a test function has a zero at a point, and not a pole: at a grazing the trace is infinite, of either sign."""
    *_, trace, determinant = equations(chain, parameter, row)
    least = abs(abs(trace) - 1.0 - determinant)
    return bool(least <= VANISHES * (1.0 + abs(trace) + determinant))


def _has_multiplier_one(special: Found, parameter: str) -> bool:
    """Return whether a multiplier of a special point is 1; at a period doubling of the branch itself it is -1."""
    if special.kind == GRAZING:
        return False
    *_, trace, determinant = equations(special.chain, parameter, special.row)
    return abs(multiplier_test(trace, determinant, 1.0)) < abs(multiplier_test(trace, determinant, -1.0))


def half_differences(chain: Chain, rows: np.ndarray) -> np.ndarray:
    """Return the distances of the phases of the second half of a chain from half a turn after those of the first."""
    half = len(chain.kinds) // 2
    return np.asarray(rows[:, half:-1] - rows[:, :half] - 0.5 * chain.turn)


def _between(
    parent: Chain, parameter: str, before: np.ndarray, after: np.ndarray, index: int
) -> Found | None:
    """Return the point between two points of a branch at which the halves of the chain change places."""
    here, there = (np.linalg.norm(_halves(parent, row)[1]) for row in (before, after))
    row = before + here / (here + there) * (after - before)
    return _solved(parent, parameter, row, index, float(here + there))


def _halves(parent: Chain, row: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean phases of both halves of a chain, and their distance."""
    half = len(parent.kinds)
    first, second = row[:half], row[half:-1] - parent.turn
    return 0.5 * (first + second), second - first


def _solved(parent: Chain, parameter: str, near: np.ndarray, index: int, reach: float) -> Found | None:
    """Return the special point of the other branch within a distance from a point, or None."""
    phases, differences = _halves(parent, near)
    if np.abs(differences).max() > reach:
        return None
    there = special_row(parent, CONDITION, parameter, np.append(phases, near[-1]))
    if there is None or np.abs(there[:-1] - phases).max() > reach:
        return None
    return Found(parent._replace(phases=there[:-1]), there, doubling(parent.mirrored), index)


def _add(passages: list[Found], point: Found) -> None:
    """Add a point unless it is known: rounding, or the overlap of a closed branch, may show it twice."""
    if all(np.abs(one.row[:-1] - point.row[:-1]).max() > SAME_PHASE for one in passages):
        passages.append(point)


def _beside(rows: np.ndarray, index: int) -> float:
    """Return the parameter of a point of a branch near a special point, but not at its end."""
    return float(rows[min(max(index, 1), max(len(rows) - 2, 0)), -1])


def _special_point(found: Found, parameter: str, beside: float) -> SpecialPoint:
    """Return a special point with its orbit; ``beside`` is the parameter of a point of its branch near it."""
    chain, row, touch = found.chain, found.row, None
    if found.kind == GRAZING:
        orbit, chain, row, touch = grazing_at(chain, parameter, row)
    else:
        orbit = orbit_at(chain, parameter, row)
    return SpecialPoint(
        kind=found.kind,
        parameter=float(row[-1]),
        orbit=orbit,
        name=parameter,
        index=found.place,
        chain=chain,
        row=row.copy(),
        touch=touch,
        origin=Origin(found.chain.counts(), float(np.sign(beside - row[-1]))),
    )


# Largest relative difference of the parameter, and of a phase in rad, between two passages of one special point.
SAME_PARAMETER, SAME_EVENT = 1e-9, 1e-5


def distinct(points: Iterable[SpecialPoint]) -> tuple[SpecialPoint, ...]:
    """Return the special points of a branch, each at its first passage."""
    rows: list[SpecialPoint] = []
    for point in points:
        if not any(_same(point, other) for other in rows):
            rows.append(point)
    return tuple(rows)


def _same(one: SpecialPoint, other: SpecialPoint) -> bool:
    """Return whether two special points of a branch have the same orbit, some cycles later, or mirror images of each other."""
    if one.kind != other.kind or one._chain is None or other._chain is None:
        return False
    # a branch may lie on both sides of a grazing
    if one.kind == GRAZING and one._origin != other._origin:
        return False
    if not abs(one.parameter - other.parameter) <= SAME_PARAMETER * abs(one.parameter):
        return False
    if (one.orbit.period, one.orbit.symmetric) != (other.orbit.period, other.orbit.symmetric):
        return False
    first, second = _events(one._chain, one._row[:-1]), _events(other._chain, other._row[:-1])
    return first.shape == second.shape and any(
        _agree(first, second, half_turns, math.tau * one.orbit.period)
        for half_turns in range(2 * one.orbit.period)
    )


def _events(chain: Chain, phases: np.ndarray) -> np.ndarray:
    """Return phase, kind and side after each event of a whole period."""
    events = np.stack([phases, chain.kinds, sides_of(chain)], axis=1)
    if not chain.mirrored:
        return events
    later = events * [1.0, 1.0, -1.0] + [chain.turn, 0.0, 0.0]
    return np.concatenate([events, later])


def _agree(first: np.ndarray, second: np.ndarray, half_turns: int, whole: float) -> bool:
    """Return whether the events of two orbits agree if the second begins some half turns later, mirrored if their number is odd."""
    moved = second * [1.0, 1.0, (-1.0) ** half_turns] + [math.pi * half_turns, 0.0, 0.0]
    apart = (moved[None, :, 0] - first[:, None, 0] + 0.5 * whole) % whole - 0.5 * whole
    same = (np.abs(apart) <= SAME_EVENT) & (moved[None, :, 1:] == first[:, None, 1:]).all(axis=2)
    return bool(same.any(axis=1).all() and same.any(axis=0).all())


class MapPoint(Protocol):
    """Point of a branch of fixed points of a return map."""

    @property
    def phase(self) -> float: ...  # noqa: D102
    @property
    def unknowns(self) -> np.ndarray: ...  # noqa: D102
    @property
    def trace(self) -> float: ...  # noqa: D102
    @property
    def determinant(self) -> float: ...  # noqa: D102
    @property
    def tangent(self) -> np.ndarray: ...  # noqa: D102


Point = TypeVar("Point", bound=MapPoint)


class Map(Protocol[Point]):
    """Return map, as its special points need it."""

    @property
    def period(self) -> int: ...  # noqa: D102
    @property
    def symmetric(self) -> bool: ...  # noqa: D102

    def solved(self, phase: float, near: np.ndarray, normal: np.ndarray) -> Point | None:
        """Return the fixed point in the plane through a point near it, if it is found."""

    def parent(self, point: Point) -> Point | None:
        """Return the orbit from which the branch bifurcates, if a point at which the branch turns lies there."""


MAX_HALVINGS = 60
NARROW = 1e-12
"""Width of a bracket of a special point at which the search ends, in units of the step."""


def special_points_between(way: Map[Point], here: Point, there: Point) -> list[tuple[str, Point]]:
    """Return the special points between two neighbouring fixed points, where a test function changes its sign."""
    chord = there.unknowns - here.unknowns
    turns = _zero(way, here, there, lambda point: float(point.tangent[2] * np.sign(point.tangent @ chord)))
    meets = _zero(way, here, there, lambda point: multiplier_test(point.trace, point.determinant, 1.0))
    doubles = _zero(way, here, there, lambda point: multiplier_test(point.trace, point.determinant, -1.0))
    rows: list[tuple[str, Point]] = []
    if turns is not None:
        rows.append(_turn(way, turns))
    elif meets is not None and way.symmetric:
        rows.append((SYMMETRY_BREAKING, meets))
    if doubles is not None:
        rows.append((PERIOD_DOUBLING, doubles))
    return rows


def _turn(way: Map[Point], point: Point) -> tuple[str, Point]:
    """Return a point at which a branch turns, with its kind: it may lie on the branch from which this one bifurcates."""
    parent = way.parent(point)
    return (FOLD, point) if parent is None else (doubling(way.period % 2 == 1), parent)


def _zero(way: Map[Point], here: Point, there: Point, test: Callable[[Point], float]) -> Point | None:
    """Return the point between two others where a test function changes its sign, by regula falsi; None if it does not."""
    chord, low, high = there.unknowns - here.unknowns, 0.0, 1.0
    first, last = test(here), test(there)
    if first * last >= 0.0:
        return None
    result, nearest = there, there
    for _ in range(MAX_HALVINGS):
        # never at an end of the bracket, so that it always shrinks
        share = min(max(first / (first - last), 0.05), 0.95)
        middle = low + share * (high - low)
        point = way.solved(here.phase, here.unknowns + middle * chord, chord)
        if point is None:
            break
        nearest, now = point, test(point)
        if now * first > 0.0:
            low, first = middle, now
        else:
            high, last, result = middle, now, point
        if high - low < NARROW or now == 0.0:
            break
    return nearest if abs(test(nearest)) <= abs(test(result)) else result
