"""Return map of a periodic orbit of the full block, and the continuation of its fixed points (Keller 1977)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from attrs import evolve, frozen

from rocking.model.orbit import Orbit, stability_of
from rocking.model.system import State, System, check_start
from rocking.model.validation import Refusal
from rocking.model.verdict import Outcome
from rocking.motion.march_loop import monodromy
from rocking.motion.motion import Motion
from rocking.motion.simulate import simulate
from rocking.orbits.branch import ENDS, POINT, Branch, HalfBranch, joined
from rocking.orbits.event_chain import End, clocked, multipliers_of, quiet_phase
from rocking.orbits.find_orbit import RESTING, orbit_from
from rocking.orbits.parameter import value_of, with_value
from rocking.orbits.special_points import SpecialPoint, special_points_between

CONVERGED = 1e-11
"""Distance of a state from its image after a period at which Newton's method ends."""
MAX_STEPS = 12
DIFFERENCE = 1e-6
"""Half the distance of the two values of the parameter of a difference, in units of the range."""
BEYOND = 1e-9
"""Distance from the range, in its units, up to which Newton's method may leave it."""
NEAR_EVENT = 0.1
"""Distance of an event from the section, in rad, below which the section is moved."""
SYMMETRIC = 1e-6
"""Largest distance of a state of a symmetric orbit from the mirror image of that half a period later."""


class Point(NamedTuple):
    """Orbit on a branch: a forcing phase, Θ and Θ' there, and the parameter in units of its range."""

    phase: float
    unknowns: np.ndarray  # (3,)
    derivative: np.ndarray  # (2, 3), of the distance of the image from the state
    trace: float
    determinant: float
    impacts: int
    brace_hits: int
    peak: float
    first: tuple[float, float]  # phase and speed of the first event
    near: float  # distance of the section from the nearest event, in rad

    @property
    def tangent(self) -> np.ndarray:
        """Direction of the branch, up to its sign."""
        return np.asarray(np.linalg.svd(self.derivative)[2][-1])


