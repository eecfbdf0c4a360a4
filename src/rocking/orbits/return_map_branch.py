"""Continuation of a periodic orbit of the full block by Newton's method on its return map (Keller 1977)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rocking.model.orbit import Orbit, stability_of
from rocking.model.validation import Refusal
from rocking.orbits.branch import Branch, SpecialPoint
from rocking.orbits.branch_halves import Half, joined
from rocking.orbits.branch_result import ENDS
from rocking.orbits.branch_table import POINT
from rocking.orbits.event_chain import End
from rocking.orbits.parameter import value_of
from rocking.orbits.return_map import NEAR_EVENT, SYMMETRIC, MapRows, Point, ReturnMap, multipliers

SMALLEST = 1e-4
"""Smallest step, in units of the largest."""
GROWTH = 1.5
NARROW = 1e-12
"""Width of a bracket of a special point at which the search ends, in units of the step."""
MAX_HALVINGS = 60
ALONG = np.array([0.0, 0.0, 1.0])
SAME_TRACE = 1e-2


def branch_through(orbit: Orbit, name: str, bounds: tuple[float, float], step: float, most: int) -> Branch:
    """Return the branch of an orbit over a parameter in a range: ``continue_orbit`` for the full block.

    Raises
    ------
    ValueError
        If the orbit has no impacts or does not close.
    """
    low, high = bounds
    way = ReturnMap(orbit.system, name, orbit.period, orbit.symmetric, low, high)
    start = np.array(
        [orbit.state.angle, orbit.state.velocity, (value_of(orbit.system, name) - low) / (high - low)]
    )
    first = way.corrected(orbit.phase, start, ALONG)
    if first is None:
        allowed = "have impacts, and close after its period"
        remedy = "use a neighbouring one, or find it again with find_orbit"
        raise Refusal("orbit", allowed, str(orbit), remedy)
    along = first.tangent if first.tangent[2] >= 0.0 else -first.tangent
    back, on = (follow(way, first, sense * along, step, most) for sense in (-1.0, 1.0))
    if back.end == ENDS[End.CLOSED]:
        on = Half([first], [], back.end)
    points, specials = joined(back, on)
    return Branch(
        name=name,
        period=orbit.period,
        symmetric=orbit.symmetric,
        impacts=first.impacts,
        brace_hits=first.brace_hits,
        points=table(way, points),
        special=tuple(special(way, *each) for each in specials),
        ends=(back.end, on.end),
        rows=MapRows(way, points),
    )


def follow(way: ReturnMap, first: Point, direction: np.ndarray, step: float, most: int) -> Half[Point]:
    """Follow a branch in one direction, with steps that shrink where Newton's method fails."""
    points, specials, length = [first], [], step
    here, end = first, End.MANY
    while len(points) < most:
        if here.near < NEAR_EVENT:
            moved = way.moved(here)
            if moved is not None and moved.near > here.near:
                sense = np.sign(direction[2] * moved.tangent[2]) or 1.0
                here, direction = moved, sense * moved.tangent
        there, reason = advance(way, here, direction, length)
        if there is None:
            length *= 0.5
            if length < SMALLEST * step:
                end = reason
                break
            continue
        chord = there.unknowns - here.unknowns
        specials += [(kind, point, len(points)) for kind, point in special_points_between(way, here, there)]
        points.append(there)
        if there.unknowns[2] in (0.0, 1.0):
            end = End.RANGE
            break
        if len(points) > 4 and closes(way, first, there, step):
            end = End.CLOSED
            break
        direction = there.tangent if there.tangent @ chord >= 0.0 else -there.tangent
        here, length = there, min(GROWTH * length, step)
    return Half(points, specials, ENDS[end])


