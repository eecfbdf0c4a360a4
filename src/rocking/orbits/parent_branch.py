"""Points at which a branch passes the branch from which it bifurcates: symmetry breakings and period doublings.

The branch turns at such a point. The test function of a fold vanishes there without a change of sign. Rounding therefore decides
if the kernel finds the point, how often, and under which name. Here it is found by the two halves of the chain, which are equal
there and change places. The orbit there is one of the other branch, on which the point is solved.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rocking.kernels.orbits import continuation as kernel
from rocking.orbits.event_chain import IMPACT, Chain, Condition, Special, equations
from rocking.orbits.grazing import special_row

# Largest distance of the two halves of a chain, in rad of phase, at which they are equal to rounding.
EQUAL = 1e-8
# The same at a special point from the kernel, which rounding moves along the branch.
NEARLY_EQUAL = 1e-4
# Largest relative difference of the parameter of such a point from the solved one; it is quadratic in the distance.
SAME_VALUE = 1e-5
# Largest difference of phases for two solved points to be identical.
SAME_PHASE = 1e-6
# Largest test function at a special point, relative to the sum of its terms. This ratio is 1 where the trace is infinite.
VANISHES = 0.5
CONDITION = Condition(Special.PERIOD_DOUBLING, -1, IMPACT, 0.0)


class Found(NamedTuple):
    """Special point of a branch."""

    chain: Chain
    row: np.ndarray
    kind: Special
    place: int  # index of the point of the branch after it


def special_points(chain: Chain, parameter: str, table: kernel.BranchTable) -> list[Found]:
    """Return the special points of a branch, with one at each passage of the branch from which it bifurcates."""
    rows = [
        Found(chain, row, Special(kind), index)
        for row, (kind, index) in zip(table.specials, table.changes.tolist(), strict=True)
        if kind == Special.GRAZING or _is_zero(chain, parameter, row)
    ]
    parent = parent_of(chain)
    if parent is None:
        return rows
    passages: list[Found] = []
    others = []
    for one in rows:
        near = None
        if _has_multiplier_one(one, parameter):
            near = _solved(parent, parameter, one.row, one.place, NEARLY_EQUAL)
        if near is None or not abs(near.row[-1] - one.row[-1]) <= SAME_VALUE * abs(one.row[-1]):
            others.append(one)
        else:
            _add(passages, near)
    differences = half_differences(chain, table.rows)
    clear = np.flatnonzero(np.abs(differences).max(axis=1) > EQUAL)
    for before, after in zip(clear[:-1].tolist(), clear[1:].tolist(), strict=True):
        if differences[before] @ differences[after] < 0.0:
            near = _between(parent, parameter, table.rows[before], table.rows[after], after)
            if near is not None:
                _add(passages, near)
    return sorted(others + passages, key=lambda one: one.place)


def parent_of(chain: Chain) -> Chain | None:
    """Return the chain of the orbits that repeat, or mirror themselves, after half a chain; None if there are none."""
    half, odd = divmod(len(chain.kinds), 2)
    if odd or chain.mirrored or not np.array_equal(chain.kinds[:half], chain.kinds[half:]):
        return None
    mirrored = chain.period % 2 == 1
    if (chain.kinds[:half] == IMPACT).sum() % 2 != mirrored:
        return None
    period = chain.period if mirrored else chain.period // 2
    return chain._replace(
        period=period, mirrored=mirrored, kinds=chain.kinds[:half].copy(), phases=chain.phases[:half]
    )


def _is_zero(chain: Chain, parameter: str, row: np.ndarray) -> bool:
    """Return whether a test function has a zero at a point, and not a pole: at a grazing the trace is infinite, of either sign."""
    *_, trace, determinant = equations(chain, parameter, row)
    least = abs(abs(trace) - 1.0 - determinant)
    return bool(least <= VANISHES * (1.0 + abs(trace) + determinant))


def _has_multiplier_one(special: Found, parameter: str) -> bool:
    """Return whether a multiplier of a special point is 1; at a period doubling of the branch itself it is -1."""
    if special.kind == Special.GRAZING:
        return False
    *_, trace, determinant = equations(special.chain, parameter, special.row)
    return abs(1.0 - trace + determinant) < abs(1.0 + trace + determinant)


def half_differences(chain: Chain, rows: np.ndarray) -> np.ndarray:
    """Return the distances of the phases of the second half of a chain from half a turn after those of the first."""
    half = len(chain.kinds) // 2
    return np.asarray(rows[:, half:-1] - rows[:, :half] - 0.5 * chain.turn)


def _between(
    parent: Chain, parameter: str, before: np.ndarray, after: np.ndarray, index: int
) -> Found | None:
    """Return the point between two points of a branch at which the halves of the chain change places."""
    here, there = (np.linalg.norm(_halves(parent, row)[1]) for row in (before, after))
    row = before + here / (here + there) * (after - before)
    return _solved(parent, parameter, row, index, float(here + there))


def _halves(parent: Chain, row: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean phases of both halves of a chain, and their distance."""
    half = len(parent.kinds)
    first, second = row[:half], row[half:-1] - parent.turn
    return 0.5 * (first + second), second - first


def _solved(parent: Chain, parameter: str, near: np.ndarray, index: int, reach: float) -> Found | None:
    """Return the special point of the other branch within a distance from a point, or None."""
    phases, differences = _halves(parent, near)
    if np.abs(differences).max() > reach:
        return None
    there = special_row(parent, CONDITION, parameter, np.append(phases, near[-1]))
    if there is None or np.abs(there[:-1] - phases).max() > reach:
        return None
    kind = Special.SYMMETRY_BREAKING if parent.mirrored else Special.PERIOD_DOUBLING
    return Found(parent._replace(phases=there[:-1]), there, kind, index)


def _add(passages: list[Found], point: Found) -> None:
    """Add a point unless it is known: rounding, or the overlap of a closed branch, may show it twice."""
    if all(np.abs(one.row[:-1] - point.row[:-1]).max() > SAME_PHASE for one in passages):
        passages.append(point)
