"""Points of a branch in the unknowns of its equations: their orbits, and orbits between them."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from rocking.model.orbit import Orbit
from rocking.orbits.event_chain import Chain, orbit_of, solved, states


class BranchRows(Protocol):
    """Points of a branch in the unknowns of its equations."""

    def orbit(self, index: int) -> Orbit:
        """Return the orbit of a point."""

    def between(self, index: int, share: float, value: float) -> Orbit | None:
        """Return the orbit at a value of the parameter near the point a share of the way to the next one, if there is one."""

    def section(self, phase: float) -> np.ndarray:
        """Return Θ and Θ' of all orbits at a forcing phase in the cycles of a period, shape (points, period, 2)."""


class ChainRows(NamedTuple):
    """Points of a branch of slender blocks: phases of the events of each orbit, and the parameter."""

    chain: Chain
    name: str
    rows: np.ndarray
    facts: np.ndarray

    def orbit(self, index: int) -> Orbit:
        """Return the orbit of a point."""
        facts = self.facts[index]
        return orbit_of(self.chain, self.name, self.rows[index], facts["trace"], facts["determinant"])

    def between(self, index: int, share: float, value: float) -> Orbit | None:
        """Return the orbit at a value of the parameter near the point a share of the way to the next one, if there is one."""
        near = self.rows[index]
        if share:
            near = near + share * (self.rows[index + 1] - near)
        there = solved(self.chain, self.name, value, near)
        if not there.found:
            # a grazing end, where a motion may touch or not, is known although it is not found again
            return None if share else self.orbit(index)
        return orbit_of(self.chain, self.name, there.phases, there.trace, there.determinant)

    def section(self, phase: float) -> np.ndarray:
        """Return Θ and Θ' of all orbits at a forcing phase in the cycles of a period, shape (points, period, 2)."""
        return states(self.chain, self.name, self.rows, phase, self.chain.period)
