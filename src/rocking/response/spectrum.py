"""Power spectral density of a motion: exact samples, Welch's average, and named spectral lines."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import field, frozen

from rocking.model.arrays import ReadOnlyArrays, read_only
from rocking.model.result import Result, along, described
from rocking.model.system import System, quantities
from rocking.model.text import counted
from rocking.model.validation import Refusal, WrongType, instance, refuse_if, whole, within
from rocking.model.verdict import Outcome
from rocking.motion.motion import Motion
from rocking.response.spectral_lines import Line, Taper, combination, find_lines, parts_and_rotation

if TYPE_CHECKING:
    import xarray as xr


MAX_SHOWN = 16
SHARE_OF_LINES = 0.9


@frozen
class Peak:
    """Spectral line.

    Attributes
    ----------
    frequency : float
        Frequency in cycles per τ, refined over the whole record.
    height : float
        Spectral density at the frequency bin of the line, Θ² τ. It grows with the segment length.
    amplitude : float
        Amplitude of the sine, in Θ. It does not depend on the segment length.
    name : str
        Combination of the forcing frequency f and the rotation frequency f_r, such as "f/3" or "f − 2f_r". "" if no
        combination fits, or more than one.
    forcing_multiple : Fraction or None
        p in p·f + q·f_r.
    rotation_multiple : int or None
        q in p·f + q·f_r.
    offset : float or None
        Distance from this combination, in cycles per τ.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> peak = rk.spectral_density(rk.simulate(system, cycles=1200), transient=600).peaks[0]
    >>> peak.name, str(peak.forcing_multiple), round(peak.frequency, 6)
    ('f/3', '1/3', 0.833333)
    """

    frequency: float
    height: float
    amplitude: float
    name: str
    forcing_multiple: Fraction | None
    rotation_multiple: int | None
    offset: float | None


@frozen(eq=False)
class SpectralDensity(ReadOnlyArrays, Result):
    """One-sided power spectral density of Θ, in Θ² per (cycle per τ); returned by `spectral_density`.

    Attributes
    ----------
    system : System
        System of the motion.
    frequency : ndarray
        Frequency in cycles per τ, from 0 to half the sampling rate. The forcing frequency is f = 1/T.
    density : ndarray
        Power spectral density, Θ² τ.
    window : str or tuple
        Window, as in `scipy.signal.get_window`.
    segment, overlap, segments : int
        Cycles per segment, cycles by which neighbouring segments overlap, and number of segments averaged (Welch 1967).
    transient, cycles : int
        Number of forcing cycles discarded, and number of cycles used.
    samples : int
        Number of exact samples per forcing cycle.
    aliased : float
        Fraction of the variance above half the sampling rate, which is aliased; measured.
    mean, variance : float
        Mean and variance of Θ over the cycles used. The mean is not part of the density.
    bandwidth : float
        Noise bandwidth of the window, in cycles per τ.
    resolution : float
        1 over the length of the record, in cycles per τ: the largest distance of a line from its named combination.
    period : int or None
        Number of forcing cycles per response period; None if the motion is not periodic.
    symmetric : bool or None
        For a periodic motion, True if it is its own mirror image half a period later. It then has no even multiples.
    parts : int
        n of the multiples of f/n in names.
    rotation : float or None
        Rotation frequency f_r, in cycles per forcing cycle.
    peaks : tuple of Peak
        Spectral lines, the strongest first.

    Notes
    -----
    In the dataset, `density` is over `cyclic_frequency`. `line_frequency`, `line_amplitude` and `line_name` are along `line`, the
    strongest first.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> density = rk.spectral_density(rk.simulate(system, cycles=1200), transient=600)
    >>> density.period, density.segments, density.broad_band
    (3, 14, False)
    """

    PLOT = "spectrum"
    LONG = ("cyclic_frequency",)

    system: System
    frequency: np.ndarray = field(repr=False, converter=read_only)
    density: np.ndarray = field(repr=False, converter=read_only)
    window: Any
    segment: int
    overlap: int
    segments: int
    transient: int
    cycles: int
    samples: int
    aliased: float
    mean: float
    variance: float
    bandwidth: float
    resolution: float
    period: int | None
    symmetric: bool | None
    parts: int
    rotation: float | None
    peaks: tuple[Peak, ...] = field(repr=False)

    @property
    def forcing_multiples(self) -> np.ndarray:
        """Frequencies in units of the forcing frequency."""
        return self.frequency * self.system.periodic.period

    @property
    def highest(self) -> float:
        """Highest frequency of the search for lines, in cycles per τ: a sixteenth of the sampling rate.

        The amplitudes of a signal with jumps in its velocity fall as the square of the frequency. Aliasing then changes a
        line at a fraction x of the sampling rate by up to (πx/sin πx)² − 1 of its amplitude. This is 1.3 % at a sixteenth,
        and a sixteenth of that at a quarter of this frequency.
        """
        return self.samples / MAX_SHOWN / self.system.periodic.period

    @property
    def line_share(self) -> float:
        """Fraction of the variance in spectral lines."""
        return min(1.0, sum(peak.amplitude**2 / 2 for peak in self.peaks) / self.variance)

    @property
    def broad_band(self) -> bool:
        """True if more than a tenth of the variance lies outside the spectral lines."""
        return self.line_share < SHARE_OF_LINES

    def _data(self) -> xr.Dataset:
        import xarray as xr

        lines = {
            "line_frequency": (
                np.array([peak.frequency for peak in self.peaks], float),
                "frequency of a spectral line in cycles per tau",
            ),
            "line_amplitude": (
                np.array([peak.amplitude for peak in self.peaks], float),
                "amplitude of a spectral line",
            ),
            "line_name": (
                np.array([peak.name for peak in self.peaks], str),
                "combination of the forcing frequency f and the rotation frequency f_r",
            ),
        }
        density = {"density": (self.density, "power spectral density of the angle")}
        frequency = {"cyclic_frequency": (self.frequency, "frequency in cycles per tau")}
        attributes = described("Power spectral density of the angle") | {
            **quantities(self.system),
            "transient": self.transient,
            "cycles": self.cycles,
            "window": str(self.window),
            "segment": self.segment,
            "segments": self.segments,
            "overlap": self.overlap,
            "samples": self.samples,
            "aliased": self.aliased,
            "line_share": self.line_share,
            "broad_band": self.broad_band,
            "response_period": self.period,
            "symmetric": self.symmetric,
            "rotation": self.rotation,
            "mean_angle": self.mean,
            "variance": self.variance,
        }
        variables = along("cyclic_frequency", density) | along("line", lines)
        return xr.Dataset(variables, along("cyclic_frequency", frequency), attributes)

    def __str__(self) -> str:
        block = self.block
        resolution = f"{self.resolution:.3g} cycles per τ"
        if block is not None:
            resolution = f"{self.resolution / block.seconds(1.0):.3g} Hz"
        unnamed = sum(not peak.name for peak in self.peaks)
        what = "broad band" if self.broad_band else "lines"
        names = ", ".join(peak.name for peak in self.peaks[:5] if peak.name) or "none named"
        turning = f", f_r = {self.rotation:.6g} f" if self.rotation else ""
        one = len(self.peaks) == 1
        shared = f" overlapping by {self.overlap}" * (self.segments > 1)
        return (
            f"{what}: {counted(len(self.peaks), 'line')} ({names}{', …' * (len(self.peaks) > 5)}"
            f"{turning}; {unnamed} unnamed) {'carries' if one else 'carry'} {100 * self.line_share:.4g} % of the variance; "
            f"{counted(self.segments, 'segment')} of {self.segment} cycles{shared}, "
            f"window {self.window}, {self.samples} samples per cycle, {self.aliased:.1g} of the variance aliased, "
            f"resolution {resolution}"
        )


FEWEST_SAMPLES, MOST_SAMPLES = 64, 1024
ALIASED = 1e-7
WATCHED = 256
BREATH = 2**18
MAX_FORCING_PERIOD = 64
RECURRENCE = 1e-8


def sampled(motion: Motion, transient: int, samples: int, cycles: int | None = None) -> np.ndarray:
    """Return Θ at equidistant times in the forcing cycles after the transient, exact (`Motion.at`)."""
    cycles = motion.cycles - transient if cycles is None else cycles
    record = np.empty((cycles, samples))
    inside = np.arange(samples) / samples
    period = motion.system.periodic.period
    rows = max(1, BREATH // samples)
    for first in range(0, cycles, rows):
        numbers = transient + np.arange(first, min(first + rows, cycles))
        record[first : first + rows] = motion.at((numbers[:, None] + inside) * period)[0]
    return record


def sampling(motion: Motion, transient: int, samples: int | None) -> tuple[int, float]:
    """Return the number of samples per cycle and the fraction of the variance that is aliased.

    The fraction is measured over up to 256 cycles, as the variance above half the sampling rate at four times as many
    samples. If the number of samples is not given, it is doubled until the fraction is small.

    Returns
    -------
    tuple of (int, float)
        Samples per cycle; aliased fraction of the variance.
    """
    cycles = min(motion.cycles - transient, WATCHED)
    chosen = samples or FEWEST_SAMPLES
    while True:
        share = _share_above(sampled(motion, transient, 4 * chosen, cycles), chosen / 2)
        if samples or share <= ALIASED or chosen >= MOST_SAMPLES:
            return chosen, share
        chosen *= 2


def _share_above(record: np.ndarray, frequency: float) -> float:
    values = (record - record.mean()).ravel()
    power = np.abs(np.fft.rfft(values * _blackman(values.size))) ** 2
    total = power.sum()
    return float(power[int(frequency * len(record)) :].sum() / total) if total else 0.0


@lru_cache(2)
def _blackman(values: int) -> np.ndarray:
    from scipy.signal import get_window

    return get_window("blackmanharris", values)


def recurrence(record: np.ndarray) -> int | None:
    """Return the smallest number of cycles, up to 64, after which all samples repeat to 10⁻⁸ of their range, or None."""
    allowed = RECURRENCE * np.ptp(record)
    for period in range(1, min(MAX_FORCING_PERIOD, len(record) // 2) + 1):
        if np.abs(record[-1] - record[-1 - period]).max() > allowed:
            continue
        if np.abs(record[period:] - record[:-period]).max() <= allowed:
            return period
    return None


def is_mirrored(record: np.ndarray, period: int) -> bool:
    """Return whether a record of this period is its own mirror image half a period later."""
    values = record[:period].ravel() + 0.0
    half = np.roll(values, values.size // 2)
    return bool(np.abs(values - values.mean() + half - half.mean()).max() <= RECURRENCE * np.ptp(record))


def welch(record: np.ndarray, segment: int, shared: int, taper: Taper) -> tuple[np.ndarray, np.ndarray, int]:
    """Compute the one-sided density by the method of Welch (1967), IEEE Trans. Audio Electroacoust. 15, 70.

    Returns
    -------
    tuple of (ndarray, ndarray, int)
        Frequencies in cycles per forcing cycle; density; number of segments.
    """
    from scipy import signal

    cycles, samples = record.shape
    frequencies, density = signal.welch(
        record.ravel(),
        fs=samples,
        window=taper.weights,
        nperseg=segment * samples,
        noverlap=shared * samples,
        detrend=False,
    )
    return frequencies, density, (cycles - shared) // (segment - shared)


SEGMENTS = 8
LEAST_SEGMENT = 8
MIN_SAMPLES, MAX_SAMPLES = 16, 4096
MAX_VALUES = 2**24
# As power. A line must exceed ten times the side lobes, so no line could be found above this limit.
HIGHEST_SIDE_LOBES = 0.1


def spectral_density(
    motion: Motion,
    transient: int = 0,
    segment: int | None = None,
    overlap: float = 0.5,
    window: str | tuple = "blackmanharris",
    samples: int | None = None,
    period: int | None = None,
    rotation: float | None = None,
) -> SpectralDensity:
    """Estimate the spectral density of Θ from exact samples of a motion (Welch 1967), and name its lines.

    Parameters
    ----------
    motion : Motion
        Motion recorded with ``record="all"`` that has not overturned or come to rest.
    transient : int
        Number of forcing cycles discarded at the beginning. Default: 0.
    segment : int, optional
        Number of forcing cycles per segment. For a periodic motion, a multiple of its period, so that its lines lie on bins.
        Default: an eighth of the record.
    overlap : float
        Fraction of a segment shared with the next one, in [0, 0.95]. Default: 0.5.
    window : str or tuple
        Window, as in `scipy.signal.get_window`. The Blackman–Harris window shows lines down to 10⁻⁸ of the strongest, with
        side lobes at −92 dB. Its main lobe is four bins wide on each side. "hann" is narrower and shows lines down to 10⁻²
        only. Default: "blackmanharris".
    samples : int, optional
        Number of samples per forcing cycle, even, in [16, 4096]. Lines are searched up to a sixteenth of it, in forcing
        frequencies. Default: 64, doubled up to 1,024 until less than 10⁻⁷ of the variance is aliased.
    period : int, optional
        n of the multiples of f/n in names. Default: the period of a periodic motion, else the smallest n ≤ 16 that names
        the most of the ten strongest lines.
    rotation : float, optional
        Rotation frequency f_r, in cycles per forcing cycle. Default for a motion that is not periodic: the strongest line
        that is no multiple of f/n, if it names another line too.

    Returns
    -------
    SpectralDensity
        Density over frequency, and named lines.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    ValueError
        If the motion overturns, comes to rest or never moves, or if an argument lies outside its range. If fewer than 64
        cycles, or 64 periods of a periodic motion, follow the transient.

    See Also
    --------
    simulate : The motion that is sampled.
    rotation_number : Rotation numbers of an undamped motion.
    rocking.plot.spectrum : Plot the spectral density.

    Notes
    -----
    A motion counts as periodic if all its samples repeat to 10⁻⁸ of their range after n ≤ 64 cycles. Its lines then lie on
    known bins. Any other peak is a line if it exceeds its surroundings more than noise does. It must also keep four fifths
    of its height under a window over the whole record. Frequencies are refined by Laskar's method: each one maximises the
    Fourier integral of the whole record under a Hann window.

    A line is named p·f + q·f_r (Yim & Lin 1991, Eq. (7)) if it lies within one resolution of this combination, and no other
    combination is similarly simple. |q| is at most 32. For short records, it is limited so that names cover a tenth of all
    frequencies. In a broad band, where lines hold less than nine tenths of the variance, no rotation is searched for. The
    number of samples per cycle is an integer, so that aliasing maps each combination to another. It shifts power, but adds
    no other lines.

    Limits: lines closer than the main lobe of the window are not separated. A torus whose frequencies are nearly
    commensurate within the record is named as if they were commensurate.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> density = rk.spectral_density(rk.simulate(system, cycles=1200), transient=600)
    >>> [peak.name for peak in density.peaks[:4]], density.symmetric
    (['f/3', 'f', '5f/3', '7f/3'], True)
    """
    cycles = _check_motion(motion, transient)
    transient = motion.cycles - cycles
    if samples is not None:
        samples = whole("samples", samples, MIN_SAMPLES, MAX_SAMPLES)
        refuse_if(samples % 2, "samples", "be even", samples)
    if rotation is not None:
        rotation = within("rotation", rotation, 1e-6, 1e3)
    if period is not None:
        period = whole("period", period, 1, cycles)
    samples, aliased = sampling(motion, transient, samples)
    most = MAX_VALUES // samples
    if cycles > most:
        raise Refusal(
            "motion", f"have at most {most} cycles after its transient for {samples} samples in each", cycles
        )
    values = sampled(motion, transient, samples)
    mean = float(values.mean())
    values -= mean
    if not np.ptp(values):
        raise Refusal("motion", f"move for a spectrum; its angle is {mean:.6g} throughout")
    repeats = recurrence(values)
    segment = _segment(segment, cycles, repeats)
    taper = _taper(window, segment * samples)
    shared = int(within("overlap", overlap, 0.0, 0.95) * segment)
    frequency, density, segments = welch(values, segment, shared, taper)
    lines = find_lines(
        values,
        density,
        segment,
        taper,
        taper.independent(segments, (segment - shared) * samples),
        samples / MAX_SHOWN,
        repeats,
    )
    parts, rotation = _parts_and_rotation(lines, values.var(), period or repeats, rotation, 1 / cycles)
    unit = motion.system.periodic.period
    return SpectralDensity(
        system=motion.system,
        frequency=frequency / unit,
        density=density * unit,
        window=window,
        segment=segment,
        overlap=shared,
        segments=segments,
        transient=transient,
        cycles=cycles,
        samples=samples,
        aliased=aliased,
        mean=mean,
        variance=float(values.var()),
        bandwidth=taper.bandwidth / segment / unit,
        resolution=1 / cycles / unit,
        period=repeats,
        symmetric=is_mirrored(values, repeats) if repeats else None,
        parts=parts,
        rotation=rotation,
        peaks=tuple(_peak(line, parts, rotation, 1 / cycles, unit) for line in lines),
    )


def _check_motion(motion: Motion, transient: int) -> int:
    """Return the number of cycles after the transient; ValueError if the motion can have no spectrum."""
    instance("motion", motion, Motion).system.periodic  # noqa: B018 (it refuses)
    if motion.overturning is not None:
        raise Refusal(
            "motion", f"not overturn for a spectrum; it overturned in cycle {motion.overturning.cycle}"
        )
    if motion.outcome is not Outcome.BOUNDED:
        raise Refusal("motion", "not come to rest for a spectrum; it is at rest at its end")
    cycles = motion.cycles - whole("transient", transient, 0, motion.cycles - 1)
    if cycles < SEGMENTS * LEAST_SEGMENT:
        raise _too_short(cycles, SEGMENTS * LEAST_SEGMENT, "")
    return cycles


def _segment(segment: int | None, cycles: int, repeats: int | None) -> int:
    """Return the number of cycles per segment: as given, or an eighth of the record, in whole periods."""
    period = repeats or 1
    if segment is None:
        segment = cycles // SEGMENTS // period * period
        if segment < LEAST_SEGMENT * period:
            raise _too_short(cycles, SEGMENTS * LEAST_SEGMENT * period, f" of period {period}")
        return segment
    segment = whole("segment", segment, LEAST_SEGMENT, cycles)
    if segment % period or segment < LEAST_SEGMENT * period:
        least = f"be a multiple of the response period of {period} cycles, at least {LEAST_SEGMENT * period}"
        raise Refusal("segment", least, segment)
    return segment


def _taper(window: str | tuple, length: int) -> Taper:
    from scipy.signal import get_window

    if not isinstance(window, str | tuple):
        raise WrongType("window", "be a window of scipy.signal.get_window", window)
    try:
        with np.errstate(all="ignore"):
            weights = get_window(window, length)
    except (TypeError, ValueError, IndexError):
        raise Refusal("window", "be a window of scipy.signal.get_window", window) from None
    refuse_if(not np.isfinite(weights).all(), "window", "have finite weights", window)
    taper = Taper(weights)
    if taper.side_lobes > HIGHEST_SIDE_LOBES:
        raise Refusal("window", "have side lobes below a tenth of its main lobe", window)
    return taper


def _parts_and_rotation(
    lines: list[Line], variance: float, parts: int | None, rotation: float | None, resolution: float
) -> tuple[int, float | None]:
    """Return the basis of the names of lines; none is searched for in a broad band, because some combination fits any line."""
    if sum(line.amplitude**2 / 2 for line in lines) < SHARE_OF_LINES * variance:
        return parts or 1, rotation
    return parts_and_rotation([line.frequency for line in lines], parts, rotation, resolution)


def _peak(line: Line, parts: int, rotation: float | None, resolution: float, unit: float) -> Peak:
    result = combination(line.frequency, parts, rotation, resolution)
    return Peak(
        frequency=line.frequency / unit,
        height=line.height * unit,
        amplitude=line.amplitude,
        name=result.name if result else "",
        forcing_multiple=result.forcing if result else None,
        rotation_multiple=result.rotation if result else None,
        offset=result.offset / unit if result else None,
    )


def _too_short(cycles: int, needed: int, why: str) -> ValueError:
    return ValueError(
        f"motion must last {needed} cycles after its transient for a spectrum{why}; it lasts {cycles} "
        "(simulate more cycles)"
    )
