"""Mean angles of chaotic responses, which distinguish an asymmetric chaotic attractor from its mirror image."""

from __future__ import annotations

import math

import numpy as np

from rocking.model.system import State, System, system_of
from rocking.motion.simulate import simulate
from rocking.survey.harmonic_spec import SYSTEM, Points

MAX_FOLLOWED = 20_000
"""Maximum number of cycles; the second half is averaged."""
BATCHES = 20
MAX_NUDGES, NUDGE = 100, 1e-15
"""Number and size of perturbations of an initial state that overturns in a second run because of rounding."""
APART = 10.0
"""Standard errors between the means of different attractors."""


def averages(points: Points, chaotic: np.ndarray, cycles: int, stop: np.ndarray) -> np.ndarray:
    """Compute the mean angle of chaotic points on the section, with its standard error from long batches.

    The computation ends early if another thread sets `stop[0]`.

    Returns
    -------
    array (n, 2)
        Mean Θ and its standard error; NaN for points that are not chaotic.
    """
    found = np.full((len(points.systems), 2), math.nan)
    count = min(cycles, MAX_FOLLOWED)
    for k in np.flatnonzero(chaotic):
        if stop[0]:
            break
        system = system_of(dict(zip(SYSTEM, points.systems[k].tolist(), strict=True)))
        late = _late_angles(system, State(*points.starts[k]), count)
        means = late[: late.size // BATCHES * BATCHES].reshape(BATCHES, -1).mean(axis=1)
        found[k] = means.mean(), means.std(ddof=1) / math.sqrt(BATCHES)
    return found


def _late_angles(system: System, start: State, cycles: int) -> np.ndarray:
    """Return Θ on the section in the second half of the cycles; NaN if the run and all perturbed runs overturn."""
    for nudge in range(MAX_NUDGES):
        beside = State(start.angle, start.velocity + nudge * NUDGE)
        motion = simulate(system, beside, cycles=cycles, record="section")
        if motion.outcome == "bounded":
            return np.asarray(motion.section()[cycles // 2 :, 0])
    return np.full(BATCHES, math.nan)


def grouped(means: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Return a group number for each mean; groups are `APART` standard errors apart. NaN has the number 0."""
    groups = np.zeros(means.size, int)
    known = np.flatnonzero(~np.isnan(means))
    if known.size == 0:
        return groups
    order = known[np.argsort(means[known])]
    wide = APART * np.maximum(errors[order][1:], errors[order][:-1])
    groups[order] = 1 + np.concatenate([[0], np.cumsum(np.diff(means[order]) > wide)])
    return groups