@frozen
class ReturnMap:
    """Return map of the orbits of a system over a period, for one parameter in a range."""

    system: System
    name: str
    period: int
    symmetric: bool
    low: float
    high: float

    def value(self, unknowns: np.ndarray) -> float:
        """Return the value of the parameter."""
        return float(self.low + (self.high - self.low) * min(max(unknowns[2], 0.0), 1.0))

    def begun(self, phase: float, unknowns: np.ndarray) -> System:
        """Return the system with its parameter, and with time measured from the section."""
        return clocked(with_value(self.system, self.name, self.value(unknowns)), phase)

    def begins(self, unknowns: np.ndarray) -> bool:
        """Return whether a motion can begin at a state: Newton's method may reach one beyond a brace or flat on the ground."""
        try:
            check_start(with_value(self.system, self.name, self.value(unknowns)), _state(unknowns))
        except ValueError:
            return False
        return True

    def image(self, phase: float, unknowns: np.ndarray) -> np.ndarray | None:
        """Return the state a period later; None if the block overturns before, or if no motion can begin at the state."""
        if not self.begins(unknowns):
            return None
        motion = simulate(self.begun(phase, unknowns), _state(unknowns), cycles=self.period, record="none")
        if motion.outcome is Outcome.OVERTURNED:
            return None
        return np.array([motion.final.angle, motion.final.velocity])

    def counts(self, phase: float, unknowns: np.ndarray) -> tuple[int, int]:
        """Return the numbers of impacts and of brace impacts in a period."""
        motion = self._motion(phase, unknowns)
        return motion.impacts, motion.brace_hits

    def corrected(self, phase: float, near: np.ndarray, normal: np.ndarray) -> Point | None:
        """Return the orbit in the plane through a point near it, by Newton's method; None if it does not converge."""
        unknowns = self._symmetrised(phase, near)
        for _ in range(MAX_STEPS):
            result = self._linearised(phase, unknowns)
            if result is None:
                return None
            distance, derivative = result
            if np.hypot(*distance) < CONVERGED:
                return self._point(phase, unknowns, derivative)
            matrix = np.vstack([derivative, normal])
            right = -np.append(distance, normal @ (unknowns - near))
            step = np.linalg.lstsq(matrix, right, rcond=1e-10)[0]
            unknowns = unknowns + step
            if not -BEYOND <= unknowns[2] <= 1.0 + BEYOND:
                return None
            unknowns = self._symmetrised(phase, unknowns)
        return None

    def moved(self, point: Point) -> Point | None:
        """Return a point at the forcing phase farthest from its events."""
        motion = self._motion(point.phase, point.unknowns)
        phase = quiet_phase(point.phase + motion.system.periodic.frequency * motion.events["time"])
        near = np.append(self.state(point, phase), point.unknowns[2])
        for normal in (np.array([0.0, 0.0, 1.0]), point.tangent):
            result = self.corrected(phase, near, normal)
            if result is not None:
                return result
        return None

    def state(self, point: Point, phase: float) -> np.ndarray:
        """Return Θ and Θ' of an orbit at the next instant with a forcing phase."""
        motion = self._motion(point.phase, point.unknowns)
        wait = ((phase - point.phase) % math.tau) / motion.system.periodic.frequency
        return np.array(motion.at(wait))

    def orbit(self, point: Point) -> Orbit:
        """Return the orbit of a point."""
        system = with_value(self.system, self.name, self.value(point.unknowns))
        result = orbit_from(system, point.phase, _state(point.unknowns), self.period)
        assert result is not None
        return result

    def asymmetry(self, point: Point) -> float:
        """Return the distance of a state from that half a period later, mirrored if the period is odd."""
        return float(np.hypot(*(point.unknowns[:2] - self._half_later(point.phase, point.unknowns))))

    def parent(self, point: Point) -> Point | None:
        """Return the orbit that repeats, or mirrors itself, after half the period, at the parameter of a point near it.

        None if the point is not near it, or if all orbits of the branch mirror themselves.
        """
        if self.symmetric or not self.asymmetry(point) < np.sqrt(SYMMETRIC):
            return None
        odd = self.period % 2 == 1
        way = evolve(self, symmetric=odd, period=self.period if odd else self.period // 2)
        state = 0.5 * (point.unknowns[:2] + self._half_later(point.phase, point.unknowns))
        return way.corrected(point.phase, np.append(state, point.unknowns[2]), np.array([0.0, 0.0, 1.0]))

    def _half_later(self, phase: float, unknowns: np.ndarray) -> np.ndarray:
        """Return the state half a period later, mirrored if the period is odd: the forcing has then changed its sign."""
        motion = self._motion(phase, unknowns)
        half = np.array(motion.at(0.5 * self.period * motion.system.periodic.period))
        return -half if self.period % 2 == 1 else half

    def _symmetrised(self, phase: float, unknowns: np.ndarray) -> np.ndarray:
        """Return the mean of a state and the mirror image of that half a period later, on a branch of symmetric orbits.

        Where symmetry breaks, nothing else keeps Newton's method on it.
        """
        if not (self.symmetric and self.begins(unknowns)):
            return unknowns
        return np.append(0.5 * (unknowns[:2] + self._half_later(phase, unknowns)), unknowns[2])

    def _linearised(self, phase: float, unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """Return the distance of the image from the state, and its derivative (2, 3); None if the block overturns."""
        after, before = unknowns.copy(), unknowns.copy()
        after[2], before[2] = min(unknowns[2] + DIFFERENCE, 1.0), max(unknowns[2] - DIFFERENCE, 0.0)
        here, later, earlier = (self.image(phase, each) for each in (unknowns, after, before))
        if here is None or later is None or earlier is None:
            return None
        of_state = monodromy(self.begun(phase, unknowns), _state(unknowns), self.period) - np.eye(2)
        of_parameter = (later - earlier) / (after[2] - before[2])
        return here - unknowns[:2], np.column_stack([of_state, of_parameter])

    def _point(self, phase: float, unknowns: np.ndarray, derivative: np.ndarray) -> Point | None:
        """Return the point of an orbit; None if it rests or leans."""
        motion = self._motion(phase, unknowns)
        system, events = motion.system, motion.events
        events = events[np.isin(events["kind"], ("impact", "brace", *RESTING, "lean", "leave"))]
        if not np.isin(events["kind"], ("impact", "brace")).all() or not len(events):
            return None
        psi = system.periodic.frequency * events["time"]
        impacts, brace_hits = motion.impacts, motion.brace_hits
        kept = system.restitution**impacts
        if system.braces is not None:
            kept *= system.braces.restitution**brace_hits
        determinant = kept * kept
        if system.restitution_table:
            determinant = float(np.linalg.det(derivative[:, :2] + np.eye(2)))
        aside = np.abs((psi + math.pi) % math.tau - math.pi)
        return Point(
            phase,
            unknowns,
            derivative,
            float(derivative[0, 0] + derivative[1, 1] + 2.0),
            determinant,
            impacts,
            brace_hits,
            motion.peak,
            (float(phase + psi[0]) % math.tau, abs(float(events["after"][0]))),
            float(aside.min()),
        )

    def _motion(self, phase: float, unknowns: np.ndarray) -> Motion:
        return simulate(self.begun(phase, unknowns), _state(unknowns), cycles=self.period)


def _state(unknowns: np.ndarray) -> State:
    return State(float(unknowns[0]), float(unknowns[1]))


class MapRows(NamedTuple):
    """Points of a branch of full blocks."""

    map: ReturnMap
    points: tuple[Point, ...]

    def orbit(self, index: int) -> Orbit:
        """Return the orbit of a point."""
        return self.map.orbit(self.points[index])

    def between(self, index: int, share: float, value: float) -> Orbit | None:
        """Return the orbit at a value of the parameter near the point a share of the way to the next one, if there is one."""
        here = self.points[index]
        near = here.unknowns.copy()
        there = self.points[index + 1] if share else here
        if there.phase == here.phase:
            near += share * (there.unknowns - near)
        near[2] = (value - self.map.low) / (self.map.high - self.map.low)
        result = self.map.corrected(here.phase, near, np.array([0.0, 0.0, 1.0]))
        return None if result is None else self.map.orbit(result)

    def section(self, phase: float) -> np.ndarray:
        """Return Θ and Θ' of all orbits at a forcing phase in the cycles of a period, shape (points, period, 2)."""
        out = []
        for point in self.points:
            begun = self.map.begun(point.phase, point.unknowns)
            motion = simulate(begun, _state(point.unknowns), cycles=self.map.period + 1)
            forcing = begun.periodic
            wait = ((phase - point.phase) % math.tau) / forcing.frequency
            out.append(np.column_stack(motion.at(wait + forcing.period * np.arange(self.map.period))))
        return np.array(out)


def multipliers(point: Point) -> tuple[complex, complex]:
    """Return the Floquet multipliers of a point, the larger first."""
    return multipliers_of(point.trace, point.determinant, mirrored=False)


SMALLEST = 1e-4
"""Smallest step, in units of the largest."""
GROWTH = 1.5
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
        on = HalfBranch([first], [], back.end)
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


def follow(way: ReturnMap, first: Point, direction: np.ndarray, step: float, most: int) -> HalfBranch[Point]:
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
    return HalfBranch(points, specials, ENDS[end])


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
