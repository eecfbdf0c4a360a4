"""Synthetic ground motions: filtered white noise times an envelope.

Only integers and the four basic operations are used, in a fixed order. So the samples of a seed are the same on every machine.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rocking.model.ground_motion import GroundMotion
from rocking.model.validation import Refusal, whole, within

MAX_MOTIONS = 10_000
MAX_VALUES = 20_000_000
UNIFORMS = 12
"""Uniform numbers in a sum that is normal to a good approximation, with standard deviation 1."""
BITS = 32


class Envelope(NamedTuple):
    """Factor in time: quadratic to 1 at `rise`, 1 until `strong`, then an exponential decay at the rate `decay`."""

    rise: float
    strong: float
    decay: float

    def values(self, times: np.ndarray, step: float) -> np.ndarray:
        """Return the factor at equidistant times."""
        ratio = (1 - self.decay * step / 2) / (1 + self.decay * step / 2)
        result = np.where(times < self.rise, (times / self.rise) * (times / self.rise), 1.0)
        factor = 1.0
        for k in np.flatnonzero(times > self.strong):
            factor *= ratio
            result[k] = factor
        return result


def synthetic_ground_motions(
    count: int,
    *,
    seed: int,
    duration: float = 20.0,
    step: float = 0.01,
    pga: float = 3.0,
    soil_frequency: float = 15.0,
    soil_damping: float = 0.6,
    filter_frequency: float = 1.5,
    filter_damping: float = 0.6,
    rise: float = 2.0,
    strong: float = 10.0,
    decay: float = 0.3,
) -> tuple[GroundMotion, ...]:
    """Return ground motions of white noise through the filters of Clough and Penzien, times an envelope.

    The first filter is the soil of Kanai and Tajimi, the second a high-pass. The bilinear rule discretises both.
    Motion k of a seed does not depend on `count`, and its samples are the same on every machine.

    Parameters
    ----------
    count : int
        Number of motions, in [1, 10⁴]; at most 2·10⁷ samples in all.
    seed : int
        Seed of the random numbers, in [0, 2⁶³).
    duration : float
        Time of the last sample, in s. Default: 20.
    step : float
        Time step in s. Default: 0.01.
    pga : float
        Peak ground acceleration of each motion, in m/s². Default: 3.
    soil_frequency, soil_damping : float
        Natural frequency in rad/s and damping ratio of the soil. Default: 15 and 0.6, firm ground.
    filter_frequency, filter_damping : float
        Those of the high-pass. Default: 1.5 rad/s and 0.6.
    rise, strong : float
        End of the rise and of the strong phase, in s. Default: 2 and 10.
    decay : float
        Rate of the decay afterwards, in 1/s. Default: 0.3.

    Returns
    -------
    tuple of GroundMotion
        Motions with the names "synthetic 1", "synthetic 2", …

    Raises
    ------
    TypeError, ValueError
        If a value is of the wrong type or lies outside its range.

    See Also
    --------
    read_ground_motion : A recorded motion.
    example_ground_motion : The recorded motion that comes with the package.

    References
    ----------
    Clough & Penzien, Dynamics of Structures, McGraw-Hill (1975). Form of the envelope: Jennings, Housner & Tsai, Simulated
    earthquake motions, California Institute of Technology (1968). The default times of the envelope are chosen for short runs.

    Examples
    --------
    >>> one, two = synthetic_ground_motions(2, seed=1)
    >>> one
    GroundMotion(synthetic 1, 2001 samples, step 0.01 s, PGA 3 m/s²)
    >>> one == synthetic_ground_motions(1, seed=1)[0], one == two
    (True, False)
    """
    count, seed = whole("count", count, 1, MAX_MOTIONS), whole("seed", seed, 0, 2**63 - 1)
    duration, step = within("duration", duration, 0.1, 1e5, "s"), within("step", step, 1e-4, 0.1, "s")
    pga = within("pga", pga, 1e-6, 1e3, "m/s²")
    samples = int(duration / step + 0.5) + 1
    if count * samples > MAX_VALUES:
        raise Refusal("count", f"be at most {MAX_VALUES // samples}, of {samples:,} samples each", count)
    nyquist = 1 / step
    soil = (
        within("soil_frequency", soil_frequency, 1e-3, nyquist, "rad/s"),
        within("soil_damping", soil_damping, 1e-3, 10),
    )
    high = (
        within("filter_frequency", filter_frequency, 1e-3, nyquist, "rad/s"),
        within("filter_damping", filter_damping, 1e-3, 10),
    )
    rise = within("rise", rise, step, duration, "s")
    envelope = Envelope(
        rise, within("strong", strong, rise, 1e5, "s"), within("decay", decay, 0, 1 / step, "1/s")
    )
    result = _high_pass(_soil(_noise(count, seed, samples), step, *soil), step, *high)
    result *= envelope.values(step * np.arange(samples), step)[:, None]
    result *= pga / np.abs(result).max(axis=0)
    return tuple(
        GroundMotion(np.ascontiguousarray(column), step=step, name=f"synthetic {number}")
        for number, column in enumerate(result.T, 1)
    )


def _noise(count: int, seed: int, samples: int) -> np.ndarray:
    """Return nearly normal numbers, shape (samples, count), exact sums of integers from a generator per motion."""
    result = np.empty((samples, count))
    for number, own in enumerate(np.random.SeedSequence(seed).spawn(count)):
        generator = np.random.Generator(np.random.PCG64(own))
        total = np.zeros(samples, dtype=np.int64)
        for _ in range(UNIFORMS):
            total += generator.integers(0, 2**BITS, size=samples, dtype=np.int64)
        result[:, number] = (total - UNIFORMS * 2 ** (BITS - 1)) / 2.0**BITS
    return result


def _soil(noise: np.ndarray, step: float, frequency: float, damping: float) -> np.ndarray:
    """Return the filter (2ζω s + ω²) / (s² + 2ζω s + ω²) of noise."""
    return _bilinear(noise, step, (0.0, 2 * damping * frequency, frequency * frequency), frequency, damping)


def _high_pass(motion: np.ndarray, step: float, frequency: float, damping: float) -> np.ndarray:
    """Return the filter s² / (s² + 2ζω s + ω²) of a motion."""
    return _bilinear(motion, step, (1.0, 0.0, 0.0), frequency, damping)


def _bilinear(
    values: np.ndarray, step: float, numerator: tuple[float, float, float], frequency: float, damping: float
) -> np.ndarray:
    """Filter columns by a ratio of polynomials in s, with s = 2 (1 − 1/z) / (step (1 + 1/z)), from rest."""
    rate = 2 / step
    b, a = (
        (c2 * rate * rate + c1 * rate + c0, 2 * (c0 - c2 * rate * rate), c2 * rate * rate - c1 * rate + c0)
        for c2, c1, c0 in (numerator, (1.0, 2 * damping * frequency, frequency * frequency))
    )
    result = np.empty_like(values)
    first = second = np.zeros(values.shape[1])
    for k, row in enumerate(values):
        result[k] = (b[0] * row + first) / a[0]
        first = b[1] * row - a[1] * result[k] + second
        second = b[2] * row - a[2] * result[k]
    return result
