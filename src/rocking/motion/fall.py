"""How far the fall of an overturned block is followed, in pictures and in files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rocking.model import Overturning

if TYPE_CHECKING:
    from rocking.motion.trajectory import Trajectory

STEPS = 100
"""Samples of a period."""
FALLEN = 3.0
"""|Θ| up to which a fall is followed."""


def end_shown(motion: Trajectory) -> float:
    """Last time τ shown of a motion: the end of its run, or where |Θ| = 3 in the fall of an overturned block."""
    if motion.overturning is None:
        return motion.duration
    return time_of_fall(motion, motion.overturning, FALLEN)


def sample_step(motion: Trajectory) -> float:
    """Time τ between samples unless one is given: a hundredth of a period, or of a motion that ends before."""
    return min(motion.system.forcing.period, end_shown(motion)) / STEPS


def time_of_fall(motion: Trajectory, overturning: Overturning, angle: float) -> float:
    """Time τ at which a motion that is past return reaches |Θ| = `angle`; one unit of time if it began beyond."""
    from scipy.optimize import brentq

    def beyond(time: float) -> float:
        return abs(float(motion.at(time)[0])) - angle

    before = after = overturning.time
    if beyond(after) >= 0:
        return after if after > 0 else 1.0
    while beyond(after) < 0:
        before, after = after, after + 0.25
    return brentq(beyond, before, after, xtol=1e-12)
