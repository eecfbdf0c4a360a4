"""Exact samples of a motion as an array (cycles, samples per cycle), and their properties."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from rocking.motion import Motion
from rocking.response.spectral_lines import Taper

MIN_SAMPLES, MAX_SAMPLES = 64, 1024
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
    chosen = samples or MIN_SAMPLES
    while True:
        share = _share_above(sampled(motion, transient, 4 * chosen, cycles), chosen / 2)
        if samples or share <= ALIASED or chosen >= MAX_SAMPLES:
            return chosen, share
        chosen *= 2


def _share_above(record: np.ndarray, frequency: float) -> float:
    values = (record - record.mean()).ravel()
    power = np.abs(np.fft.rfft(values * _taper(values.size))) ** 2
    total = power.sum()
    return float(power[int(frequency * len(record)) :].sum() / total) if total else 0.0


@lru_cache(2)
def _taper(values: int) -> np.ndarray:
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
