"""Return map of a periodic orbit of the full or the unsymmetric block, and the continuation of its fixed points (Keller 1977).

The unknowns are the angle and the velocity at a forcing phase, and the parameter in units of its range.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from attrs import evolve, frozen

from rocking.model.orbit import Orbit
from rocking.model.system import State, System, check_start
from rocking.model.validation import Refusal
from rocking.model.verdict import Outcome
from rocking.motion.march_loop import monodromy
from rocking.motion.motion import Motion
from rocking.motion.simulate import simulate
from rocking.orbits.branch import ENDS, Branch
from rocking.orbits.event_chain import End, clocked, quiet_phase
from rocking.orbits.find_orbit import RESTING
from rocking.orbits.follow import HalfBranch, Problem, follow, joined
from rocking.orbits.parameter import value_of, with_value
from rocking.orbits.special_points import special_points_between

CONVERGED = 1e-11
"""Distance of a state from its image after a period at which Newton's method ends."""
MAX_STEPS = 12
DIFFERENCE = 1e-6
"""Half the distance of the two values of the parameter of a difference, in units of the range."""
BEYOND = 1e-9
"""Distance from the range, in its units, up to which Newton's method may leave it."""
NEAR_EVENT = 0.1
"""Distance of an event from the section, in rad, below which the section is moved."""
SAME_TRACE = 1e-2
"""Largest difference of the traces at the first and the last point of a closed branch."""
ALONG = np.array([0.0, 0.0, 1.0])
"""Direction of the parameter."""
SYMMETRIC = 1e-6
"""Largest distance of a state of a symmetric orbit from the mirror image of that half a period later."""


class FixedPoint(NamedTuple):
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
    direction: np.ndarray = np.zeros(3)  # in which the branch is followed

    @property
    def state(self) -> State:
        """State on the section."""
        return _state(self.unknowns)

    @property
    def tangent(self) -> np.ndarray:
        """Direction of the branch, up to its sign."""
        return np.asarray(np.linalg.svd(self.derivative)[2][-1])

    def along(self, chord: np.ndarray) -> FixedPoint:
        """Return the point with its tangent as the direction, in the sense of a chord."""
        tangent = self.tangent
        return self._replace(direction=tangent if tangent @ chord >= 0.0 else -tangent)

    def contacts(self) -> tuple[int, int]:
        """Return the numbers of impacts and of brace impacts."""
        return self.impacts, self.brace_hits


