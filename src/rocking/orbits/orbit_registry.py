"""The orbits that a search has found so far, each met once and counted."""

from __future__ import annotations

import math

import numpy as np
from attrs import evolve

from rocking.model import Orbit, State, System
from rocking.motion import simulate
from rocking.orbits.event_chain import clocked
from rocking.orbits.find_orbit import orbit_from

# Starts that Newton's method leads this near to each other are one; orbits as near as this too.
SAME = 1e-6


def mirrored(orbit: Orbit) -> Orbit:
    """The mirror image of an orbit, which the other half of the forcing period makes an orbit too."""
    state = State(-orbit.state.angle, -orbit.state.velocity)
    return evolve(orbit, state=state, phase=(orbit.phase + math.pi) % math.tau)


class OrbitRegistry:
    """The orbits found so far, with all their states on the section at a forcing phase."""

    def __init__(self, system: System, phase: float) -> None:
        self.system, self.phase = system, phase
        self.orbits: list[Orbit] = []
        self.hits: list[int] = []
        self.rows = np.empty((0, 2))
        self.owner = np.empty(0, int)

    def add_states(self, states: np.ndarray, period: int) -> None:
        """Count the states that belong to known orbits; add the orbits of the others, with their mirror images."""
        states = states[~self._counted(states)]
        while len(states):
            orbit = orbit_from(self.system, self.phase, State(*map(float, states[0])), period)
            if orbit.impacts != 0 or orbit.brace_hits != 0 or abs(orbit.state.angle) > SAME:
                self._add(orbit)
                if not orbit.symmetric:
                    self._add(mirrored(orbit))
            near = np.hypot(*(states - states[0]).T) <= SAME
            near |= self._counted(states)
            states = states[~near]

    def _counted(self, states: np.ndarray) -> np.ndarray:
        """Which states belong to known orbits; their hits are counted."""
        if not len(self.rows):
            return np.zeros(len(states), bool)
        apart = np.hypot(states[:, 0, None] - self.rows[:, 0], states[:, 1, None] - self.rows[:, 1])
        nearest = apart.argmin(axis=1)
        close = apart[np.arange(len(states)), nearest] <= SAME
        for owner, number in zip(*np.unique(self.owner[nearest[close]], return_counts=True), strict=True):
            self.hits[owner] += int(number)
        return close

    def _add(self, orbit: Orbit) -> None:
        forcing = self.system.forcing
        wait = ((self.phase - orbit.phase) % math.tau) / forcing.frequency
        there = simulate(clocked(orbit.system, orbit.phase), orbit.state, cycles=orbit.period + 1)
        rows = np.column_stack(there.at(wait + forcing.period * np.arange(orbit.period)))
        self.rows = np.concatenate([self.rows, rows])
        self.owner = np.concatenate([self.owner, np.full(orbit.period, len(self.orbits))])
        self.orbits.append(orbit)
        self.hits.append(0)
