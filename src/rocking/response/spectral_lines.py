"""Spectral lines: selection among the peaks of a density, refined frequencies, and names: Yim & Lin (1991), Eq. (7)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property

import numpy as np
from attrs import frozen

MAX_ROTATIONS = 32
CHANCE_OF_A_NAME = 0.1
MAX_SUBHARMONIC = 16
TELLING_LINES = 10


@frozen
class Combination:
    """Combination p·f + q·f_r, with p a multiple of 1/n and q an integer, and the distance of a line from it."""

    forcing: Fraction
    rotation: int
    offset: float

    @property
    def name(self) -> str:
        """Text such as "5f/3 − 2f_r"."""
        terms = [(self.forcing, "f"), (Fraction(self.rotation), "f_r")]
        text = ""
        for factor, symbol in terms:
            if factor:
                sign = "−" if factor < 0 else "+"
                text += f" {sign} " if text else sign.replace("+", "")
                text += _multiple(abs(factor), symbol)
        return text or "0"


def _multiple(factor: Fraction, symbol: str) -> str:
    over = f"/{factor.denominator}" if factor.denominator > 1 else ""
    return f"{factor.numerator if factor.numerator > 1 else ''}{symbol}{over}"


def combination(line: float, parts: int, rotation: float | None, resolution: float) -> Combination | None:
    """Return the simplest combination within the resolution of a line; None if there is none or it is ambiguous.

    Multiples of 1/`parts` are combined with integer multiples q of the rotation frequency. The simplest combination has the
    smallest |q|. It is ambiguous if another one has at most 2|q| + 1. The largest |q| is 32, or fewer if the combinations
    would cover more than a tenth of all frequencies: more combinations would fit any line.
    """
    most = min(MAX_ROTATIONS, int((CHANCE_OF_A_NAME / (2 * resolution * parts) - 1) / 2)) if rotation else 0
    result = None
    for turns in sorted(range(-most, most + 1), key=abs):
        if result is not None and abs(turns) > 2 * abs(result.rotation) + 1:
            break
        remainder = line - turns * (rotation or 0.0)
        nearest = Fraction(round(remainder * parts), parts)
        if abs(remainder - float(nearest)) > resolution:
            continue
        if result is not None:
            return None
        result = Combination(nearest, turns, remainder - float(nearest))
    return result


def parts_and_rotation(
    lines: Sequence[float], parts: int | None, rotation: float | None, resolution: float
) -> tuple[int, float | None]:
    """Return the n of f/n and the rotation frequency that name the most of the ten strongest lines.

    Parameters
    ----------
    lines : sequence of float
        Frequencies, the strongest first.
    parts : int or None
        Given n. None: the smallest n up to 16 that names the most lines.
    rotation : float or None
        Given rotation frequency. None: the strongest line that is no multiple of f/n, if it names another line too.
    resolution : float
        Largest distance of a line from its combination.

    Returns
    -------
    parts : int
        n.
    rotation : float or None
        Rotation frequency; None if there is none.
    """
    telling = lines[:TELLING_LINES]
    best: tuple[int, int, float | None] = (-1, parts or 1, rotation)
    for n in [parts] if parts else range(1, MAX_SUBHARMONIC + 1):
        free = rotation or _free(telling, n, resolution)
        named = [combination(line, n, free, resolution) for line in telling]
        if not rotation and sum(one is not None and one.rotation != 0 for one in named) < 2:
            free, named = None, [combination(line, n, None, resolution) for line in telling]
        count = sum(one is not None for one in named)
        if count > best[0]:
            best = (count, n, free)
    return best[1], best[2]


def _free(lines: Sequence[float], parts: int, resolution: float) -> float | None:
    """Return the strongest line that is no multiple of 1/`parts`, or None."""
    for line in lines:
        if abs(line - round(line * parts) / parts) > resolution:
            return line
    return None


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