@frozen
class ReturnMap(Problem[FixedPoint]):
    """Return map of the orbits of a system over a period, for one parameter in a range."""

    symmetric: bool

    SHORTEST = 1e-4
    GROWTH = 1.5

    def value(self, point: FixedPoint) -> float:
        """Return the value of the parameter at a point."""
        return self.value_at(point.unknowns)

    def value_at(self, unknowns: np.ndarray) -> float:
        """Return the value of the parameter."""
        return float(self.low + (self.high - self.low) * min(max(unknowns[2], 0.0), 1.0))

    def system_at(self, phase: float, unknowns: np.ndarray) -> System:
        """Return the system with its parameter, and with time measured from the section."""
        return clocked(with_value(self.system, self.name, self.value_at(unknowns)), phase)

    def ready(self, here: FixedPoint) -> FixedPoint:
        """Return a point, with its section moved away from the events if it is near one."""
        if here.near >= NEAR_EVENT:
            return here
        moved = self.moved(here)
        if moved is None or moved.near <= here.near:
            return here
        tangent = moved.tangent
        sense = np.sign(here.direction[2] * tangent[2]) or 1.0
        return moved._replace(direction=sense * tangent)

    def corrected(self, here: FixedPoint, length: float) -> FixedPoint | End:
        """Return the next point, or what may be the reason why there is none."""
        near = here.unknowns + length * here.direction
        normal = here.direction
        if not 0.0 < near[2] < 1.0:
            edge = 0.0 if near[2] <= 0.0 else 1.0
            if here.unknowns[2] == edge:
                return End.RANGE
            near = here.unknowns + (edge - here.unknowns[2]) / here.direction[2] * here.direction
            near[2], normal = edge, ALONG
        there = self.solved(here.phase, near, normal)
        if there is None:
            grazes = self.begins(near) and self.counts(here.phase, near) != here.contacts()
            return End.GRAZED if grazes else End.LOST
        if normal is ALONG:
            there = there._replace(unknowns=np.append(there.unknowns[:2], near[2]))
        if there.contacts() != here.contacts():
            return End.GRAZED
        far = np.hypot(*(there.unknowns[:2] - here.unknowns[:2])) > 10.0 * length
        # onto a branch that bifurcates from this one, or from which this one bifurcates
        strays = self.symmetric != (self.asymmetry(there) <= SYMMETRIC)
        return End.LOST if far or strays else there.along(there.unknowns - here.unknowns)

    def tests(self, here: FixedPoint, there: FixedPoint) -> list[tuple[str, FixedPoint]]:
        """Return the special points between two neighbouring points, with their kinds."""
        return special_points_between(self, here, there)

    def end(self, points: Sequence[FixedPoint]) -> End | None:
        """Return the reason why a branch ends at its last point: the range, or the first point."""
        first, last = points[0], points[-1]
        if last.unknowns[2] in (0.0, 1.0):
            return End.RANGE
        return End.CLOSED if len(points) > 4 and self.closes(first, last) else None

    def closes(self, first: FixedPoint, last: FixedPoint) -> bool:
        """Return whether a branch has come back to its first point."""
        apart, reach = abs(last.unknowns[2] - first.unknowns[2]), 0.5 * self.longest
        if apart > reach or abs(last.trace - first.trace) > SAME_TRACE:
            return False
        return bool(np.abs(self.state(last, first.phase) - first.unknowns[:2]).max() < reach)

    def at_value(self, here: FixedPoint, there: FixedPoint, share: float, value: float) -> FixedPoint | None:
        """Return the point at a value of the parameter, a share of the way between two others, if there is one."""
        near = here.unknowns.copy()
        if there.phase == here.phase:
            near += share * (there.unknowns - near)
        near[2] = (value - self.low) / (self.high - self.low)
        return self.solved(here.phase, near, ALONG)

    def begins(self, unknowns: np.ndarray) -> bool:
        """Return whether a motion can begin at a state: Newton's method may reach one beyond a brace or flat on the ground."""
        try:
            check_start(with_value(self.system, self.name, self.value_at(unknowns)), _state(unknowns))
        except ValueError:
            return False
        return True

    def image(self, phase: float, unknowns: np.ndarray) -> np.ndarray | None:
        """Return the state a period later; None if the block overturns before, or if no motion can begin at the state."""
        if not self.begins(unknowns):
            return None
        motion = simulate(
            self.system_at(phase, unknowns), _state(unknowns), cycles=self.period, record="none"
        )
        if motion.outcome is Outcome.OVERTURNED:
            return None
        return np.array([motion.final.angle, motion.final.velocity])

    def counts(self, phase: float, unknowns: np.ndarray) -> tuple[int, int]:
        """Return the numbers of impacts and of brace impacts in a period."""
        motion = self._motion(phase, unknowns)
        return motion.impacts, motion.brace_hits

    def solved(self, phase: float, near: np.ndarray, normal: np.ndarray) -> FixedPoint | None:
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

    def moved(self, point: FixedPoint) -> FixedPoint | None:
        """Return a point at the forcing phase farthest from its events."""
        motion = self._motion(point.phase, point.unknowns)
        phase = quiet_phase(point.phase + motion.system.periodic.frequency * motion.events["time"])
        near = np.append(self.state(point, phase), point.unknowns[2])
        for normal in (ALONG, point.tangent):
            result = self.solved(phase, near, normal)
            if result is not None:
                return result
        return None

    def state(self, point: FixedPoint, phase: float) -> np.ndarray:
        """Return Θ and Θ' of an orbit at the next instant with a forcing phase."""
        motion = self._motion(point.phase, point.unknowns)
        wait = ((phase - point.phase) % math.tau) / motion.system.periodic.frequency
        return np.array(motion.at(wait))

    def asymmetry(self, point: FixedPoint) -> float:
        """Return the distance of a state from that half a period later, mirrored if the period is odd.

        It is infinite for an unsymmetric block and an odd period: such an orbit has no mirror image.
        """
        if self.system.left is not None and self.period % 2 == 1:
            return math.inf
        return float(np.hypot(*(point.unknowns[:2] - self._half_later(point.phase, point.unknowns))))

    def parent(self, point: FixedPoint) -> FixedPoint | None:
        """Return the orbit that repeats, or mirrors itself, after half the period, at the parameter of a point near it.

        None if the point is not near it, or if all orbits of the branch mirror themselves.
        """
        if self.symmetric or not self.asymmetry(point) < np.sqrt(SYMMETRIC):
            return None
        odd = self.period % 2 == 1
        way = evolve(self, symmetric=odd, period=self.period if odd else self.period // 2)
        state = 0.5 * (point.unknowns[:2] + self._half_later(point.phase, point.unknowns))
        return way.solved(point.phase, np.append(state, point.unknowns[2]), ALONG)

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
        of_state = monodromy(self.system_at(phase, unknowns), _state(unknowns), self.period) - np.eye(2)
        of_parameter = (later - earlier) / (after[2] - before[2])
        return here - unknowns[:2], np.column_stack([of_state, of_parameter])

    def _point(self, phase: float, unknowns: np.ndarray, derivative: np.ndarray) -> FixedPoint | None:
        """Return the point of an orbit; None if it rests or leans."""
        motion = self._motion(phase, unknowns)
        system, events = motion.system, motion.events
        events = events[np.isin(events["kind"], ("impact", "brace", *RESTING, "lean", "leave"))]
        if not np.isin(events["kind"], ("impact", "brace")).all() or not len(events):
            return None
        psi = system.periodic.frequency * events["time"]
        impacts, brace_hits = motion.impacts, motion.brace_hits
        kept = system.restitution**impacts
        if system.left is not None:  # impacts of both directions alternate
            kept = math.sqrt(system.restitution * system.left.restitution) ** impacts
        if system.braces is not None:
            kept *= system.braces.restitution**brace_hits
        determinant = kept * kept
        if system.restitution_table:
            determinant = float(np.linalg.det(derivative[:, :2] + np.eye(2)))
        aside = np.abs((psi + math.pi) % math.tau - math.pi)
        return FixedPoint(
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
        return simulate(self.system_at(phase, unknowns), _state(unknowns), cycles=self.period)


def _state(unknowns: np.ndarray) -> State:
    return State(float(unknowns[0]), float(unknowns[1]))


def branch_through(orbit: Orbit, name: str, bounds: tuple[float, float], step: float, most: int) -> Branch:
    """Return the branch of an orbit over a parameter in a range: ``continue_orbit`` for the full or the unsymmetric block.

    Raises
    ------
    ValueError
        If the orbit has no impacts or does not close.
    """
    low, high = bounds
    way = ReturnMap(orbit.system, name, orbit.period, low, high, step, orbit.symmetric)
    start = np.array(
        [orbit.state.angle, orbit.state.velocity, (value_of(orbit.system, name) - low) / (high - low)]
    )
    found = way.solved(orbit.phase, start, ALONG)
    if found is None:
        allowed = "have impacts, and close after its period"
        remedy = "use a neighbouring one, or find it again with find_orbit"
        raise Refusal("orbit", allowed, str(orbit), remedy)
    first = found.along(ALONG)
    back, on = (follow(way, first._replace(direction=sense * first.direction), most) for sense in (-1.0, 1.0))
    if back.end == ENDS[End.CLOSED]:
        on = HalfBranch([first], [], back.end)
    impacts, brace_hits = first.contacts()
    return joined(way, back, on, symmetric=orbit.symmetric, impacts=impacts, brace_hits=brace_hits)
