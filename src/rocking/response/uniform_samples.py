"""A motion as an array of exact samples, (cycles, samples a cycle), and what can be read off it."""

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
    """Θ at whole fractions of the forcing cycles after the transient, exactly (`Motion.at`)."""
    cycles = motion.cycles - transient if cycles is None else cycles
    record = np.empty((cycles, samples))
    inside = np.arange(samples) / samples
    period = motion.system.forcing.period
    rows = max(1, BREATH // samples)
    for first in range(0, cycles, rows):
        numbers = transient + np.arange(first, min(first + rows, cycles))
        record[first : first + rows] = motion.at((numbers[:, None] + inside) * period)[0]
    return record


def sampling(motion: Motion, transient: int, samples: int | None) -> tuple[int, float]:
    """Samples a cycle, and the share of the variance which these alias.

    That share is measured, over up to 256 cycles: what four times as many samples show above half the sampling rate.
    Unless the number is given, it is doubled until the share is small.
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
    """The least number of cycles, up to 64, after which all samples repeat to 10⁻⁸ of their range."""
    allowed = RECURRENCE * np.ptp(record)
    for period in range(1, min(MAX_FORCING_PERIOD, len(record) // 2) + 1):
        if np.abs(record[-1] - record[-1 - period]).max() > allowed:
            continue
        if np.abs(record[period:] - record[:-period]).max() <= allowed:
            return period
    return None


def is_mirrored(record: np.ndarray, period: int) -> bool:
    """Whether a record of that period is its own mirror image half a period later."""
    values = record[:period].ravel() + 0.0
    half = np.roll(values, values.size // 2)
    return bool(np.abs(values - values.mean() + half - half.mean()).max() <= RECURRENCE * np.ptp(record))


def welch(record: np.ndarray, segment: int, shared: int, taper: Taper) -> tuple[np.ndarray, np.ndarray, int]:
    """One-sided density by the method of Welch (1967), IEEE Trans. Audio Electroacoust. 15, 70.

    Returns frequencies in cycles per forcing cycle, the density, and the number of segments.
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
