"""Integration in fixed steps by the classical Runge–Kutta method, as common programs do it, for many scales at a time.

It serves for comparison only. Its end of the motion is judged by the exact condition, so that all differences are integration errors.
"""

from __future__ import annotations

import itertools

import numpy as np

FAR = 20.0
"""Angle beyond which the block is followed no more: no acceleration of these runs brings it back."""


def overturned(
    samples: np.ndarray, step: float, restitution: float, substeps: int, *, interpolated: bool
) -> np.ndarray:
    """Return whether the block overturns, from integration in fixed steps.

    Parameters
    ----------
    samples : ndarray, shape (n, m)
        Normalised base accelerations of m runs, linear between samples.
    step : float
        Normalised time between two samples.
    restitution : float
        Coefficient of restitution.
    substeps : int
        Steps of integration between two samples.
    interpolated : bool
        Whether an impact is placed within its step by linear interpolation; otherwise it is placed at the step's end.

    Returns
    -------
    ndarray of bool, shape (m,)
    """
    runs = samples.shape[1]
    angle, velocity, side = np.zeros(runs), np.zeros(runs), np.zeros(runs)
    size = step / substeps
    for first, second in itertools.pairwise(samples):
        slope = (second - first) / step
        for number in range(substeps):
            start = first + slope * (number * size)
            side = np.where((side == 0.0) & (np.abs(start) > 1.0), -np.sign(start), side)
            far = np.abs(angle) > FAR
            moving = (side != 0.0) & ~far
            new_angle, new_velocity = _step(angle, velocity, side, start, slope, size)
            hit = moving & (new_angle * side < 0.0)
            new_angle, new_velocity = (
                np.where(moving, new, old) for new, old in ((new_angle, angle), (new_velocity, velocity))
            )
            if hit.any():
                new_angle[hit], new_velocity[hit], side[hit] = _impact(
                    angle[hit],
                    velocity[hit],
                    new_angle[hit],
                    new_velocity[hit],
                    side[hit],
                    start[hit],
                    slope[hit],
                    (size, restitution, interpolated),
                )
            angle, velocity = new_angle, new_velocity
    return _falls_later(angle, velocity, side, restitution)


def _step(angle, velocity, side, start, slope, size):
    """Return angle and velocity after a step of Θ'' = Θ − σ − a."""

    def rate(u, after):
        return u - side - start - slope * after

    k1, half = rate(angle, 0.0), 0.5 * size
    v2 = velocity + half * k1
    k2 = rate(angle + half * velocity, half)
    v3 = velocity + half * k2
    k3 = rate(angle + half * v2, half)
    v4 = velocity + size * k3
    k4 = rate(angle + size * v3, size)
    return (
        angle + size / 6 * (velocity + 2 * v2 + 2 * v3 + v4),
        velocity + size / 6 * (k1 + 2 * k2 + 2 * k3 + k4),
    )


def _impact(angle, velocity, new_angle, new_velocity, side, start, slope, options):
    """Return angle, velocity and side at the end of a step with an impact."""
    size, restitution, interpolated = options
    if interpolated:
        part = size * angle / (angle - new_angle)  # 0 for a block that has just left the base
        _, before = _step(angle, velocity, side, start, slope, part)
        after = restitution * before
        u, v = _step(np.zeros_like(angle), after, -side, start + slope * part, slope, size - part)
        stays = u * side >= 0.0
    else:
        u, v = np.zeros_like(angle), restitution * new_velocity
        stays = np.zeros(angle.shape, bool)
    # A hop that a step does not resolve is taken for rest.
    rests = stays | (np.abs(v) < 0.5 * size * np.maximum(1.0 - np.abs(start), 0.0))
    return np.where(rests, 0.0, u), np.where(rests, 0.0, v), np.where(rests, 0.0, -side)


def _falls_later(angle, velocity, side, restitution):
    """Return whether the block overturns after the end of the record, by the exact condition."""
    u, v = side * angle, side * velocity
    speed = np.sqrt(np.maximum(1.0 + v * v - (u - 1.0) ** 2, 0.0))
    return (side != 0.0) & ((u + v > 1.0) | (restitution * speed > 1.0))
