"""Base acceleration, normalised: harmonic, Yim & Lin (1991), Eq. (3); linear between samples; pulses of finite duration."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import attrs
import numpy as np
from attrs import field, frozen

from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.quantity import AMPLITUDE, FREQUENCY, PERIOD, PHASE
from rocking.model.validation import Refusal, exactly_one, finite, one_of, reals, within

MAX_TIME = 1e100
UNITS = (1e-9, 1e9)
"""Range of the units of acceleration in m/s² and of frequency in 1/s."""


def _amplitude(value: float) -> float:
    return AMPLITUDE.checked(value, if_below="for the opposite direction add π to {phase}")


def _period(value: float | None) -> float | None:
    return None if value is None else PERIOD.checked(value)


def _frequency(value: float | None) -> float | None:
    return None if value is None else FREQUENCY.checked(value)


def _phase(value: float) -> float:
    return PHASE.checked(value)


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
        values = f"period={self._period}" if self._frequency is None else f"frequency={self._frequency}"
        return f"Harmonic(amplitude={self.amplitude}, {values}, phase={self.phase})"


STEPS = (1e-9, 1e6)
MAX_SAMPLES = 10_000_000
MAX_ACCELERATION = 1e9
STEPS_OF_CHANGE = 16


def velocity_and_displacement(acceleration: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Integrate an acceleration that is linear between samples (n,) from rest; return both integrals at the samples."""
    first, second = acceleration[:-1], acceleration[1:]
    velocity = np.concatenate(([0.0], np.cumsum((second + first) * (step / 2))))
    moved = velocity[:-1] * step + (2 * first + second) * (step**2 / 6)
    return velocity, np.concatenate(([0.0], np.cumsum(moved)))


def samples(name: str, values: Any, largest: float) -> np.ndarray:
    """Return samples (n,), n >= 1, as a read-only array of finite floats; one that is read-only already is not copied.

    Raises
    ------
    TypeError
        If `values` holds anything but real numbers.
    ValueError
        If there are no samples or too many, or if one is not finite or too large.
    """
    numbers = np.atleast_1d(reals(name, values))
    if isinstance(values, np.ndarray) and values.dtype == float and not values.flags.writeable:
        numbers = values
    if numbers.ndim != 1 or not 1 <= numbers.size <= MAX_SAMPLES:
        raise Refusal(name, f"be 1 to {MAX_SAMPLES:,} numbers in a row", values)
    wrong = ~(np.abs(numbers) <= largest)
    if wrong.any():
        first = int(np.argmax(wrong))
        allowed = f"be finite and of size up to {largest:g}, unlike sample {first}"
        raise Refusal(name, allowed, float(numbers[first]))
    return read_only(np.ascontiguousarray(numbers))


def _values(values: Any) -> np.ndarray:
    return samples("values", values, MAX_ACCELERATION)


def _step(value: float) -> float:
    return within("step", value, *STEPS)


def _scale(value: float) -> float:
    return finite("scale", value, MAX_ACCELERATION)


@frozen(repr=False)
class PiecewiseLinear(Forcing, ReadOnlyArrays):
    """Normalised base acceleration that is linear between samples, and 0 before the first and after the last.

    Parameters
    ----------
    values : array_like of float, shape (n,)
        Samples in units of g θcr, n in [1, 10⁷]. The first is that at τ = 0. A first or last sample that is not 0 is a jump.
    step : float
        Time between two samples in τ, in [1e-9, 1e6].
    scale : float
        Factor of all samples; a negative one reverses the base motion. Default: 1.

    Raises
    ------
    TypeError
        If a value is not a real number.
    ValueError
        If a value lies outside its range.

    Examples
    --------
    >>> base = PiecewiseLinear([0.0, 2.0, -1.0], step=0.1)
    >>> base
    PiecewiseLinear(3 samples, step=0.1, scale=1.0)
    >>> base.acceleration([-0.05, 0.05, 0.1, 0.3]).tolist(), base.duration
    ([0.0, 1.0, 2.0, 0.0], 0.2)
    """

    values: np.ndarray = field(converter=_values, eq=attrs.cmp_using(eq=np.array_equal), hash=False)
    step: float = field(converter=_step, kw_only=True)
    scale: float = field(default=1.0, converter=_scale, kw_only=True)

    @property
    def duration(self) -> float:
        """Time τ of the last sample."""
        return (self.values.size - 1) * self.step

    @property
    def span(self) -> float:
        """Time τ in which the acceleration takes all its values: at least one step."""
        return max(self.duration, self.step)

    @property
    def time_scale(self) -> float:
        """Time τ in which the acceleration varies by the order of its size: some steps."""
        return min(STEPS_OF_CHANGE * self.step, self.span)

    @property
    def largest(self) -> float:
        """Largest |acceleration|, in units of g θcr. A block at rest lifts off if it exceeds 1."""
        return float(np.abs(self.values).max()) * abs(self.scale)

    @property
    def corners(self) -> np.ndarray:
        """Times τ (n,) of the samples, at which the rate of the acceleration jumps."""
        return np.arange(self.values.size) * self.step

    def quantities(self) -> dict[str, float]:
        """Return the number of samples, step and scale, by name."""
        return {"samples": self.values.size, "step": self.step, "scale": self.scale}

    def acceleration(self, times: Any) -> Any:
        """Return the base acceleration, in units of g θcr.

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
        >>> float(PiecewiseLinear([0.0, 2.0], step=1.0, scale=-1.0).acceleration(0.5))
        -1.0
        """
        places = np.asarray(reals("times", times, MAX_TIME)) / self.step
        values = np.interp(places, np.arange(self.values.size), self.values, left=0.0, right=0.0)
        return (self.scale * values)[()]

    def displacement(self, times: Any) -> Any:
        """Return the base displacement from rest, by exact integration of the straight segments.

        Before the first sample the base is at rest. After the last it keeps its velocity.

        Parameters
        ----------
        times : float or array
            Normalised time τ.

        Returns
        -------
        float or ndarray
            Displacement in units of g θcr/α², in the shape of `times`.

        Raises
        ------
        TypeError, ValueError
            If `times` holds anything but finite real numbers.

        Examples
        --------
        >>> base = PiecewiseLinear([1.0, 1.0], step=2.0)  # τ²/2, and then at constant velocity
        >>> base.displacement([0.0, 1.0, 2.0, 3.0]).tolist()
        [0.0, 0.5, 2.0, 4.0]
        """
        times = np.asarray(reals("times", times, MAX_TIME))
        a, h = self.scale * self.values, self.step
        velocity, place = velocity_and_displacement(a, h)
        # after the last sample the acceleration is 0
        first, slope = np.append(a[:-1], 0.0), np.append(np.diff(a) / h, 0.0)
        k = np.clip(times / h, 0, a.size - 1).astype(int)
        s = np.maximum(times - k * h, 0.0)
        return (place[k] + s * (velocity[k] + s * (first[k] / 2 + s * slope[k] / 6)))[()]

    def __repr__(self) -> str:
        return f"PiecewiseLinear({self.values.size} samples, step={self.step}, scale={self.scale})"


MAX_PULSE_AMPLITUDE = 1e6
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


def _pulse_amplitude(value: float) -> float:
    return finite("amplitude", value, MAX_PULSE_AMPLITUDE)


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
    amplitude: float = field(converter=_pulse_amplitude, kw_only=True)
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
