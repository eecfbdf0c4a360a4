"""Return map of a periodic orbit of the full block, over its period at a forcing phase.

The unknowns are Θ and Θ' at that phase, and a parameter λ. The derivatives by the state are exact, those by λ are
differences: Newton's method needs no better ones.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from attrs import evolve, frozen

from rocking.model.orbit import Orbit
from rocking.model.system import State, System, check_start
from rocking.model.verdict import Outcome
from rocking.motion.march_loop import monodromy
from rocking.motion.motion import Motion
from rocking.motion.simulate import simulate
from rocking.orbits.event_chain import clocked, multipliers_of, quiet_phase
from rocking.orbits.find_orbit import RESTING, orbit_from
from rocking.orbits.parameter import with_value

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
            found = self._linearised(phase, unknowns)
            if found is None:
                return None
            distance, derivative = found
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
            found = self.corrected(phase, near, normal)
            if found is not None:
                return found
        return None

    def state(self, point: Point, phase: float) -> np.ndarray:
        """Return Θ and Θ' of an orbit at the next instant with a forcing phase."""
        motion = self._motion(point.phase, point.unknowns)
        wait = ((phase - point.phase) % math.tau) / motion.system.periodic.frequency
        return np.array(motion.at(wait))

    def orbit(self, point: Point) -> Orbit:
        """Return the orbit of a point."""
        system = with_value(self.system, self.name, self.value(point.unknowns))
        found = orbit_from(system, point.phase, _state(point.unknowns), self.period)
        assert found is not None
        return found

    def asymmetry(self, point: Point) -> float:
        """Return the distance of a state from that half a period later, mirrored if the period is odd."""
        return float(np.hypot(*(point.unknowns[:2] - self._half_later(point.phase, point.unknowns))))

    def parent(self, point: Point) -> Point | None:
        """Return the orbit that repeats, or mirrors itself, after half the period, at the parameter of an orbit near it."""
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
        found = self.map.corrected(here.phase, near, np.array([0.0, 0.0, 1.0]))
        return None if found is None else self.map.orbit(found)

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
