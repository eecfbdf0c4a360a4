"""Base acceleration that is linear between equidistant samples."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from attrs import field, frozen

from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.forcing import MAX_TIME, Forcing
from rocking.model.validation import finite, reals, refusal, within

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
    found = np.atleast_1d(reals(name, values))
    if isinstance(values, np.ndarray) and values.dtype == float and not values.flags.writeable:
        found = values
    if found.ndim != 1 or not 1 <= found.size <= MAX_SAMPLES:
        raise ValueError(refusal(name, f"be 1 to {MAX_SAMPLES:,} numbers in a row", values))
    wrong = ~(np.abs(found) <= largest)
    if wrong.any():
        first = int(np.argmax(wrong))
        allowed = f"be finite and of size up to {largest:g}, unlike sample {first}"
        raise ValueError(refusal(name, allowed, float(found[first])))
    return read_only(np.ascontiguousarray(found))


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
        found = np.interp(places, np.arange(self.values.size), self.values, left=0.0, right=0.0)
        return (self.scale * found)[()]

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
