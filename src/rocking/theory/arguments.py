"""Validation of arguments of the closed forms: numbers or arrays that broadcast."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rocking.model.quantity import AMPLITUDE, PERIOD
from rocking.model.validation import Refusal, Text, one_of, reals

MAX_CYCLES = 9_999
MAX_SIZE = 1e100
"""Largest size of an angle, a velocity, a phase or a time: its square does not overflow."""
ORBITS = {"upper": 1.0, "lower": -1.0}


def between(name: str, values: Any, low: float, high: float) -> Any:
    """Return the values as floats in [low, high]; ValueError that names the first one outside."""
    array = np.asarray(reals(name, values))
    outside = ~((array >= low) & (array <= high))
    if outside.any():
        first = array[outside].flat[0] if array.ndim else values
        raise Refusal(name, f"lie in [{low:.6g}, {high:.6g}]", first)
    return array


def together(**values: Any) -> list[Any]:
    """Return checked arguments, by name; ValueError if their shapes do not broadcast."""
    shapes = [np.shape(value) for value in values.values()]
    try:
        np.broadcast_shapes(*shapes)
    except ValueError:
        got = ", ".join(map(str, shapes))
        raise Refusal(
            ", ".join(f"{{{name}}}" for name in values), "have shapes that broadcast", Text(got)
        ) from None
    return [np.asarray(value) for value in values.values()]


def amplitudes(values: Any) -> Any:
    """Return amplitudes A, checked."""
    return between("amplitude", values, 0.0, AMPLITUDE.range[1])


def frequencies(period: Any) -> Any:
    """Return the angular frequencies Ω = 2π/T of periods T, checked."""
    return math.tau / between("period", period, *PERIOD.range)


def restitutions(values: Any) -> Any:
    """Return coefficients of restitution e, checked."""
    return between("restitution", values, 0.0, 1.0)


def odd(values: Any) -> Any:
    """Return the numbers n of forcing cycles of symmetric modes, checked to be odd."""
    array = np.asarray(reals("n", values))
    with np.errstate(invalid="ignore"):  # infinity has no remainder
        wrong = ~((array >= 1) & (array <= MAX_CYCLES) & (array % 2 == 1))
    if wrong.any():
        first = array[wrong].flat[0] if array.ndim else values
        allowed = f"be an odd whole number in [1, {MAX_CYCLES}]"
        even = (0.5 * float(array[wrong].flat[0])).is_integer()
        remedy = (
            "no mode with even n is symmetric: half a response later the forcing is unchanged, not reversed"
        )
        raise Refusal("n", allowed, first, remedy if even else "")
    return array


def side_of(orbit: str) -> float:
    """Return the sign of the velocity on one of the two heteroclinic orbits."""
    return ORBITS[one_of("orbit", orbit, tuple(ORBITS))]


def sizes(name: str, values: Any) -> Any:
    """Return angles, velocities, phases or times, checked to be finite and of size up to 1e100."""
    return np.asarray(reals(name, values, MAX_SIZE))


def plain(values: Any) -> Any:
    """Return a float if no argument was an array."""
    return values.item() if np.ndim(values) == 0 else values
