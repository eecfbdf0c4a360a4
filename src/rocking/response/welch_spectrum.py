"""Spectral density of a motion: exact samples, Welch's average, and named spectral lines."""

from __future__ import annotations

import numpy as np

from rocking.model import Outcome, instance, refusal, refuse_if, whole, within
from rocking.motion import Motion
from rocking.response import uniform_samples
from rocking.response.spectral_density import SHARE_OF_LINES, SHOWN, Peak, SpectralDensity
from rocking.response.spectral_line_names import combination, parts_and_rotation
from rocking.response.spectral_lines import Line, Taper, find_lines

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
    samples, aliased = uniform_samples.sampling(motion, transient, samples)
    most = MAX_VALUES // samples
    if cycles > most:
        raise ValueError(
            f"motion must have at most {most} cycles after its transient for {samples} samples in each; it has {cycles}"
        )
    values = uniform_samples.sampled(motion, transient, samples)
    mean = float(values.mean())
    values -= mean
    if not np.ptp(values):
        raise ValueError(f"motion must move for a spectrum; its angle is {mean:.6g} throughout")
    repeats = uniform_samples.recurrence(values)
    segment = _segment(segment, cycles, repeats)
    taper = _taper(window, segment * samples)
    shared = int(within("overlap", overlap, 0.0, 0.95) * segment)
    frequency, density, segments = uniform_samples.welch(values, segment, shared, taper)
    lines = find_lines(
        values,
        density,
        segment,
        taper,
        taper.independent(segments, (segment - shared) * samples),
        samples / SHOWN,
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
        symmetric=uniform_samples.is_mirrored(values, repeats) if repeats else None,
        parts=parts,
        rotation=rotation,
        peaks=tuple(_peak(line, parts, rotation, 1 / cycles, unit) for line in lines),
    )


def _check_motion(motion: Motion, transient: int) -> int:
    """Return the number of cycles after the transient; ValueError if the motion can have no spectrum."""
    instance("motion", motion, Motion).system.periodic  # noqa: B018 (it refuses)
    if motion.overturning is not None:
        raise ValueError(
            f"motion must not overturn for a spectrum; it overturned in cycle {motion.overturning.cycle}"
        )
    if motion.outcome is not Outcome.BOUNDED:
        raise ValueError("motion must not come to rest for a spectrum; it is at rest at its end")
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
        raise ValueError(refusal("segment", least, segment))
    return segment


def _taper(window: str | tuple, length: int) -> Taper:
    from scipy.signal import get_window

    if not isinstance(window, str | tuple):
        raise TypeError(refusal("window", "be a window of scipy.signal.get_window", window))
    try:
        with np.errstate(all="ignore"):
            weights = get_window(window, length)
    except (TypeError, ValueError, IndexError):
        raise ValueError(refusal("window", "be a window of scipy.signal.get_window", window)) from None
    refuse_if(not np.isfinite(weights).all(), "window", "have finite weights", window)
    taper = Taper(weights)
    if taper.side_lobes > HIGHEST_SIDE_LOBES:
        raise ValueError(refusal("window", "have side lobes below a tenth of its main lobe", window))
    return taper


def _parts_and_rotation(
    lines: list[Line], variance: float, parts: int | None, rotation: float | None, resolution: float
) -> tuple[int, float | None]:
    """Return the basis of the names of lines; none is searched for in a broad band, because some combination fits any line."""
    if sum(line.amplitude**2 / 2 for line in lines) < SHARE_OF_LINES * variance:
        return parts or 1, rotation
    return parts_and_rotation([line.frequency for line in lines], parts, rotation, resolution)


def _peak(line: Line, parts: int, rotation: float | None, resolution: float, unit: float) -> Peak:
    found = combination(line.frequency, parts, rotation, resolution)
    return Peak(
        frequency=line.frequency / unit,
        height=line.height * unit,
        amplitude=line.amplitude,
        name=found.name if found else "",
        forcing_multiple=found.forcing if found else None,
        rotation_multiple=found.rotation if found else None,
        offset=found.offset / unit if found else None,
    )


def _too_short(cycles: int, needed: int, why: str) -> ValueError:
    return ValueError(
        f"motion must last {needed} cycles after its transient for a spectrum{why}; it lasts {cycles} "
        "(simulate more cycles)"
    )
