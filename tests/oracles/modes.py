"""Symmetric (1, n) modes in closed form, eqs (8)-(10) of Spanos and Koh as Yim & Lin (1991) give them, in plain numbers."""

import math
from typing import NamedTuple


class SymmetricMode(NamedTuple):
    """Speed just after an impact, forcing phase there, trace of the half-cycle's tangent (determinant e²)."""

    velocity: float
    phase: float
    trace: float


def _half(period, restitution, n):
    frequency = 2 * math.pi / period
    h = n * math.pi / frequency
    less, more = (1 - restitution) / (2 * restitution), (1 + restitution) / (2 * restitution)
    return frequency, h, math.tanh(h / 2), less, more


def symmetric_modes(amplitude, period, restitution, n):
    """Both roots, the faster first; those with V > 0."""
    frequency, h, t, less, more = _half(period, restitution, n)
    beta = amplitude / (1 + frequency**2)
    square, half = (frequency * t * less) ** 2 + more**2, t * more
    discriminant = half**2 - square * (t**2 - (frequency * beta) ** 2)
    if discriminant < 0:
        return []
    e = restitution
    found = []
    for sign in (1, -1):
        speed = (half + sign * math.sqrt(discriminant)) / square
        if speed > 0:
            phase = math.atan2((t - speed * more) / frequency, -t * speed * less)
            loss = math.sinh(h) * t * (1 - e) ** 2 * (1 + frequency**2) / 2
            found.append(
                SymmetricMode(speed, phase, -2 * e * math.cosh(h) + e * (1 + e) * math.sinh(h) / speed - loss)
            )
    return found


def existence_amplitude(period, restitution, n):
    """The fold, A_E."""
    frequency, _, t, _, _ = _half(period, restitution, n)
    e = restitution
    return (1 + frequency**2) * t**2 * (1 - e) / math.sqrt((1 + e) ** 2 + (frequency * t * (1 - e)) ** 2)


def symmetry_breaking_amplitude(period, restitution, n):
    """A_SB."""
    frequency, h, t, less, more = _half(period, restitution, n)
    e, stiff = restitution, 1 + frequency**2
    speed = (
        e
        * (1 + e)
        * math.sinh(h)
        / (2 * e * math.cosh(h) - (1 + e * e) + math.sinh(h) * t * (1 - e) ** 2 * stiff / 2)
    )
    return stiff * math.sqrt((t * speed * less) ** 2 + ((t - speed * more) / frequency) ** 2)