def advance(way: ReturnMap, here: Point, direction: np.ndarray, length: float) -> tuple[Point | None, End]:
    """Return the next point, or None and what may be the reason."""
    near = here.unknowns + length * direction
    normal = direction
    if not 0.0 < near[2] < 1.0:
        edge = 0.0 if near[2] <= 0.0 else 1.0
        if here.unknowns[2] == edge:
            return None, End.RANGE
        near = here.unknowns + (edge - here.unknowns[2]) / direction[2] * direction
        near[2], normal = edge, ALONG
    there = way.corrected(here.phase, near, normal)
    if there is None:
        grazes = way.begins(near) and way.counts(here.phase, near) != (here.impacts, here.brace_hits)
        return None, End.GRAZED if grazes else End.LOST
    if normal is ALONG:
        there = there._replace(unknowns=np.append(there.unknowns[:2], near[2]))
    if (there.impacts, there.brace_hits) != (here.impacts, here.brace_hits):
        return None, End.GRAZED
    far = np.hypot(*(there.unknowns[:2] - here.unknowns[:2])) > 10.0 * length
    # onto a branch that bifurcates from this one, or from which this one bifurcates
    strays = way.symmetric != (way.asymmetry(there) <= SYMMETRIC)
    return (None, End.LOST) if far or strays else (there, End.LOST)


def closes(way: ReturnMap, first: Point, there: Point, step: float) -> bool:
    """Return whether a branch has come back to its first point."""
    if abs(there.unknowns[2] - first.unknowns[2]) > 0.5 * step or abs(there.trace - first.trace) > SAME_TRACE:
        return False
    return bool(np.abs(way.state(there, first.phase) - first.unknowns[:2]).max() < 0.5 * step)


def special_points_between(way: ReturnMap, here: Point, there: Point) -> list[tuple[str, Point]]:
    """Return the special points between two neighbouring points, where a test function changes its sign."""
    chord = there.unknowns - here.unknowns
    turns = crossing(way, here, there, lambda point: float(point.tangent[2] * np.sign(point.tangent @ chord)))
    meets = crossing(way, here, there, lambda point: 1.0 - point.trace + point.determinant)
    doubles = crossing(way, here, there, lambda point: 1.0 + point.trace + point.determinant)
    found: list[tuple[str, Point]] = []
    if turns is not None:
        found.append(turn(way, turns))
    elif meets is not None and way.symmetric:
        found.append(("symmetry-breaking", meets))
    if doubles is not None:
        found.append(("period-doubling", doubles))
    return found


def turn(way: ReturnMap, point: Point) -> tuple[str, Point]:
    """Return a point at which a branch turns, with its kind: it may lie on the branch from which this one bifurcates."""
    if not way.symmetric and way.asymmetry(point) < np.sqrt(SYMMETRIC):
        parent = way.parent(point)
        if parent is not None:
            return ("symmetry-breaking" if way.period % 2 == 1 else "period-doubling"), parent
    return "fold", point


def crossing(way: ReturnMap, here: Point, there: Point, test: Callable[[Point], float]) -> Point | None:
    """Return the point between two others where a test function changes its sign, by regula falsi; None if it does not."""
    chord, low, high = there.unknowns - here.unknowns, 0.0, 1.0
    first, last = test(here), test(there)
    if first * last >= 0.0:
        return None
    found, nearest = there, there
    for _ in range(MAX_HALVINGS):
        # never at an end of the bracket, so that it always shrinks
        share = min(max(first / (first - last), 0.05), 0.95)
        middle = low + share * (high - low)
        point = way.corrected(here.phase, here.unknowns + middle * chord, chord)
        if point is None:
            break
        nearest, now = point, test(point)
        if now * first > 0.0:
            low, first = middle, now
        else:
            high, last, found = middle, now, point
        if high - low < NARROW or now == 0.0:
            break
    return nearest if abs(test(nearest)) <= abs(test(found)) else found


def table(way: ReturnMap, points: tuple[Point, ...]) -> np.ndarray:
    """Return the public table of a branch."""
    rows = np.empty(len(points), POINT)
    rows["parameter"] = [way.value(point.unknowns) for point in points]
    rows["phase"], rows["velocity"] = np.array([point.first for point in points]).T
    rows["multipliers"] = [multipliers(point) for point in points]
    rows["stability"] = [stability_of(point.trace, point.determinant) for point in points]
    rows["stable"] = rows["stability"] == "stable"
    rows["peak"] = [point.peak for point in points]
    rows.flags.writeable = False
    return rows


def special(way: ReturnMap, kind: str, point: Point, index: int) -> SpecialPoint:
    """Return a special point with its orbit."""
    return SpecialPoint(
        kind=kind,
        parameter=way.value(point.unknowns),
        orbit=way.orbit(point),
        name=way.name,
        index=index,
        chain=None,
        row=point.unknowns,
    )
