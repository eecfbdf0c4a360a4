"""Registry of the orbits found by a search, each stored once with its number of hits."""

from __future__ import annotations

import math

import numpy as np
from attrs import evolve

from rocking.model.orbit import Orbit
from rocking.model.system import State, System
from rocking.orbits.find_orbit import orbit_from

# Largest distance of two identical results of Newton's method, and of two identical orbits.
SAME = 1e-6


def mirrored(orbit: Orbit) -> Orbit:
    """Return the mirror image of an orbit, which is an orbit half a forcing period later."""
    state = State(-orbit.state.angle, -orbit.state.velocity)
    events = tuple(
        evolve(one, angle=-one.angle, before=-one.before, after=-one.after) for one in orbit._events
    )
    return evolve(orbit, state=state, phase=(orbit.phase + math.pi) % math.tau, events=events)


class OrbitRegistry:
    """Orbits found so far, with all their states on the section at a forcing phase."""

    def __init__(self, system: System, phase: float) -> None:
        self.system, self.phase = system, phase
        self.orbits: list[Orbit] = []
        self.pairs: list[int] = []
        self.counts: list[int] = []
        self.rows = np.empty((0, 2))
        self.owner = np.empty(0, int)

    @property
    def hits(self) -> list[int]:
        """Number of states that belong to each orbit or to its mirror image."""
        return [self.counts[pair] for pair in self.pairs]

    def add_states(self, states: np.ndarray, period: int) -> None:
        """Count the states that belong to known orbits, and add the orbits of the others with their mirror images."""
        states = states[~self._counted(states)]
        while len(states):
            orbit = orbit_from(self.system, self.phase, State(*map(float, states[0])), period)
            near = np.hypot(*(states - states[0]).T) <= SAME
            if orbit is not None and (
                orbit.impacts != 0 or orbit.brace_hits != 0 or abs(orbit.state.angle) > SAME
            ):
                self.counts[self._pair(orbit)] += int(near.sum())
            states = states[~near]
            states = states[~self._counted(states)]

    def _counted(self, states: np.ndarray) -> np.ndarray:
        """Return which states belong to known orbits, and count them."""
        owners = self._owners(states)
        for owner, number in zip(*np.unique(owners[owners >= 0], return_counts=True), strict=True):
            self.counts[self.pairs[owner]] += int(number)
        return owners >= 0

    def _owners(self, states: np.ndarray) -> np.ndarray:
        """Return the number of the known orbit of each state, -1 for none.

        Each state is compared with the rows whose angle is no further away than `SAME`, not with all.
        """
        order = np.argsort(self.rows[:, 0])
        angles = self.rows[order, 0]
        first = np.searchsorted(angles, states[:, 0] - SAME)
        counts = np.searchsorted(angles, states[:, 0] + SAME, side="right") - first
        owners, nearest = np.full(len(states), -1), np.full(len(states), SAME)
        for k in range(counts.max(initial=0)):
            here = np.flatnonzero(counts > k)
            rows = order[first[here] + k]
            distances = np.hypot(*(states[here] - self.rows[rows]).T)
            closer = distances <= nearest[here]
            owners[here[closer]], nearest[here[closer]] = self.owner[rows[closer]], distances[closer]
        return owners

    def _pair(self, orbit: Orbit) -> int:
        """Return the number under which an orbit and its mirror image are counted, and add them if they are new.

        A known orbit may appear again if Newton's method came near to it, but not within `SAME`.
        """
        here = orbit.at(self.phase)
        (owner,) = self._owners(np.array([[here.angle, here.velocity]]))
        if owner >= 0:
            return self.pairs[owner]
        self.counts.append(0)
        self._add(orbit)
        if not orbit.symmetric:
            self._add(mirrored(orbit))
        return len(self.counts) - 1

    def _add(self, orbit: Orbit) -> None:
        there = [orbit.at(self.phase + math.tau * cycle) for cycle in range(orbit.period)]
        self.rows = np.concatenate([self.rows, [(state.angle, state.velocity) for state in there]])
        self.owner = np.concatenate([self.owner, np.full(orbit.period, len(self.orbits))])
        self.orbits.append(orbit)
        self.pairs.append(len(self.counts) - 1)
