"""Rotation of points about the centre of their island, and the number of islands."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from rocking.kernels.numerics import averages

Array = NDArray[np.float64]

MIN_TURNS = 64
# Number of digits to which averages over both halves of a regular motion agree.
REGULAR_DIGITS = 9
MAX_DIGITS = 15
MAX_LOCK = 500
# An average over about ten thousand rounded arcs is accurate to no more digits, even if its halves agree better.
CERTAIN_DIGITS = 14
# A smaller island, compared with speeds and phases of order one, is dominated by rounding and counts as a point.
POINT = 1e-6
# Largest angular gap of a closed curve with many points, as seen from inside.
WIDEST_GAP = 1.5
WIDEST_JUMP = 0.25


def average(values: Array) -> tuple[float, int]:
    """Return the weighted Birkhoff average of a sequence and the number of digits of agreement of its halves.

    Returns
    -------
    tuple of (float, int)
        Average; number of digits, 15 at most.
    """
    values = np.ascontiguousarray(values)
    weights = np.empty((len(values) + 1) // 2)
    digits = math.floor(averages.digits_of_agreement_plain(values, weights))
    return averages.weighted_mean_plain(values, weights), min(max(digits, 0), MAX_DIGITS)


def fraction_of(value: float, digits: int) -> Fraction | None:
    """Return the fraction that equals a number to all its digits, or None."""
    near = Fraction(value).limit_denominator(MAX_LOCK)
    off = 10.0 ** (1 - min(digits, CERTAIN_DIGITS)) * max(abs(value), 1.0 / MAX_LOCK)
    return near if abs(value - near) <= off else None


def deviations(phases: Array, speeds: Array) -> Array | None:
    """Return speeds and phases relative to their means, shape (n, 2), scaled to 1 at most; None if all points coincide.

    In this order, counter-clockwise here is counter-clockwise in (Θ, Θ') for both directions of crossing Θ = 0. The reason
    is that Θ, Θ', ψ form a right-handed system. The motion crosses one section towards growing ψ, and the other towards
    growing Θ (or −Θ).
    """
    offsets = np.mod(phases - phases[0] + math.pi, 2.0 * math.pi) - math.pi
    speeds = np.ascontiguousarray(speeds)
    weights = np.empty((len(speeds) + 1) // 2)
    points = np.column_stack(
        [
            speeds - averages.weighted_mean_plain(speeds, weights),
            offsets - averages.weighted_mean_plain(offsets, weights),
        ]
    )
    sizes = np.abs(points).max(axis=0)
    return None if sizes.max() < POINT else points / np.maximum(sizes, POINT)


def turning_of(points: Array) -> tuple[float | None, int, int]:
    """Return the mean rotation from point to point about the origin, its digits and the number of islands.

    Points on a curve that does not surround its mean are straightened first, by subtracting a parabola.

    Returns
    -------
    tuple of (float or None, int, int)
        Mean rotation in turns (None without a closed curve); digits of agreement; number of islands.
    """
    fast, late = points.T
    for x, y in ((fast, late), (_unbent(fast, late), late), (fast, _unbent(late, fast))):
        angles = np.arctan2(y, x)
        mean, digits = average(np.mod(np.diff(angles), 2.0 * math.pi) / (2.0 * math.pi))
        fraction = fraction_of(mean, digits) if digits >= REGULAR_DIGITS else None
        if fraction is not None and fraction.denominator > 1:
            return mean, digits, fraction.denominator
        if fraction is None and _surrounds(angles, np.hypot(x, y)):
            return mean, digits, 1
    return None, 0, 1


def _unbent(bent: Array, along: Array) -> Array:
    """Return one coordinate minus its least-squares parabola over the other, scaled to 1 at most."""
    straight = bent - np.polynomial.Polynomial.fit(along, bent, 2)(along)
    return straight / max(float(np.abs(straight).max()), POINT)


def _surrounds(angles: Array, radii: Array) -> bool:
    """Return whether points lie on one curve around the origin, with one point in every direction."""
    order = np.argsort(angles)
    gaps = np.diff(angles[order], append=angles[order[0]] + 2.0 * math.pi)
    jumps = np.abs(np.diff(radii[order], append=radii[order[0]]))
    return bool(gaps.max() <= WIDEST_GAP and jumps[gaps < 0.1].max(initial=0.0) <= WIDEST_JUMP * radii.max())
