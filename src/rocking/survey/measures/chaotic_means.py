"""Chaotic responses told apart by where they are on average, as unsymmetric ones are from their mirror images."""

from __future__ import annotations

import math

import numpy as np

from rocking.model import State, System, system_of
from rocking.motion import simulate
from rocking.survey.spec import SYSTEM, Points

MAX_FOLLOWED = 20_000
"""Cycles, of which the second half is averaged."""
BATCHES = 20
MAX_NUDGES, NUDGE = 100, 1e-15
"""A start that rounding decides may overturn when it is followed again; one beside it is taken then."""
APART = 10.0
"""Standard errors between two averages that are not of one attractor."""


def averages(points: Points, chaotic: np.ndarray, cycles: int, stop: np.ndarray) -> np.ndarray:
    """(mean Θ on the section, its standard error) of those points; NaN of all others.

    The error is that of the means of long batches. Once another thread sets `stop[0]` no more of them are followed.
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
    """Θ on the section in the second half of so many cycles; NaN if nothing stays that begins there, but for rounding."""
    for nudge in range(MAX_NUDGES):
        beside = State(start.angle, start.velocity + nudge * NUDGE)
        motion = simulate(system, beside, cycles=cycles, record="section")
        if motion.outcome == "bounded":
            return np.asarray(motion.section()[cycles // 2 :, 0])
    return np.full(BATCHES, math.nan)


def grouped(means: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """A number for each mean: another one where no mean lies within `APART` standard errors; 0 where it is NaN."""
    groups = np.zeros(means.size, int)
    known = np.flatnonzero(~np.isnan(means))
    if known.size == 0:
        return groups
    order = known[np.argsort(means[known])]
    wide = APART * np.maximum(errors[order][1:], errors[order][:-1])
    groups[order] = 1 + np.concatenate([[0], np.cumsum(np.diff(means[order]) > wide)])
    return groups
