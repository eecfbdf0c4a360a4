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
FALLEN = 3.0
"""Value of |Θ| up to which a fall is shown."""


def has_cycles(motion: Trajectory) -> bool:
    """Return whether the base motion of a motion is periodic, so that its cycles can be counted."""
    return isinstance(motion.system.forcing, Harmonic)


def end_shown(motion: Trajectory) -> float:
    """Return the last time τ shown: the end of the run, or the instant with |Θ| = 3 in the fall of an overturned block."""
    if motion.overturning is None:
        return motion.duration
    return time_of_fall(motion, motion.overturning, FALLEN)


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
    """Return the time τ at which an overturning motion reaches |Θ| = `angle`; 1 if it starts beyond this angle."""
    from scipy.optimize import brentq

    def beyond(time: float) -> float:
        return abs(float(motion.at(time)[0])) - angle

    before = after = overturning.time
    if beyond(after) >= 0:
        return after if after > 0 else 1.0
    while beyond(after) < 0:
        before, after = after, after + 0.25
    return brentq(beyond, before, after, xtol=1e-12)
