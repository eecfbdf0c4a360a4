"""Linear oscillator under an acceleration that is linear between samples, stepped exactly."""

from __future__ import annotations

import math

import numpy as np

SMALL = 1.0
TERMS = 24


def pseudo_acceleration(acceleration: np.ndarray, step: float, period: float, damping: float) -> float:
    """Return ω² max|u| at the samples, with u'' + 2ζω u' + ω² u = −a from rest.

    The time is s = ωt, x is ω² u, and λ = −ζ + i√(1−ζ²) is a root of the oscillator. Then q = x' − λ*x obeys q' = λq − a,
    one recursion of first order, and x = Im q / Im λ.

    Examples
    --------
    >>> round(pseudo_acceleration(np.ones(101), step=0.01, period=1.0, damping=0.0), 9)
    2.0
    """
    from scipy.signal import lfilter

    turn = 2 * math.pi * step / period
    root = complex(-damping, math.sqrt(1 - damping**2))
    growth, start, end = _exact_step(root * turn)
    a = np.concatenate(([0.0], acceleration))
    # The 0 in front stands for rest at the first sample, from which no interval leads back.
    drive = start * turn * a[:-1] + end * turn * a[1:]
    drive[0] = 0.0
    q = lfilter([1.0], [1.0, -growth], drive)
    return float(np.abs(q.imag).max()) / root.imag


def _exact_step(z: complex) -> tuple[complex, complex, complex]:
    """Return e^z, and the weights of both ends of a linear function in ∫₀¹ e^(z(1−s)) f(s) ds."""
    if abs(z) < SMALL:
        second = sum(z**k / math.factorial(k + 2) for k in range(TERMS))
        first = 1 + z * second
        return 1 + z * first, first - second, second
    growth = np.exp(z)
    first = (growth - 1) / z
    second = (first - 1) / z
    return growth, first - second, second
