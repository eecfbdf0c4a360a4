"""Points of a bifurcation curve in the unknowns of its equations, and points between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rocking.kernels.orbits import arclength
from rocking.kernels.orbits import bifurcation_curve as kernel
from rocking.orbits.event_chain import Chain, Condition, End, Special, problem_of
from rocking.orbits.grazing import rotated, turning_time
from rocking.orbits.normal_form import Chains, chains_of
from rocking.orbits.parameter import with_value


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
        return self._replace(chain=rotated(self.chain, 1), rows=rows, condition=condition)

    def corrected(self, near: np.ndarray, direction: np.ndarray) -> np.ndarray | None:
        """Return the point of the curve in the plane through a point near it across a direction; None if it is not found."""
        spans = [high - low for low, high in self.limits]
        problem = problem_of(self.chain, self.names, self.limits, self.step, spans)
        condition = self.condition
        if condition.kind == Special.GRAZING and not self.local:
            condition = condition._replace(
                time=turning_time(self.chain_at(near), self.names[1], near, condition)
            )
        out = np.empty((1, len(near)))
        start = arclength.Tangent(near.copy(), direction.copy())
        count, _ = kernel.follow_curve(problem, start, condition, out)
        return out[0] if count else None
