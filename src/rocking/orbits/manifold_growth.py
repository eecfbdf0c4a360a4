"""Growth of a manifold on a section: points are added until neighbours are close (Hobson 1993, J. Comput. Phys. 104, 14)."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

# Largest angle between neighbouring pieces of a curve, rad, if they are longer than this fraction of the spacing.
BEND, SHORT = 0.2, 1e-2
MAX_POINTS = 400_000
# Smallest difference of times, relative to the longest one, above rounding.
FINEST = 1e-13
# Margin around the region of bounded motions.
MARGIN = 0.5


def region(response: float, frequency: float) -> np.ndarray:
    """Return the largest |Θ| and |Θ'| (2,) of all bounded motions without braces, from β and Ω, with a margin."""
    return np.array([1.0 + response, 1.0 + response * (1.0 + frequency)]) + MARGIN


def grow(
    images: Callable[[np.ndarray], np.ndarray], times: np.ndarray, spacing: float, box: np.ndarray
) -> tuple[np.ndarray, np.ndarray, bool]:
    """Grow a curve from its points at ``times``; ``images`` returns its points (n, 2) at any times (n,).

    Returns
    -------
    tuple of (ndarray, ndarray, bool)
        Times; points; True if the curve is resolved.
    """
    points = images(times)
    while True:
        wide = _too_wide(points, spacing, box)
        wide &= np.diff(times) > FINEST * times[-1]
        if not wide.any():
            return times, points, True
        if len(times) + wide.sum() > MAX_POINTS:
            return times, points, False
        new = 0.5 * (times[:-1] + times[1:])[wide]
        where = np.flatnonzero(wide) + 1
        points = np.insert(points, where, images(new), axis=0)
        times = np.insert(times, where, new)


def pieces(
    times: np.ndarray, points: np.ndarray, spacing: float, box: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return times and points of a curve within the region, with a row of NaN between its pieces."""
    # An impact at the phase of the section makes the curve discontinuous: Θ' jumps to e Θ'.
    with np.errstate(invalid="ignore", over="ignore"):
        torn = np.concatenate([[False], ~(np.hypot(*np.diff(points, axis=0).T) <= spacing)])
    rows = _within(points, torn, box)
    breaks = np.flatnonzero((np.diff(rows) > 1) | torn[rows[1:]]) + 1
    return np.insert(times[rows], breaks, math.nan), np.insert(points[rows], breaks, math.nan, axis=0)


def _within(points: np.ndarray, torn: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Return the indices of the points inside the box, and of the neighbours from which they are not ``torn``."""
    inside = (np.abs(points) <= box).all(axis=1)
    near = inside.copy()
    near[1:] |= inside[:-1] & ~torn[1:]
    near[:-1] |= inside[1:] & ~torn[1:]
    return np.flatnonzero(near & np.isfinite(points).all(axis=1))


def _too_wide(points: np.ndarray, spacing: float, box: np.ndarray) -> np.ndarray:
    """Return which pieces between neighbours must be halved: too long, too bent, or across the region of bounded motions."""
    with np.errstate(invalid="ignore", over="ignore"):
        steps = np.diff(points, axis=0)
        lengths = np.hypot(*steps.T)
        inside = (np.abs(points) <= box).all(axis=1)
        seen = inside[:-1] | inside[1:] | (np.sign(points[:-1, 0]) != np.sign(points[1:, 0]))
        wide = seen & ~(lengths <= spacing)
        cross = steps[:-1, 0] * steps[1:, 1] - steps[:-1, 1] * steps[1:, 0]
        dot = (steps[:-1] * steps[1:]).sum(axis=1)
        bent = (np.abs(np.arctan2(cross, dot)) > BEND) & inside[1:-1]
        long = lengths > SHORT * spacing
        wide[:-1] |= bent & long[:-1] & seen[:-1]
        wide[1:] |= bent & long[1:] & seen[1:]
    return wide
