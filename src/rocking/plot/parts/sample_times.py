"""Instants at which a motion is sampled for a picture, chosen so that corners, jumps and extremes are exact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rocking.model import instance, refusal, refuse_if, within
from rocking.motion import FALLEN, Motion, end_shown

SAMPLES_PER_TIME = 64
SAMPLES_PER_PICTURE = 1000
MAX_SAMPLES = 500_000
STILLNESS_SHOWN = 0.15


def window(motion: Motion, cycles: tuple[float, float] | None) -> tuple[float, float]:
    """First and last instant shown, in τ, for `cycles` = (first, last) counted from the start; None is the whole motion.

    An overturned motion goes on past the proof that it never returns, until |Θ| = 3.
    """
    instance("motion", motion, Motion)
    end = end_shown(motion)
    if cycles is None:
        return 0.0, end
    try:
        first, last = cycles
    except (TypeError, ValueError):
        raise TypeError(refusal("cycles", "be a pair (first, last)", cycles)) from None
    first = within("cycles", first, 0, motion.cycles)
    if within("cycles", last, 0, motion.cycles) <= first:
        raise ValueError(refusal("cycles", "be a pair (first, last) with first < last", cycles))
    period = motion.system.forcing.period
    refuse_if(
        first * period >= end, "cycles", f"begin before |Θ| = {FALLEN:g}, in cycle {end / period:.4g}", cycles
    )
    return first * period, min(last * period, end)


def settled(motion: Motion) -> float:
    """Time τ shortly after the last event of a motion that came to rest: long enough to see that it stays there."""
    forcing, events = motion.system.forcing, motion.events
    last = float(events["time"][-1]) if len(events) else 0.0
    if last == 0:
        return motion.duration
    still = max(STILLNESS_SHOWN * last, forcing.period if forcing.amplitude else 0.0)
    return min(last + still, motion.duration)


def trace(motion: Motion, start: float, stop: float) -> tuple[NDArray, NDArray, NDArray]:
    """Times, angles and velocities from `start` to `stop`: a grid, every extreme, and every event twice, before and after.

    The grid is fine against the forcing's period, the block's own unit of time and the picture, and has no instant where
    the block stands still; over a long motion it thins out (to 500,000 instants), the events and the extremes never do.
    """
    peaks, events = inside(motion.peaks, start, stop), inside(motion.events, start, stop)
    smooth = np.union1d(_grid(motion, start, stop, events["time"]), peaks["time"])
    angle, velocity = motion.at(smooth)
    arrivals = events[events["time"] > start]
    time = np.concatenate([arrivals["time"], smooth, events["time"]])
    # A stable sort keeps, at an event's instant, the state before it in front of the state after it.
    order = np.argsort(time, kind="stable")
    angles = np.concatenate([arrivals["angle"], angle, events["angle"]])
    velocities = np.concatenate([arrivals["before"], velocity, events["after"]])
    return time[order], angles[order], velocities[order]


def _grid(motion: Motion, start: float, stop: float, events: NDArray) -> NDArray:
    """The ends, and equal steps inside every arc between two events on which the block moves."""
    ends = np.unique(np.concatenate([[start], events, [stop]]))
    lengths, middles = np.diff(ends), (ends[1:] + ends[:-1]) / 2
    moves = (motion.at(middles)[1] != 0) | (motion.acceleration(middles) != 0)
    finest = min(
        min(motion.system.forcing.period, 1.0) / SAMPLES_PER_TIME, (stop - start) / SAMPLES_PER_PICTURE
    )
    step = max(finest, float(lengths[moves].sum()) / MAX_SAMPLES)
    steps = np.where(moves, np.ceil(lengths / step), 1).astype(int)
    arc = np.repeat(np.arange(len(steps)), steps - 1)
    number = 1 + np.arange(len(arc)) - np.repeat(np.cumsum(steps - 1) - (steps - 1), steps - 1)
    return np.concatenate([[start, stop], ends[arc] + number / steps[arc] * lengths[arc]])


def inside(records: NDArray, start: float, stop: float) -> NDArray:
    """Those of the structured `records` whose time lies in [start, stop]."""
    return records[(records["time"] >= start) & (records["time"] <= stop)]
