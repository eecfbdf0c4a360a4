"""Pulses: base accelerations with a simple form and a finite duration."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from attrs import field, frozen

from rocking.model.arrays import read_only
from rocking.model.forcing import MAX_TIME, UNITS, BaseMotion, Forcing
from rocking.model.piecewise_linear import PiecewiseLinear
from rocking.model.validation import finite, one_of, reals, within

MAX_AMPLITUDE = 1e6
DURATIONS = (1e-6, 1e6)
RICKER_HALF = {"ricker": 1.375, "antisymmetric-ricker": 1.9}
"""Half the length of a sampled Ricker pulse, in units of its duration: beyond, it is smaller than 1e-6 of its amplitude."""
RICKER_SAMPLES = 16_385
"""Number of samples of a Ricker pulse: between them it differs from straight lines by less than 1e-6 of its amplitude."""


class Cosine(NamedTuple):
    """Form A cos(2πkx + φ), with the part x of the duration."""

    turns: float
    phase: float


SINES = {
    "half-sine": Cosine(0.5, -math.pi / 2),
    "one-sine": Cosine(1.0, -math.pi / 2),
    "one-cosine": Cosine(1.0, 0.0),
}
LINES = {
    "rectangular": (1.0, 1.0),
    "triangular": (0.0, 1.0, 0.0),
    "trapezoidal": (0.0, 1.0, 1.0, 1.0, 0.0),
}
KINDS = (*LINES, *SINES, *RICKER_HALF)


def _ricker(kind: str) -> np.ndarray:
    """Return the samples of a Ricker pulse of unit amplitude: the second or the third derivative of a Gaussian."""
    x = np.linspace(-RICKER_HALF[kind], RICKER_HALF[kind], RICKER_SAMPLES)
    if kind == "ricker":
        z = 2 * (math.pi * x) ** 2
        return (1 - z) * np.exp(-z / 2)
    z = x * (2 * math.pi / math.sqrt(3))
    top = math.sqrt(3 - math.sqrt(6))
    return (z**2 - 3) * z * np.exp(-(z**2) / 2) / ((3 - top**2) * top * math.exp(-(top**2) / 2))


_forms: dict[str, np.ndarray] = {}


def form_of(kind: str) -> np.ndarray:
    """Return the samples of a pulse of straight lines or of a Ricker pulse, for unit amplitude; always the same array."""
    if kind not in _forms:
        _forms[kind] = read_only(np.array(LINES[kind]) if kind in LINES else _ricker(kind))
    return _forms[kind]


def _kind(value: str) -> str:
    return one_of("kind", value, KINDS)


def _amplitude(value: float) -> float:
    return finite("amplitude", value, MAX_AMPLITUDE)


def _duration(value: float) -> float:
    return within("duration", value, *DURATIONS)


@frozen
class Pulse(Forcing, BaseMotion):
    """Base acceleration of a simple form that starts at τ = 0 and ends after a finite time.

    In `System` the amplitude is in units of g θcr and the duration in τ. `Block.system` takes them in m/s² and in s.

    Parameters
    ----------
    kind : str
        Form of the pulse:

        - "rectangular", "triangular"; "trapezoidal": it rises in the first quarter and falls in the last;
        - "half-sine", "one-sine", "one-cosine": half a period or one period of a sine or a cosine;
        - "ricker", "antisymmetric-ricker": second or third derivative of a Gaussian, sampled. It differs from the
          wavelet by less than 1e-6 of its amplitude.
    amplitude : float
        Largest acceleration; negative for the opposite direction.
    duration : float
        Duration, in [1e-6, 1e6]. For Ricker pulses it is their period Tp, and they last 2.75 Tp and 3.8 Tp.

    Raises
    ------
    TypeError, ValueError
        If a value is of the wrong type or lies outside its range.

    References
    ----------
    Zhang & Makris, J. Eng. Mech. 127, 473–483 (2001); Vassiliou & Makris, Bull. Seismol. Soc. Am. 101, 596–618 (2011).

    Examples
    --------
    >>> pulse = Pulse("rectangular", amplitude=1.6, duration=1.0)
    >>> pulse.acceleration([0.5, 1.5]).tolist(), pulse.largest
    ([1.6, 0.0], 1.6)
    """

    kind: str = field(converter=_kind)
    amplitude: float = field(converter=_amplitude, kw_only=True)
    duration: float = field(converter=_duration, kw_only=True)

    @property
    def cosine(self) -> Cosine | None:
        """Form of a pulse that is a piece of a cosine; None for any other."""
        return SINES.get(self.kind)

    @property
    def samples(self) -> PiecewiseLinear:
        """Pulse of straight lines, or sampled, as a base acceleration that is linear between samples.

        Raises
        ------
        ValueError
            If the pulse is a piece of a sine or cosine.
        """
        if self.cosine is not None:
            raise ValueError(f"a {self.kind} pulse has no samples: it is exact")
        form = form_of(self.kind)
        return PiecewiseLinear(form, step=self.span / (form.size - 1), scale=self.amplitude)

    @property
    def largest(self) -> float:
        """Largest |acceleration|."""
        return abs(self.amplitude)

    @property
    def span(self) -> float:
        """Time from the start of the pulse to its end."""
        return self.duration * 2 * RICKER_HALF.get(self.kind, 0.5)

    @property
    def time_scale(self) -> float:
        """Time in which the acceleration varies by the order of its size: the duration."""
        return self.duration

    @property
    def corners(self) -> np.ndarray:
        """Times (n,) at which the acceleration or its rate jumps."""
        return np.array([0.0, self.duration]) if self.cosine is not None else self.samples.corners

    def quantities(self) -> dict[str, float]:
        """Return amplitude and duration, by name."""
        return {"amplitude": self.amplitude, "pulse_duration": self.duration}

    def acceleration(self, times: Any) -> Any:
        """Return the base acceleration at given times.

        Parameters
        ----------
        times : float or array
            Time since the start of the pulse.

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
        >>> float(Pulse("half-sine", amplitude=2.0, duration=1.0).acceleration(0.5))
        2.0
        """
        if self.cosine is None:
            return self.samples.acceleration(times)
        part = np.asarray(reals("times", times, MAX_TIME)) / self.duration
        wave = np.cos(2 * math.pi * self.cosine.turns * part + self.cosine.phase)
        return (self.amplitude * np.where((part >= 0) & (part <= 1), wave, 0.0))[()]

    def displacement(self, times: Any) -> Any:
        """Return the base displacement from rest, by exact integration.

        Before the pulse the base is at rest. After it the base keeps its velocity.

        Parameters
        ----------
        times : float or array
            Time since the start of the pulse.

        Returns
        -------
        float or ndarray
            Displacement in units of amplitude times time squared, in the shape of `times`.

        Raises
        ------
        TypeError, ValueError
            If `times` holds anything but finite real numbers.

        Examples
        --------
        >>> pulse = Pulse("one-sine", amplitude=1.0, duration=2.0)
        >>> pulse.displacement([0.0, 2.0, 3.0]).round(6).tolist()  # T²/2π, and then at rest
        [0.0, 0.63662, 0.63662]
        """
        if self.cosine is None:
            return self.samples.displacement(times)
        rate, phase = 2 * math.pi * self.cosine.turns / self.duration, self.cosine.phase
        times = np.asarray(reals("times", times, MAX_TIME))
        within_it = np.clip(times, 0.0, self.duration)
        angle = rate * within_it + phase
        velocity = (np.sin(angle) - math.sin(phase)) / rate
        moved = (math.cos(phase) - np.cos(angle)) / rate**2 - within_it * math.sin(phase) / rate
        return (self.amplitude * (moved + velocity * np.maximum(times - self.duration, 0.0)))[()]

    def normalised(self, acceleration: float, frequency: float) -> Pulse:
        """Return the normalised pulse, for an amplitude in m/s² and a duration in s.

        Parameters
        ----------
        acceleration : float
            Unit of acceleration g θcr, in m/s².
        frequency : float
            Frequency parameter α of the block, in 1/s. Both lie in [1e-9, 1e9].

        Returns
        -------
        Pulse
            Pulse of the same kind.

        Raises
        ------
        TypeError, ValueError
            If a unit is not a real number or lies outside its range. Also if the result lies outside its own.

        Examples
        --------
        >>> Pulse("one-sine", amplitude=3.0, duration=0.5).normalised(acceleration=2.0, frequency=4.0)
        Pulse(kind='one-sine', amplitude=1.5, duration=2.0)
        """
        unit, rate = within("acceleration", acceleration, *UNITS), within("frequency", frequency, *UNITS)
        return Pulse(self.kind, amplitude=self.amplitude / unit, duration=self.duration * rate)
