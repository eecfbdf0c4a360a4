"""Ends of bifurcation curves where the orbits merge with those from which they bifurcate."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rocking.orbits import normal_form
from rocking.orbits.curve_rows import CurveRows
from rocking.orbits.curve_zeros import Bracket, Test, locate_zero
from rocking.orbits.event_chain import Chain, End, Special
from rocking.orbits.parent_branch import CONDITION, half_differences, parent_of

LOST_WITHIN = 0.1
"""Largest distance of the halves of a chain, in rad, at the end of a curve that is lost because they become equal.

With any step, curves were lost at distances from 0.005 to 0.01.
"""
REACHES = (2.0, 4.0, 8.0)
"""Lengths beyond the last point, in units of the extrapolated one, in which an end is searched for."""


class CurveEnd(NamedTuple):
    """End of a curve, on the same curve or on that of the orbits from which its orbits bifurcate."""

    kind: str  # of the test function
    rows: CurveRows
    row: np.ndarray
    errors: tuple[float, float]


def until_parent(rows: CurveRows, start: int) -> CurveRows:
    """Return a curve of folds up to the points at which its orbits merge with those from which they bifurcate.

    Both halves of the chain are equal at such a point, and change places beyond. The curve then has the same orbits again,
    one half of a chain later, or their mirror images. The equations are singular at this point, so that rounding decides if the
    kernel passes it.

    Parameters
    ----------
    rows : CurveRows
        Points of the curve.
    start : int
        Index of the point from which it was followed.

    Returns
    -------
    CurveRows
        Points between two such points, and those that do not lie beyond one.
    """
    if rows.condition.kind != Special.FOLD or parent_of(rows.chain) is None:
        return rows
    points, (first, last) = rows.rows, rows.ends
    differences = half_differences(rows.chain, points[:, :-1])
    swaps = np.flatnonzero((differences[:-1] * differences[1:]).sum(axis=1) < 0.0)
    before, after = swaps[swaps < start], swaps[swaps >= start]
    if last == End.CLOSED and len(swaps):
        # the last point lies beyond the first one
        points = np.concatenate([points[swaps[-1] + 1 : -1], points[: swaps[0] + 1]])
        return rows._replace(rows=points, ends=(End.MERGED, End.MERGED))
    low, high = 0, len(points)
    if len(before):
        low, first = int(before[-1]) + 1, End.MERGED
    if len(after):
        high, last = int(after[0]) + 1, End.MERGED
    cut = rows._replace(rows=points[low:high])
    first = End.MERGED if first == End.LOST and _nears_merger(cut.rows, cut) else first
    last = End.MERGED if last == End.LOST and _nears_merger(cut.rows[::-1], cut) else last
    return cut._replace(ends=(first, last))


def _nears_merger(inwards: np.ndarray, rows: CurveRows) -> bool:
    """Return whether both halves of the chain are almost equal at an end of a curve, and less so inwards."""
    distance = np.linalg.norm(half_differences(rows.chain, inwards[:1, :-1]))
    return bool(distance <= LOST_WITHIN) and _extrapolate_merger(inwards, rows) is not None


def _extrapolate_merger(inwards: np.ndarray, rows: CurveRows) -> tuple[int, float] | None:
    """Extrapolate the points at an end of a curve to the place at which both halves of the chain are equal.

    The parameters are linear in the squared distance of the halves.

    Returns
    -------
    tuple of (int, float) or None
        Index of a point whose squared distance is more than twice that of the first point.
        Distance of the place from the first point, as a fraction of the distance of these two points.
        None if there is no such point.
    """
    squares = (half_differences(rows.chain, inwards[:, :-1]) ** 2).sum(axis=1)
    far = int(np.argmax(squares > 2.0 * squares[0]))
    if far == 0:
        return None
    return far, float(squares[0] / (squares[far] - squares[0]))


def degenerate_end(rows: CurveRows, inwards: np.ndarray) -> CurveEnd | None:
    """Return the end of a curve of folds at which its orbits merge with those from which they bifurcate, or None.

    The bifurcation of the other orbits is degenerate there. The point is solved on their curve, which is regular.

    Parameters
    ----------
    rows : CurveRows
        Curve of folds.
    inwards : ndarray, shape (n, k + 2)
        Its points, beginning at this end.
    """
    parent, found = parent_of(rows.chain), _extrapolate_merger(inwards, rows)
    if parent is None or found is None:
        return None
    far, share = found
    other = rows._replace(chain=parent, condition=CONDITION)
    chord = mean_halves(inwards[0], parent) - mean_halves(inwards[far], parent)
    start = other.corrected(mean_halves(inwards[far], parent), chord / np.linalg.norm(chord))
    kind = "symmetry-breaking" if parent.mirrored else "period-doubling"
    test = Test(f"degenerate-{kind}", lambda of, at: normal_form.doublings(of.chains(at)))
    reaches = [1.0 + reach * share for reach in REACHES]
    return None if start is None else zero_between(other, test, start, chord, reaches)


def mean_halves(row: np.ndarray, parent: Chain) -> np.ndarray:
    """Return a point with the mean phases of both halves of a chain."""
    half = len(parent.kinds)
    return np.append(0.5 * (row[:half] + row[half:-2] - parent.turn), row[-2:])


def zero_between(
    rows: CurveRows, test: Test, start: np.ndarray, chord: np.ndarray, reaches: Sequence[float]
) -> CurveEnd | None:
    """Return the zero of a test function between a point and one at some chords from it, or None."""
    for reach in reaches:
        stop = rows.corrected(start + reach * chord, chord / np.linalg.norm(chord))
        if stop is None:
            continue
        part = rows._replace(rows=np.stack([start, stop]))
        (first, last), directions = test.values(part, part.rows)
        if first * last < 0.0:
            found = locate_zero(part, test, Bracket(0, 0.0, 1.0, max(abs(first), abs(last)), directions[0]))
            return None if found is None else CurveEnd(test.kind, part, *found)
    return None
