"""Checks of the arguments of a ground motion."""

from __future__ import annotations

from typing import Any

import numpy as np

from rocking.model import piecewise_linear
from rocking.model.validation import finite, instance, one_of, within

STEPS = (1e-6, 1e3)
MAX_ACCELERATION = MAX_FACTOR = 1e6
BASELINES = {"none": None, "mean": 0, "linear": 1, "quadratic": 2}
"""Degree of the polynomial that is fitted to the acceleration and subtracted."""


def samples(values: Any) -> np.ndarray:
    """Return the samples, after checking."""
    return piecewise_linear.samples("acceleration", values, MAX_ACCELERATION)


def step(value: float) -> float:
    """Return the time step in s, after checking."""
    return within("step", value, *STEPS, "s")


def name(value: str) -> str:
    """Return the name, after checking."""
    return instance("name", value, str)


def component(value: str) -> str:
    """Return the component, after checking."""
    return instance("component", value, str)


def factor(value: float) -> float:
    """Return the factor, after checking."""
    return finite("factor", value, MAX_FACTOR)


def baseline(value: str) -> str:
    """Return the baseline, after checking."""
    return one_of("baseline", value, tuple(BASELINES))
