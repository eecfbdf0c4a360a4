"""Spectral lines: selection among the peaks of a density, and their refined frequencies.

Frequencies are in units of the forcing frequency, and densities accordingly. A record is an array (cycles, samples).
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from attrs import frozen

MAX_LINES = 40
CHANCE = 1e-3
COHERENCE = 0.8
SURROUNDINGS = 24
SIDES, HANN = np.array([-1.0, 0.0, 1.0]), np.array([-0.5, 1.0, -0.5])
"""Spectrum of a Hann window: offsets in units of the resolution, and weights."""


@frozen
class Line:
    """Spectral line: frequency, amplitude of its sine, and density at its bin."""

    frequency: float
    amplitude: float
    height: float


@frozen(slots=False)
class Taper:
    """Properties of a window: main lobe, side lobes, noise bandwidth and correlation of overlapping segments."""

    weights: np.ndarray

    @cached_property
    def _coarse(self) -> np.ndarray:
        # The lobes of a window do not depend on its sampling.
        return self.weights[:: max(1, len(self.weights) // 512)]

    @cached_property
    def _lobes(self) -> tuple[int, float]:
        power = np.abs(np.fft.rfft(self._coarse, 16 * len(self._coarse))) ** 2
        # Begin below half the height, because a flat-top window is not monotone at its top.
        half = int(np.argmax(power < power[0] / 2))
        first = half + int(np.argmax(np.diff(power[half:]) > 0))
        return math.ceil(first / 16), float(power[first:].max() / power[0])

    @property
    def lobe(self) -> int:
        """Half width of the main lobe, in bins."""
        return self._lobes[0]

    @property
    def side_lobes(self) -> float:
        """Highest side lobe relative to the main lobe, as power."""
        return self._lobes[1]

    @property
    def bandwidth(self) -> float:
        """Noise bandwidth in bins: width of white noise with the power of a line of equal height."""
        return float(len(self.weights) * (self.weights**2).sum() / self.weights.sum() ** 2)

    def gain(self, bins: float) -> float:
        """Power of a line `bins` off a bin, as shown by the window, divided by the power of the window."""
        turns = np.exp(-2j * math.pi * bins * np.arange(len(self._coarse)) / len(self._coarse))
        kept = len(self._coarse) / len(self.weights)
        return float(abs((self._coarse * turns).sum()) ** 2 / (self._coarse**2).sum() / kept)

    def independent(self, count: int, step: int) -> float:
        """Equivalent number of independent segments of `count` overlapping ones (Welch 1967)."""
        total, scale = 1.0, (self.weights**2).sum()
        for shift in range(1, count):
            if shift * step >= len(self.weights):
                break
            shared = (self.weights[shift * step :] * self.weights[: -shift * step]).sum() / scale
            total += 2 * (count - shift) / count * shared**2
        return count / total


def find_lines(
    record: np.ndarray,
    density: np.ndarray,
    segment: int,
    taper: Taper,
    worth: float,
    highest: float,
    period: int | None = None,
) -> list[Line]:
    """Find the lines among the peaks of a density, the strongest first; at most 40.

    A line rises above ten times the side lobes of the strongest. The lines of a response of `period` cycles lie on known
    bins. Any other peak is a line if it meets two conditions:

    1. It exceeds the median of its 24 neighbours on both sides, beyond its main lobe. The excess is larger than that of
       noise in one of a thousand spectra of `worth` independent segments.
    2. It keeps four fifths of its height under a window over the whole record. The height of noise falls as the record gets
       longer.
    """
    floor = 10 * taper.side_lobes * density[taper.lobe :].max()
    last = min(int(highest * segment), len(density) - 2)
    if period is not None:
        step = segment // period
        peaks = np.arange(step, last + 1, step)
        peaks = peaks[density[peaks] > floor]
    else:
        peaks = _standing(density, last, taper.lobe, worth)
        peaks = peaks[density[peaks] > floor]
    return _refined_lines(record, density, peaks[np.argsort(-density[peaks], kind="stable")], segment, taper)


def _standing(density: np.ndarray, last: int, lobe: int, worth: float) -> np.ndarray:
    """Return the bins of the peaks that exceed their surroundings more than noise does."""
    from scipy.stats import chi2

    inner = density[1:-1]
    peaks = 1 + np.flatnonzero((inner > density[:-2]) & (inner >= density[2:]))
    peaks = peaks[(peaks >= lobe) & (peaks <= last)]
    noise = chi2.isf(CHANCE / last, 2 * worth) / chi2.median(2 * worth)
    return peaks[[density[k] > noise * _background(density, int(k), lobe) for k in peaks]]


def _background(density: np.ndarray, k: int, lobe: int) -> float:
    near, far = lobe + 1, lobe + 1 + SURROUNDINGS
    return float(
        np.median(np.concatenate([density[max(1, k - far) : max(1, k - near)], density[k + near : k + far]]))
    )


def _refined_lines(
    record: np.ndarray, density: np.ndarray, bins: np.ndarray, segment: int, taper: Taper
) -> list[Line]:
    cycles, samples = record.shape
    whole = np.abs(np.fft.rfft(record.ravel() * _hann(cycles * samples))) / record.size
    lines: list[Line] = []
    for k in bins:
        if len(lines) == MAX_LINES:
            break
        low, high = (math.floor((k + side) * cycles / segment) for side in (-1, 1))
        start = low + int(np.argmax(whole[low : high + 2]))
        # The Hann window shows at least 0.72 of the power of a line half a bin off.
        if whole[start] ** 2 * 2 / 0.72 * taper.gain(0.0) / samples < COHERENCE * density[k]:
            continue
        frequency, amplitude = refined(record, start / cycles)
        off = frequency * segment - k
        height = amplitude**2 / 2 * taper.gain(off) / samples
        if abs(off) > 1 or height < COHERENCE * density[k]:
            continue
        lines.append(Line(frequency, amplitude, float(density[k])))
    return lines


def refined(record: np.ndarray, start: float) -> tuple[float, float]:
    """Return the frequency near `start` with the largest Fourier integral of the record under a Hann window, and its amplitude.

    This is the first step of the frequency analysis of Laskar (1990, Icarus 88, 266; 1993, Physica D 67, 257). In the presence
    of other lines at a distance of k resolutions, the error falls as 1/k³ of a resolution. A single line is accurate to
    rounding.
    """
    near = Near.of(record, start)
    bin_width = 1 / len(record)
    offset = 0.0
    for share in (0.5, 0.25, 0.05, 0.05):
        step = share * bin_width
        sizes = np.abs(near.windowed(offset + step * SIDES))
        below, here, above = 2 * np.log(np.maximum(sizes, 1e-300))
        bend = below - 2 * here + above
        if bend < 0:
            offset += min(max(step * (below - above) / (2 * bend), -bin_width), bin_width)
    return float(start + offset), float(2 * np.abs(near.windowed(np.array(offset))))


@frozen
class Near:
    """Fourier integrals of a record at frequencies within a few resolutions of a given one, at the cost of one.

    Over one cycle, the phase changes so little with such a difference of frequencies that a few terms of the exponential
    series suffice. These terms are summed over each cycle once.
    """

    frequency: float
    sums: np.ndarray

    @classmethod
    def of(cls, record: np.ndarray, frequency: float) -> Near:
        """Return the sums of a record of at least 64 cycles; the series is accurate to rounding up to three resolutions."""
        cycles, samples = record.shape
        terms = 10 if cycles < 1000 else 6
        inside = np.arange(samples) / samples
        turns = np.exp(-2j * math.pi * frequency * inside)[:, None] * (inside[:, None] - 0.5) ** np.arange(
            terms
        )
        # not @: for arrays this small, the threads of a matrix library cost more time than they save
        sums = np.einsum("cs,sk->ck", record, turns.real) + 1j * np.einsum("cs,sk->ck", record, turns.imag)
        return cls(frequency, sums / record.size)

    def windowed(self, offsets: np.ndarray) -> np.ndarray:
        """Return (1/L) ∫ x (1 − cos(2πt/L)) e^{−2πiνt} dt over the whole record, at each of the offsets."""
        return self.plain(offsets[..., None] + SIDES / len(self.sums)) @ HANN

    def plain(self, offsets: np.ndarray) -> np.ndarray:
        """Return (1/L) ∫ x e^{−2πiνt} dt at each of the offsets."""
        cycles, terms = self.sums.shape
        offset = offsets[..., None]
        ratios = -2j * math.pi * offset / np.arange(1, terms)
        series = np.cumprod(np.concatenate([np.ones_like(offset), ratios], axis=-1), axis=-1)
        turns = np.mod((self.frequency + offset) * np.arange(cycles), 1.0) + offset / 2
        return (np.exp(-2j * math.pi * turns) * np.einsum("...k,ck->...c", series, self.sums)).sum(axis=-1)


def _hann(count: int) -> np.ndarray:
    return 1 - np.cos(2 * math.pi * np.arange(count) / count)
