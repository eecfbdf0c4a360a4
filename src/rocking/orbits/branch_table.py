"""Public table of a branch of periodic orbits."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rocking.model.orbit import Stability, stability_of
from rocking.orbits.event_chain import multipliers_of

POINT = np.dtype(
    [
        ("parameter", float),
        ("phase", float),
        ("velocity", float),
        ("multipliers", complex, 2),
        ("stable", bool),
        ("stability", "U8"),
        ("peak", float),
    ]
)


def table(rows: np.ndarray, facts: np.ndarray, mirrored: bool) -> NDArray[np.void]:
    """Return the public table of a branch."""
    points = np.empty(len(rows), POINT)
    points["parameter"] = rows[:, -1]
    points["phase"] = np.mod(rows[:, 0], math.tau)
    points["velocity"] = facts["velocity"]
    traces = facts[["trace", "determinant"]].tolist()
    points["multipliers"] = [multipliers_of(trace, determinant, mirrored) for trace, determinant in traces]
    points["stability"] = [stability_of(trace, determinant) for trace, determinant in traces]
    points["stable"] = points["stability"] == Stability.STABLE
    points["peak"] = facts["peak"]
    points.flags.writeable = False
    return points
