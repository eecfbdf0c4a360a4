"""Special points of a branch that differ: of those of the same orbit, its mirror image or a later start, one is kept."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from rocking.orbits.branch import SpecialPoint
from rocking.orbits.event_chain import Chain, sides_of

# Largest relative difference of the parameter, and of a phase in rad, between two passages of one special point.
SAME_PARAMETER, SAME_PHASE = 1e-9, 1e-5


def distinct(points: Iterable[SpecialPoint]) -> tuple[SpecialPoint, ...]:
    """Return the special points of a branch, each at its first passage."""
    found: list[SpecialPoint] = []
    for point in points:
        if not any(_same(point, other) for other in found):
            found.append(point)
    return tuple(found)


def _same(one: SpecialPoint, other: SpecialPoint) -> bool:
    """Return whether two special points of a branch have the same orbit, some cycles later, or mirror images of each other."""
    if one.kind != other.kind or one._chain is None or other._chain is None:
        return False
    # a branch may lie on both sides of a grazing
    if one.kind == "grazing" and one._origin != other._origin:
        return False
    if not abs(one.parameter - other.parameter) <= SAME_PARAMETER * abs(one.parameter):
        return False
    if (one.orbit.period, one.orbit.symmetric) != (other.orbit.period, other.orbit.symmetric):
        return False
    first, second = _events(one._chain, one._row[:-1]), _events(other._chain, other._row[:-1])
    return first.shape == second.shape and any(
        _agree(first, second, half_turns, math.tau * one.orbit.period)
        for half_turns in range(2 * one.orbit.period)
    )


def _events(chain: Chain, phases: np.ndarray) -> np.ndarray:
    """Return phase, kind and side after each event of a whole period."""
    events = np.stack([phases, chain.kinds, sides_of(chain)], axis=1)
    if not chain.mirrored:
        return events
    later = events * [1.0, 1.0, -1.0] + [chain.turn, 0.0, 0.0]
    return np.concatenate([events, later])


def _agree(first: np.ndarray, second: np.ndarray, half_turns: int, whole: float) -> bool:
    """Return whether the events of two orbits agree if the second begins some half turns later, mirrored if their number is odd."""
    moved = second * [1.0, 1.0, (-1.0) ** half_turns] + [math.pi * half_turns, 0.0, 0.0]
    apart = (moved[None, :, 0] - first[:, None, 0] + 0.5 * whole) % whole - 0.5 * whole
    same = (np.abs(apart) <= SAME_PHASE) & (moved[None, :, 1:] == first[:, None, 1:]).all(axis=2)
    return bool(same.any(axis=1).all() and same.any(axis=0).all())
