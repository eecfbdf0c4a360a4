"""Section of a block: area, centroid and second moment of a polygon, and the base on which it stands."""

from __future__ import annotations

from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from rocking.model.quantity import SIZES
from rocking.model.validation import Refusal, Text, reals, refuse_if

MAX_CORNERS = 1000
LEVEL = 1e-9
"""Largest difference of the heights of the lowest corners, in units of the height."""
SYMMETRIC = 1e-12
"""Largest offset that counts as none, in units of the width."""


class Section(NamedTuple):
    """Dimensions of a section in metres; the offset is that of the centroid from the middle of the base, along x."""

    height: float
    width: float
    offset: float
    centre_height: float
    radius_of_gyration: float


def section_of(outline: Any) -> Section:
    """Return the dimensions of a polygon (n, 2) of uniform density; TypeError or ValueError if it is no section of a block."""
    corners = np.asarray(reals("outline", outline))
    allowed = f"be 3 to {MAX_CORNERS:,} corners (x, y), an array of shape (n, 2)"
    if corners.ndim != 2 or corners.shape[1] != 2 or not 3 <= len(corners) <= MAX_CORNERS:
        raise Refusal("outline", allowed, Text(f"an array of shape {corners.shape}"))
    if np.array_equal(corners[0], corners[-1]):
        corners = corners[:-1]
    refuse_if(_crosses_itself(corners), "outline", "not cross or touch itself", Text("a polygon that does"))
    place = corners.min(axis=0)
    corners = corners - place
    width, height = corners.max(axis=0).tolist()
    low, high = SIZES
    if not (low <= width <= high and low <= height <= high):
        raise Refusal(
            "outline", f"be {low:g} to {high:g} m high and wide", Text(f"{height:g} m by {width:g} m")
        )
    feet = corners[corners[:, 1] <= LEVEL * height, 0]
    base = float(feet.max() - feet.min())
    refuse_if(
        base < low, "outline", "have a flat base, two lowest corners or more", Text("one lowest corner")
    )
    area, (x, y), moment = moments(corners)
    middle = float(feet.max() + feet.min()) / 2
    offset = x - middle
    allowed = "have its centroid above the base"
    got = Text(f"a centroid {abs(offset):.6g} m from the middle of a base {base:.6g} m wide")
    refuse_if(not abs(offset) < base / 2, "outline", allowed, got)
    return Section(height, base, 0.0 if abs(offset) < SYMMETRIC * base else offset, y, (moment / area) ** 0.5)


def moments(corners: np.ndarray) -> tuple[float, tuple[float, float], float]:
    """Return area, centroid and polar second moment about the centroid of a polygon (n, 2), by Green's theorem."""
    following = np.roll(corners, -1, axis=0)
    cross = corners[:, 0] * following[:, 1] - following[:, 0] * corners[:, 1]
    area = cross.sum() / 2
    centroid = ((corners + following) * cross[:, None]).sum(axis=0) / (6 * area)
    near, far = corners - centroid, following - centroid
    cross = near[:, 0] * far[:, 1] - far[:, 0] * near[:, 1]
    moment = (cross * (near**2 + near * far + far**2).sum(axis=1)).sum() / 12
    x, y = centroid.tolist()
    return abs(float(area)), (x, y), abs(float(moment))


def _crosses_itself(corners: np.ndarray) -> bool:
    """Return whether two edges that are not neighbours meet, or neighbours turn back on each other."""
    count = len(corners)
    if count < 3:
        return True
    following = np.roll(corners, -1, axis=0)
    first, second = np.array(list(combinations(range(count), 2))).T
    apart = (second - first > 1) & (second - first < count - 1)
    first, second = first[apart], second[apart]
    a, b, c, d = corners[first], following[first], corners[second], following[second]
    beyond = (np.maximum(a, b) < np.minimum(c, d)).any(axis=1) | (np.maximum(c, d) < np.minimum(a, b)).any(
        axis=1
    )
    meet = (_turn(a, b, c) * _turn(a, b, d) <= 0) & (_turn(c, d, a) * _turn(c, d, b) <= 0) & ~beyond
    before = np.roll(corners, 1, axis=0)
    back = (_turn(before, corners, following) == 0) & (
        ((before - corners) * (following - corners)).sum(axis=1) >= 0
    )
    return bool(meet.any() or back.any())


def _turn(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Return the sign of the turn from a over b to c, for n points each."""
    one, other = b - a, c - a
    return np.sign(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
