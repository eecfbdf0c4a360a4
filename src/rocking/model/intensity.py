"""Formulas of the intensity of a motion that is linear between equidistant samples: oscillators, integrals and durations.

They take samples and a step. Methods of `GroundMotion` check the arguments.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from rocking.model.block_formulas import GRAVITY

PERIODS = (1e-4, 1e4)
"""Range of the natural periods of oscillators, s."""
MAX_DAMPING = 0.99
DAMPING = 0.05
"""Damping ratio of response spectra, unless another one is given."""
SIGNIFICANT = (0.05, 0.95)
"""Shares of the Arias intensity at the ends of the significant duration."""
BRACKET = 0.05 * GRAVITY
"""Usual threshold of the bracketed duration, m/s²."""
AZIMUTHS = np.radians(np.arange(180.0))
"""Directions of rotated components: 0 … 179°, in rad."""
PER_PERIOD, MOST_PARTS = 20, 64
"""Least number of times in a period of an oscillator, but for short periods: largest number of parts of a step."""

SMALL = 1.0
TERMS = 24


def exact_step(z: complex) -> tuple[complex, complex, complex]:
    """Return e^z, and the weights of both ends of a linear function in ∫₀¹ e^(z(1−s)) f(s) ds.

    Examples
    --------
    >>> exact_step(0.0)
    (1.0, 0.5, 0.5)
    """
    if abs(z) < SMALL:
        second = sum(z**k / math.factorial(k + 2) for k in range(TERMS))
        first = 1 + z * second
        return 1 + z * first, first - second, second
    growth = np.exp(z)
    first = (growth - 1) / z
    second = (first - 1) / z
    return growth, first - second, second


class Oscillation(NamedTuple):
    """Displacement of an oscillator at equidistant times, times ω², and its derivative times the step."""

    place: np.ndarray
    rate: np.ndarray

    def turned(self, other: Oscillation, angle: float) -> Oscillation:
        """Return the component of the displacement in a direction, if this one and another are those in x and y."""
        x, y = math.cos(angle), math.sin(angle)
        return Oscillation(x * self.place + y * other.place, x * self.rate + y * other.rate)

    @property
    def peak(self) -> float:
        """Largest |place|, also between the times, where the cubic of Hermite takes its place.

        Examples
        --------
        >>> Oscillation(np.array([0.0, 0.0]), np.array([1.0, -1.0])).peak
        0.25
        """
        place, rate = self
        turns = np.flatnonzero(rate[:-1] * rate[1:] < 0.0)
        start, first, second = place[turns], rate[turns], rate[turns + 1]
        rise = place[turns + 1] - start
        square, cube = 3.0 * rise - 2.0 * first - second, first + second - 2.0 * rise
        # The derivative, first + 2 square s + 3 cube s², has one zero in [0, 1]: it changes its sign once. If the rise is lost in
        # rounding, another s in [0, 1] does no harm.
        root = np.sqrt(np.maximum(square**2 - 3.0 * cube * first, 0.0))
        with np.errstate(divide="ignore"):
            s = np.clip(first / (np.copysign(root, first) - square), 0.0, 1.0)
        between = start + s * (first + s * (square + s * cube))
        return float(max(np.abs(place).max(), np.abs(between).max(initial=0.0)))


def oscillation(acceleration: np.ndarray, step: float, period: float, damping: float) -> Oscillation:
    """Return ω² u of the oscillator u'' + 2ζω u' + ω² u = −a from rest, at `PER_PERIOD` times in a period or more.

    The times divide each step, in `MOST_PARTS` at most.

    Examples
    --------
    >>> oscillation(np.ones(3), step=0.25, period=1.0, damping=0.0).place[[0, 5, 10]].round(9).tolist()
    [0.0, -1.0, -2.0]
    """
    a, parts = acceleration, min(math.ceil(PER_PERIOD * step / period), MOST_PARTS)
    if parts > 1:
        a = np.interp(np.arange(parts * (a.size - 1) + 1) / parts, np.arange(a.size), a)
    q, root = _oscillator(a, step / parts, period, damping)
    place = q.imag / root.imag
    return Oscillation(place, 2 * math.pi * step / (period * parts) * (q.real - damping * place))


def floor_acceleration(
    acceleration: np.ndarray, step: float, period: float, damping: float, more: int = 0
) -> np.ndarray:
    """Return −(ω² u + 2ζω u'), the absolute acceleration of the oscillator, at the samples and at `more` after them.

    Examples
    --------
    >>> floor_acceleration(np.ones(3), step=0.25, period=1.0, damping=0.0, more=1).round(9).tolist()
    [0.0, 1.0, 2.0, -0.0]
    """
    q, root = _oscillator(
        np.concatenate((acceleration, np.zeros(more))), step, period, damping, acceleration.size
    )
    x = q.imag / root.imag
    return np.asarray(-(1 - 2 * damping**2) * x - 2 * damping * q.real)


def _oscillator(
    acceleration: np.ndarray, step: float, period: float, damping: float, end: int | None = None
) -> tuple[np.ndarray, complex]:
    """Return q = x' − λ*x at the samples, and λ. The acceleration drops to 0 behind the first `end` samples.

    The time is s = ωt, x is ω² u, and λ = −ζ + i√(1−ζ²) is a root of the oscillator. Then q obeys q' = λq − a, one recursion of
    first order, and x = Im q / Im λ, x' = Re q − ζx.
    """
    from scipy.signal import lfilter

    turn = 2 * math.pi * step / period
    root = complex(-damping, math.sqrt(1 - damping**2))
    growth, start, finish = exact_step(root * turn)
    a = np.concatenate(([0.0], acceleration))
    drive = -turn * (start * a[:-1] + finish * a[1:])
    # The 0 in front stands for rest at the first sample, from which no interval leads back.
    drive[0] = 0.0
    if end is not None:
        drive[end:] = 0.0
    return lfilter([1.0], [1.0, -growth], drive), root


def pseudo_acceleration(acceleration: np.ndarray, step: float, period: float, damping: float) -> float:
    """Return ω² max|u| during the motion.

    Examples
    --------
    >>> round(pseudo_acceleration(np.ones(101), step=0.01, period=1.0, damping=0.0), 9)
    2.0
    """
    return oscillation(acceleration, step, period, damping).peak


def rotated_peaks(first: Oscillation, second: Oscillation) -> np.ndarray:
    """Return the largest |x cos φ + y sin φ| of two components for φ = 0 … 179°, shape (180,).

    Examples
    --------
    >>> still = np.zeros(1)
    >>> rotated_peaks(Oscillation(np.array([3.0]), still), Oscillation(np.array([4.0]), still))[[0, 90]].tolist()
    [3.0, 4.0]
    """
    return np.array([first.turned(second, angle).peak for angle in AZIMUTHS.tolist()])


def cumulative_square(a: np.ndarray, step: float) -> np.ndarray:
    """Return ∫a² dt from the first sample to each, exact for straight segments."""
    parts = (a[:-1] ** 2 + a[:-1] * a[1:] + a[1:] ** 2) * (step / 3)
    return np.concatenate(([0.0], np.cumsum(parts)))


def absolute_integral(a: np.ndarray, step: float) -> float:
    """Return ∫|a| dt, exact for straight segments.

    Examples
    --------
    >>> absolute_integral(np.array([1.0, -1.0, -1.0]), step=1.0)
    1.5
    """
    first, second = np.abs(a[:-1]), np.abs(a[1:])
    total = first + second
    squares = np.divide(first**2 + second**2, total, out=np.zeros_like(total), where=total > 0.0)
    return float(np.where(a[:-1] * a[1:] < 0.0, squares, total).sum() * (step / 2))


def bracketed_duration(a: np.ndarray, step: float, threshold: float) -> float:
    """Return the time between the first and the last |a| of at least a threshold, linear between samples; 0 if there is none.

    Examples
    --------
    >>> bracketed_duration(np.array([0.0, 2.0, 0.0, -2.0, 0.0]), step=1.0, threshold=1.0)
    3.0
    """
    strong = np.flatnonzero(np.abs(a) >= threshold)
    if not strong.size:
        return 0.0

    def crossing(inside: int, outside: int) -> float:
        """Return how far from the sample inside, towards the one outside, |a| is the threshold."""
        if not 0 <= outside < a.size:
            return 0.0
        limit = math.copysign(threshold, a[inside])
        return float((a[inside] - limit) / (a[inside] - a[outside]))

    first, last = int(strong[0]), int(strong[-1])
    return step * (last - first + crossing(first, first - 1) + crossing(last, last + 1))
