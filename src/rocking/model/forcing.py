"""Base acceleration, normalised: Yim & Lin (1991), Eq. (3)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from attrs import field, frozen

from rocking.model.validation import exactly_one, reals, within

MAX_AMPLITUDE = 1e3
FREQUENCIES = (1e-3, 1e3)
PERIODS = (math.tau / FREQUENCIES[1], math.tau / FREQUENCIES[0])
MAX_PHASE = 1e3
MAX_TIME = 1e100
UNITS = (1e-9, 1e9)
"""Range of the units of acceleration in m/s² and of frequency in 1/s."""


def _amplitude(value: float) -> float:
    return within("amplitude", value, 0, MAX_AMPLITUDE, if_below="for the opposite direction add π to phase")


def _period(value: float | None) -> float | None:
    return None if value is None else within("period", value, *PERIODS)


def _frequency(value: float | None) -> float | None:
    return None if value is None else within("frequency", value, *FREQUENCIES)


def _phase(value: float) -> float:
    return within("phase", value, -MAX_PHASE, MAX_PHASE)


class Forcing:
    """Base acceleration of a system: base class of `Harmonic`, `PiecewiseLinear` and `Pulse`."""

    __slots__ = ()

    @property
    def largest(self) -> float:
        """Largest |acceleration|, in units of g θcr. A block at rest lifts off if it exceeds 1."""
        raise NotImplementedError

    @property
    def span(self) -> float:
        """Time τ in which the acceleration takes all its values."""
        raise NotImplementedError

    @property
    def time_scale(self) -> float:
        """Time τ in which the acceleration varies by the order of its size."""
        raise NotImplementedError

    @property
    def corners(self) -> np.ndarray:
        """Times τ (n,) at which the acceleration or its rate jumps."""
        return np.empty(0)

    def acceleration(self, times: Any) -> Any:
        """Return the base acceleration at normalised times, in units of g θcr."""
        raise NotImplementedError

    def quantities(self) -> dict[str, float]:
        """Return the numbers that describe it, by name."""
        raise NotImplementedError


class BaseMotion:
    """Base acceleration in SI units, which `Block.system` takes: base class of `GroundMotion` and `Pulse`."""

    __slots__ = ()

    def normalised(self, acceleration: float, frequency: float) -> Forcing:
        """Return the normalised base acceleration, from the units g θcr in m/s² and α in 1/s."""
        raise NotImplementedError


@frozen(repr=False)
class Harmonic(Forcing):
    """Harmonic base acceleration A cos(Ωτ + φ), normalised: Yim & Lin (1991), Eq. (3).

    Parameters
    ----------
    amplitude : float
        Normalised amplitude A = a_x/(g θcr), in [0, 1000]. A block at rest lifts off if A > 1.
    period : float, optional
        Forcing period T = 2π/Ω, in units of 1/α, in [2π/1000, 2000π]. Give exactly one of `period` and `frequency`.
    frequency : float, optional
        Angular frequency Ω = ω/α, in radians per τ, in [0.001, 1000].
    phase : float
        Phase φ in radians, in [-1000, 1000]. Default: 0.

    Raises
    ------
    TypeError
        If a value is not a real number, or if not exactly one of `period` and `frequency` is given.
    ValueError
        If a value lies outside its range.

    Examples
    --------
    >>> forcing = Harmonic(amplitude=2.0, period=1.0)
    >>> forcing
    Harmonic(amplitude=2.0, period=1.0, phase=0.0)
    >>> round(forcing.frequency, 6)
    6.283185
    """

    amplitude: float = field(converter=_amplitude)
    _period: float | None = field(default=None, kw_only=True, converter=_period)
    _frequency: float | None = field(default=None, kw_only=True, converter=_frequency)
    phase: float = field(default=0.0, kw_only=True, converter=_phase)

    def __attrs_post_init__(self) -> None:
        exactly_one(period=self._period, frequency=self._frequency)

    @property
    def period(self) -> float:
        """Forcing period T = 2π/Ω, in units of 1/α."""
        return math.tau / self._frequency if self._period is None else self._period  # type: ignore[operator]

    @property
    def frequency(self) -> float:
        """Angular frequency Ω = 2π/T, in radians per τ."""
        return math.tau / self._period if self._frequency is None else self._frequency  # type: ignore[operator]

    @property
    def given(self) -> tuple[str, float]:
        """Name and value of the one of `period` and `frequency` that was given; the other is rounded."""
        if self._frequency is None:
            assert self._period is not None
            return "period", self._period
        return "frequency", self._frequency

    @property
    def largest(self) -> float:
        """Largest |acceleration|, A."""
        return self.amplitude

    @property
    def span(self) -> float:
        """Time τ in which the acceleration takes all its values: the period."""
        return self.period

    @property
    def time_scale(self) -> float:
        """Time τ in which the acceleration varies by the order of its size: the period."""
        return self.period

    def quantities(self) -> dict[str, float]:
        """Return amplitude, period, frequency and phase, by name."""
        return {
            "amplitude": self.amplitude,
            "period": self.period,
            "frequency": self.frequency,
            "phase": self.phase,
        }

    def acceleration(self, times: Any) -> Any:
        """Return the base acceleration A cos(Ωτ + φ), in units of g θcr: Eq. (3).

        Parameters
        ----------
        times : float or array
            Normalised time τ.

        Returns
        -------
        float or ndarray
            Acceleration, in the shape of `times`.

        Raises
        ------
        TypeError, ValueError
            If `times` holds anything but finite real numbers.

        Examples
        --------
        >>> Harmonic(amplitude=2.0, period=1.0).acceleration([0.0, 0.5]).tolist()
        [2.0, -2.0]
        """
        return self.amplitude * np.cos(self.frequency * reals("times", times, MAX_TIME) + self.phase)

    def __repr__(self) -> str:
        given = f"period={self._period}" if self._frequency is None else f"frequency={self._frequency}"
        return f"Harmonic(amplitude={self.amplitude}, {given}, phase={self.phase})"
