"""How points turn about the centre of their island, and of how many islands they are."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from rocking.kernels.numerics import averages

Array = NDArray[np.float64]

MIN_TURNS = 64
# Digits in which both halves of a regular motion agree.
REGULAR_DIGITS = 9
MAX_DIGITS = 15
MAX_LOCK = 500
# An island this small, against speeds and phases of order one, turns by rounding: it counts as its centre.
# More digits than this an average over some ten thousand flights, each rounded, does not have, however well its halves agree.
CERTAIN_DIGITS = 14
POINT = 1e-6
# Seen from inside, a curve of many points leaves no such gap.
WIDEST_GAP = 1.5
WIDEST_JUMP = 0.25


def average(values: Array) -> tuple[float, int]:
    """The weighted Birkhoff average of a sequence, and to how many digits, 15 at most, those of its halves agree."""
    values = np.ascontiguousarray(values)
    digits = math.floor(averages.digits_of_agreement_plain(values))
    return averages.weighted_mean_plain(values), min(max(digits, 0), MAX_DIGITS)


def fraction_of(value: float, digits: int) -> Fraction | None:
    """The fraction that a number is to all its digits, or None."""
    near = Fraction(value).limit_denominator(MAX_LOCK)
    off = 10.0 ** (1 - min(digits, CERTAIN_DIGITS)) * max(abs(value), 1.0 / MAX_LOCK)
    return near if abs(value - near) <= off else None


def deviations(phases: Array, speeds: Array) -> Array | None:
    """Speed and phase about their means, (n, 2), scaled to 1 at most; None where all points are one.

    In this order counter-clockwise here is counter-clockwise in (Θ, Θ'), whichever way Θ = 0 is crossed: Θ, Θ', ψ make a
    right-handed system, the motion goes towards growing ψ on the one section and towards growing Θ (or −Θ) on the other.
    """
    offsets = np.mod(phases - phases[0] + math.pi, 2.0 * math.pi) - math.pi
    speeds = np.ascontiguousarray(speeds)
    points = np.column_stack(
        [speeds - averages.weighted_mean_plain(speeds), offsets - averages.weighted_mean_plain(offsets)]
    )
    sizes = np.abs(points).max(axis=0)
    return None if sizes.max() < POINT else points / np.maximum(sizes, POINT)


def turning_of(points: Array) -> tuple[float | None, int, int]:
    """Mean turn from point to point about the origin, its digits, and of how many islands the points are; None on no curve.

    Points are taken as they are; or straightened, where they are bent like a banana about a mean outside.
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
    """What is left of one coordinate without its parabola over the other."""
    straight = bent - np.polynomial.Polynomial.fit(along, bent, 2)(along)
    return straight / max(float(np.abs(straight).max()), POINT)


def _surrounds(angles: Array, radii: Array) -> bool:
    """Whether points lie on one curve around the origin, met once in every direction."""
    order = np.argsort(angles)
    gaps = np.diff(angles[order], append=angles[order[0]] + 2.0 * math.pi)
    jumps = np.abs(np.diff(radii[order], append=radii[order[0]]))
    return bool(gaps.max() <= WIDEST_GAP and jumps[gaps < 0.1].max(initial=0.0) <= WIDEST_JUMP * radii.max())
