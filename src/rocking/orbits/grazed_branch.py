"""The other branch at a grazing: the orbit with one contact more or less.

Both branches meet at the grazing orbit. The orbit without the contact is a smooth function of the parameter there. With the
contact the equations of the chain are smooth, too, in the phases of the events. There is one more event at a brace, and two at
the base, because the block crosses the base and returns at once. The solution is a motion where the contact has a speed. If both
branches lie on one side, two orbits meet and vanish as at a fold; else the orbit persists.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rocking.kernels.orbits import arclength
from rocking.orbits.branch import SpecialPoint
from rocking.orbits.event_chain import IMPACT, Chain, equations
from rocking.orbits.find_orbit import SAME, mirrored_half

OFFS = (1e-4, 1e-3, 1e-5)
"""Distances of the first point from the grazing, in rad or units of the range, that are tried one after another."""
PERSISTS, MEETS = "the orbit persists", "two orbits meet, as at a fold"


class Beginning(NamedTuple):
    """Chain of the other branch, its solution at the grazing, and directions in which it may continue."""

    chain: Chain
    row: np.ndarray
    directions: tuple[np.ndarray, ...]


def beginning(special: SpecialPoint) -> Beginning | None:
    """Return the beginning of the other branch at a grazing; None if its events were not found."""
    touch, row = special._touch, special._row
    if touch is None or special._origin is None:
        return None
    chain, condition = touch
    if chain.counts() != special._origin.counts:
        chain = _least(chain._replace(phases=row[:-1]))
        return _both_ways(chain, special.name, np.append(chain.phases, row[-1]))
    # the grazing lies on an arc of this chain
    level, after = condition.level, condition.arc + 1
    count = 2 if level == IMPACT else 1
    phase = chain.phases[condition.arc] + chain.system.harmonic.frequency * condition.time
    kinds, row = np.insert(chain.kinds, after, [level] * count), np.insert(row, after, [phase] * count)
    chain = chain._replace(kinds=kinds, phases=row[:-1])
    if count == 1:
        return _both_ways(chain, special.name, row)
    # two impacts at one instant: the arc between them only has a length on one side
    direction = np.zeros(len(row))
    direction[after], direction[after + 1] = -1.0, 1.0
    return Beginning(chain, row, (direction,))


def _least(chain: Chain) -> Chain:
    """Return the chain of an orbit over its least period, or half of it if the other half is the mirror image."""
    for times in range(1 if chain.mirrored else chain.period, 1, -1):
        count = len(chain.kinds) // times
        whole = chain.period % times == 0 and len(chain.kinds) == count * times
        if whole and np.array_equal(chain.kinds, np.tile(chain.kinds[:count], times)):
            later = chain.phases[count:] - chain.phases[:-count]
            if np.abs(later - chain.turn / times).max() <= SAME:
                chain = chain._replace(
                    period=chain.period // times,
                    kinds=chain.kinds[:count].copy(),
                    phases=chain.phases[:count],
                )
                break
    return mirrored_half(chain) or chain


def _both_ways(chain: Chain, name: str, row: np.ndarray) -> Beginning:
    """Return the beginning of a branch that is smooth at the grazing."""
    tangent = np.linalg.svd(equations(chain, name, row)[0])[2][-1]
    return Beginning(chain, row, (tangent, -tangent))


def begun(
    special: SpecialPoint, follow: Callable[[Chain, arclength.Tangent], int]
) -> tuple[Chain, arclength.Tangent] | None:
    """Return the chain of the other branch, and a point with a direction from which ``follow`` finds it; None without one."""
    found = beginning(special)
    if found is None:
        return None
    for off in OFFS:
        for direction in found.directions:
            start = arclength.Tangent(found.row + off * direction, direction)
            if follow(found.chain, start):
                return found.chain, start
    return None


def transition(special: SpecialPoint, value: float) -> str:
    """Return how the orbit changes at a grazing, if the other branch has a point at a value of the parameter."""
    if special._origin is None:
        return "unknown"
    same = (value - special.parameter) * special._origin.side > 0.0
    return MEETS if same else PERSISTS
