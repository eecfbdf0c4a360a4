"""The shaking of the base, normalised: Yim & Lin 1991, eq. (3)."""

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


def _amplitude(value: float) -> float:
    return within("amplitude", value, 0, MAX_AMPLITUDE, if_below="for the opposite direction add π to phase")


def _period(value: float | None) -> float | None:
    return None if value is None else within("period", value, *PERIODS)


def _frequency(value: float | None) -> float | None:
    return None if value is None else within("frequency", value, *FREQUENCIES)


def _phase(value: float) -> float:
    return within("phase", value, -MAX_PHASE, MAX_PHASE)


@frozen(repr=False)
class Harmonic:
    """Harmonic acceleration of the base, A cos(Ωτ + φ): Yim & Lin 1991, eq. (3), normalised.

    Parameters
    ----------
    amplitude : float
        A = a_x/(g θcr), the base's largest acceleration over the one that just lifts the block; in [0, 1000].
    period : float, optional
        T = 2π/Ω in normalised time τ. Give exactly one of `period` and `frequency`.
    frequency : float, optional
        Ω = ω/α in radians per τ, in [0.001, 1000].
    phase : float
        φ in radians, in [-1000, 1000].

    Raises
    ------
    TypeError, ValueError
        In one line, for a value that is no real number or lies outside its range, and for both or neither of
        `period` and `frequency`.

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
        """T = 2π/Ω, in τ."""
        return math.tau / self._frequency if self._period is None else self._period  # type: ignore[operator]

    @property
    def frequency(self) -> float:
        """Ω = 2π/T, in radians per τ."""
        return math.tau / self._period if self._frequency is None else self._frequency  # type: ignore[operator]

    def acceleration(self, times: Any) -> Any:
        """A cos(Ωτ + φ) at normalised `times`, in units of g θcr, in their shape: eq. (3)."""
        return self.amplitude * np.cos(self.frequency * reals("times", times) + self.phase)

    def __repr__(self) -> str:
        given = f"period={self._period}" if self._frequency is None else f"frequency={self._frequency}"
        return f"Harmonic(amplitude={self.amplitude}, {given}, phase={self.phase})"
