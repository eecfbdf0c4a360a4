"""Branches that are followed point by point: what a problem must know, the loop, and the branch that it makes.

Each point of such a branch costs simulations: of the full block (`return_map`), or of orbits that rest (`resting_branch`). The orbits of
slender blocks are closed chains of events, with equations. The kernels follow these with their own compiled loop, in
`rocking.kernels.orbits.continuation`: a point takes microseconds there, and calls from this loop would take longer than the point.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import ClassVar, Generic, NamedTuple, Protocol, TypeVar

import numpy as np
from attrs import frozen

from rocking.model.orbit import Orbit, stability_of
from rocking.model.system import State, System
from rocking.motion.simulate import simulate
from rocking.orbits.branch import ENDS, POINT, Branch
from rocking.orbits.event_chain import End, clocked, multipliers_of
from rocking.orbits.find_orbit import orbit_from
from rocking.orbits.parameter import with_value
from rocking.orbits.special_points import SpecialPoint


class Located(Protocol):
    """Orbit at one value of the parameter, as a point of a branch."""

    @property
    def phase(self) -> float:
        """Forcing phase of the section."""

    @property
    def state(self) -> State:
        """State on the section."""

    @property
    def trace(self) -> float:
        """Trace of the return map over a period."""

    @property
    def determinant(self) -> float:
        """Determinant of this map."""

    @property
    def first(self) -> tuple[float, float]:
        """Phase and speed of the first event."""

    @property
    def peak(self) -> float:
        """Largest |Θ|."""


Point = TypeVar("Point", bound=Located)


class Passage(NamedTuple, Generic[Point]):
    """Part of a branch: its new points, and the special points among them."""

    points: Sequence[Point]
    specials: Sequence[tuple[str, Point, int]] = ()  # kind, point, and index of the new point after it
    end: str | None = None  # reason why the branch ends here


@frozen
class Problem(ABC, Generic[Point]):
    """Orbits of a system over a parameter in a range: how a branch of them goes on from a point."""

    system: System
    name: str
    period: int
    low: float
    high: float
    longest: float  # largest step

    SHORTEST: ClassVar[float]
    """Smallest step, in units of the largest."""
    GROWTH: ClassVar[float]
    """Factor of the step after a new point."""

    @abstractmethod
    def value(self, point: Point) -> float:
        """Return the value of the parameter at a point."""

    def ready(self, here: Point) -> Point:
        """Return the point from which the next one is corrected."""
        return here

    @abstractmethod
    def corrected(self, here: Point, length: float) -> Point | End:
        """Return the next point, one step away, or what may be the reason why there is none."""

    def tests(self, here: Point, there: Point) -> list[tuple[str, Point]]:
        """Return the special points between two neighbouring points, with their kinds."""
        return []

    def obstacle(self, here: Point, length: float, reason: End) -> Passage[Point]:
        """Return what follows a point from which the smallest step fails."""
        return Passage([], end=ENDS[reason])

    def end(self, points: Sequence[Point]) -> End | None:
        """Return the reason why a branch ends at its last point, None if it goes on."""
        return None

    @abstractmethod
    def at_value(self, here: Point, there: Point, share: float, value: float) -> Point | None:
        """Return the point at a value of the parameter, a share of the way between two others, if there is one."""

    def begun(self, point: Point) -> System:
        """Return the system at a point, with time measured from its section."""
        return clocked(with_value(self.system, self.name, self.value(point)), point.phase)

    def orbit(self, point: Point) -> Orbit:
        """Return the orbit of a point."""
        system = with_value(self.system, self.name, self.value(point))
        result = orbit_from(system, point.phase, point.state, self.period)
        assert result is not None
        return result


class HalfBranch(NamedTuple, Generic[Point]):
    """Branch in one direction from its first point."""

    points: list[Point]
    specials: list[tuple[str, Point, int]]  # kind, point, and index of the point after it
    end: str


def follow(problem: Problem[Point], first: Point, most: int) -> HalfBranch[Point]:
    """Follow a branch in one direction, with steps that are halved where a point is not found."""
    points: list[Point] = [first]
    specials: list[tuple[str, Point, int]] = []
    here, length = first, problem.longest
    while len(points) < most:
        here = problem.ready(here)
        there = problem.corrected(here, length)
        if not isinstance(there, End):
            found = [(kind, point, 0) for kind, point in problem.tests(here, there)]
            passage = Passage([there], found)
        elif 0.5 * length >= problem.SHORTEST * problem.longest:
            length *= 0.5
            continue
        else:
            passage = problem.obstacle(here, length, there)
        room = most - len(points)
        specials += [
            (kind, point, len(points) + place) for kind, point, place in passage.specials if place < room
        ]
        points += passage.points[:room]
        if len(passage.points) > room:
            break
        if passage.end is not None:
            return HalfBranch(points, specials, passage.end)
        end = problem.end(points)
        if end is not None:
            return HalfBranch(points, specials, ENDS[end])
        here, length = points[-1], min(problem.GROWTH * length, problem.longest)
    return HalfBranch(points, specials, ENDS[End.MANY])


def joined(
    problem: Problem[Point],
    back: HalfBranch[Point],
    on: HalfBranch[Point],
    *,
    symmetric: bool,
    impacts: int | None,
    brace_hits: int | None,
) -> Branch:
    """Return the branch of two halves that begin at the same point."""
    last = len(back.points) - 1
    points = (*reversed(back.points), *on.points[1:])
    specials = [(kind, point, last + 1 - index) for kind, point, index in reversed(back.specials)]
    specials += [(kind, point, last + index) for kind, point, index in on.specials]
    return Branch(
        name=problem.name,
        period=problem.period,
        symmetric=symmetric,
        impacts=impacts,
        brace_hits=brace_hits,
        points=_table(problem, points),
        special=tuple(
            SpecialPoint(
                kind=kind,
                parameter=problem.value(point),
                orbit=problem.orbit(point),
                name=problem.name,
                index=index,
                chain=None,
                row=np.empty(0),
            )
            for kind, point, index in specials
        ),
        ends=(back.end, on.end),
        rows=PointRows(problem, points),
    )


def _table(problem: Problem[Point], points: Sequence[Point]) -> np.ndarray:
    """Return the public table of a branch."""
    rows = np.empty(len(points), POINT)
    rows["parameter"] = [problem.value(point) for point in points]
    rows["phase"], rows["velocity"] = np.array([point.first for point in points]).T
    rows["multipliers"] = [multipliers_of(point.trace, point.determinant, mirrored=False) for point in points]
    rows["stability"] = [stability_of(point.trace, point.determinant) for point in points]
    rows["stable"] = rows["stability"] == "stable"
    rows["peak"] = [point.peak for point in points]
    rows.flags.writeable = False
    return rows


class PointRows(NamedTuple, Generic[Point]):
    """Points of a branch that is followed point by point."""

    problem: Problem[Point]
    points: tuple[Point, ...]

    def orbit(self, index: int) -> Orbit:
        """Return the orbit of a point."""
        return self.problem.orbit(self.points[index])

    def between(self, index: int, share: float, value: float) -> Orbit | None:
        """Return the orbit at a value of the parameter near the point a share of the way to the next one, if there is one."""
        here = self.points[index]
        result = self.problem.at_value(here, self.points[index + 1] if share else here, share, value)
        return None if result is None else self.problem.orbit(result)

    def section(self, phase: float) -> np.ndarray:
        """Return Θ and Θ' of all orbits at a forcing phase in the cycles of a period, shape (points, period, 2)."""
        out = []
        for point in self.points:
            system = self.problem.begun(point)
            motion = simulate(system, point.state, cycles=self.problem.period + 1)
            forcing = system.periodic
            wait = ((phase - point.phase) % math.tau) / forcing.frequency
            out.append(np.column_stack(motion.at(wait + forcing.period * np.arange(self.problem.period))))
        return np.array(out)
