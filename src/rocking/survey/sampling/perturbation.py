"""Inputs that are off by a little: the same share of themselves at most, drawn at random or spread evenly."""

from __future__ import annotations

import numpy as np

from rocking.model import MAX_AMPLITUDE, PERIODS
from rocking.survey.spec import SYSTEM, Points

TITLE = "Repeatability of the response of a free-standing block on a shaking base"
MAX_RELATIVE = 0.5
INPUTS = 5
"""A, T, e, Θ and Θ' at the start."""


def spread(count: int) -> np.ndarray:
    """Points (count, INPUTS) spread evenly over [-1, 1]: multiples of powers of the root of g⁶ = g + 1, modulo one."""
    root = 1.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (INPUTS + 1))
    steps = root ** -np.arange(1.0, INPUTS + 1)
    return 2.0 * ((0.5 + np.arange(count)[:, None] * steps) % 1.0) - 1.0


def perturbed(meant: Points, units: np.ndarray, off: float) -> Points:
    """Points (n) with A, T, e, Θ and Θ' off by that share of themselves times `units` (n, INPUTS), which lie in [-1, 1]."""
    factors = 1.0 + off * units
    systems, starts = meant.systems.copy(), meant.starts.copy()
    place = {name: k for k, name in enumerate(SYSTEM)}
    amplitude, period, restitution = (
        systems[:, place[name]] for name in ("amplitude", "period", "restitution")
    )
    np.minimum(amplitude * factors[:, 0], MAX_AMPLITUDE, out=amplitude)
    np.clip(period * factors[:, 1], *PERIODS, out=period)
    systems[:, place["frequency"]] = 2.0 * np.pi / period
    # drawn evenly from what is possible
    low, high = restitution * (1.0 - off), np.minimum(restitution * (1.0 + off), 1.0)
    restitution[:] = 0.5 * (low + high) + 0.5 * (high - low) * units[:, 2]
    reach = systems[:, place["brace_angle"]]
    starts[:, 0] = np.clip(starts[:, 0] * factors[:, 3], -reach, reach)
    starts[:, 1] *= factors[:, 4]
    return Points(systems, starts)
