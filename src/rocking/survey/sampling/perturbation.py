"""Perturbed inputs: relative deviations of limited size, random or evenly spread."""

from __future__ import annotations

import numpy as np

from rocking.model.forcing import MAX_AMPLITUDE, PERIODS
from rocking.survey.harmonic_spec import SYSTEM, Points

TITLE = "Repeatability of the response of a free-standing block on a shaking base"
MAX_RELATIVE = 0.5
INPUTS = 5
"""Number of perturbed inputs: A, T, e and the initial Θ and Θ'."""


def spread(count: int) -> np.ndarray:
    """Return points (count, INPUTS) that are evenly spread over [-1, 1].

    They are multiples, modulo one, of powers of the root of g⁶ = g + 1.
    """
    root = 1.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (INPUTS + 1))
    steps = root ** -np.arange(1.0, INPUTS + 1)
    return 2.0 * ((0.5 + np.arange(count)[:, None] * steps) % 1.0) - 1.0


def perturbed(meant: Points, units: np.ndarray, off: float) -> Points:
    """Return n points whose A, T, e, Θ and Θ' deviate by the fraction `off` times `units` (n, INPUTS) in [-1, 1]."""
    factors = 1.0 + off * units
    systems, starts = meant.systems.copy(), meant.starts.copy()
    place = {name: k for k, name in enumerate(SYSTEM)}
    amplitude, period, restitution = (
        systems[:, place[name]] for name in ("amplitude", "period", "restitution")
    )
    np.minimum(amplitude * factors[:, 0], MAX_AMPLITUDE, out=amplitude)
    np.clip(period * factors[:, 1], *PERIODS, out=period)
    systems[:, place["frequency"]] = 2.0 * np.pi / period
    # uniform over the part of the range that is possible
    low, high = restitution * (1.0 - off), np.minimum(restitution * (1.0 + off), 1.0)
    restitution[:] = 0.5 * (low + high) + 0.5 * (high - low) * units[:, 2]
    reach = systems[:, place["brace_angle"]]
    starts[:, 0] = np.clip(starts[:, 0] * factors[:, 3], -reach, reach)
    starts[:, 1] *= factors[:, 4]
    return Points(systems, starts)
