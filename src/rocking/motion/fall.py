"""Part of a motion that figures and files show, and its sampling."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rocking.model import Harmonic, Overturning, PiecewiseLinear

if TYPE_CHECKING:
    from rocking.motion.trajectory import Trajectory

STEPS = 100
"""Samples in the time in which the base acceleration varies."""
STEPS_OF_RECORD = 32
"""Samples in the unit of τ, at least, of a motion under a sampled base acceleration."""
MAX_STEPS_OF_RECORD = 1_000_000
"""Samples at most of such a motion, if its base acceleration has fewer."""
STEP_BACK = 0.25
"""Step in τ by which the time of a fall is sought before the time at which it is certain."""
FALLEN = 3.0
"""Value of |Θ| up to which a fall of the slender block is shown, far beyond its small angles."""


def has_cycles(motion: Trajectory) -> bool:
    """Return whether the base motion of a motion is periodic, so that its cycles can be counted."""
    return isinstance(motion.system.forcing, Harmonic)


def end_shown(motion: Trajectory) -> float:
    """Return the last time τ shown: the end of the run, or the instant in the fall of a block with the angle `fallen`."""
    if motion.overturning is None:
        return motion.duration
    return time_of_fall(motion, motion.overturning, fallen(motion))


def fallen(motion: Trajectory) -> float:
    """Return the value of |Θ| up to which a fall is shown: 3, or where a block with the full equation lies flat."""
    critical_angle = motion.system.critical_angle
    return FALLEN if critical_angle is None else 0.5 * math.pi / critical_angle


def sample_step(motion: Trajectory) -> float:
    """Return the default sampling step in τ: a hundredth of the forcing's time scale, or of a shorter motion.

    Under a sampled base acceleration it is the step of the samples, or a whole fraction of it. It is longer if a motion lasts
    much longer than its base motion.
    """
    forcing = motion.system.forcing
    if isinstance(forcing, PiecewiseLinear):
        end, most = end_shown(motion), max(MAX_STEPS_OF_RECORD, forcing.values.size)
        step = forcing.step / math.ceil(forcing.step * STEPS_OF_RECORD)
        return min(max(step, end / most), end / STEPS)
    return min(motion.system.forcing.time_scale, end_shown(motion)) / STEPS


def time_of_fall(motion: Trajectory, overturning: Overturning, angle: float) -> float:
    """Return the time τ at which an overturning motion reaches |Θ| = `angle`.

    If it starts beyond this angle: the time at which overturning is certain, or 1 if that is the start.
    """
    from scipy.optimize import brentq

    def beyond(time: float) -> float:
        return abs(float(motion.at(time)[0])) - angle

    before = after = overturning.time
    while before > 0 and beyond(before) >= 0:  # overturning may be certain only later
        before, after = max(before - STEP_BACK, 0.0), before
    if beyond(before) >= 0:
        return overturning.time or 1.0
    while beyond(after) < 0:
        before, after = after, after + 0.25
    return brentq(beyond, before, after, xtol=1e-12)
