"""Sampling of a motion for a figure, with exact corners, jumps and extremes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rocking.model.validation import Refusal, WrongType, instance, refuse_if, within
from rocking.motion.motion import Motion, end_shown, fallen, has_cycles

SAMPLES_PER_TIME = 64
SAMPLES_PER_PICTURE = 1000
MAX_SAMPLES = 500_000
STILLNESS_SHOWN = 0.15


def window(motion: Motion, cycles: tuple[float, float] | None) -> tuple[float, float]:
    """Return the first and the last instant shown, in τ.

    `cycles` = (first, last) counts from the start; None selects the whole motion. An overturned motion is shown up to
    |Θ| = 3, or until it lies flat with the full equation, beyond the instant at which overturning is certain.
    """
    instance("motion", motion, Motion)
    end = end_shown(motion)
    if cycles is None:
        return 0.0, end
    refuse_if(
        not has_cycles(motion),
        "cycles",
        "be omitted for a base motion of finite length, which has no cycles",
        cycles,
    )
    try:
        first, last = cycles
    except (TypeError, ValueError):
        raise WrongType("cycles", "be a pair (first, last)", cycles) from None
    first, last = (within("cycles", each, 0, motion.cycles) for each in (first, last))
    if last <= first:
        raise Refusal("cycles", "be a pair (first, last) with first < last", cycles)
    period = motion.system.periodic.period
    allowed = f"begin before |Θ| = {fallen(motion):g}, in cycle {end / period:.4g}"
    refuse_if(first * period >= end, "cycles", allowed, cycles)
    return first * period, min(last * period, end)


def settled(motion: Motion) -> float:
    """Return a time τ after the last event of a motion that came to rest, late enough to show that it stays there."""
    events = motion.events
    last = float(events["time"][-1]) if len(events) else 0.0
    if last == 0:
        return motion.duration
    forcing = motion.system.forcing
    cycle = forcing.span if has_cycles(motion) and forcing.largest else 0.0
    still = max(STILLNESS_SHOWN * last, cycle)
    return min(last + still, motion.duration)


def trace(motion: Motion, start: float, stop: float) -> tuple[NDArray, NDArray, NDArray]:
    """Sample a motion from `start` to `stop`: a grid, every extreme, and every event before and after it.

    The grid resolves the time scale of the forcing, the unit of τ and the figure. It has no instant at which the block stands
    still. Over a long motion the grid thins out (to 500,000 instants); events and extremes are always complete.

    Returns
    -------
    tuple of (array, array, array)
        Times, angles and velocities, normalised.
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
    """Return both ends, and equal steps inside each arc on which the block moves."""
    ends = np.unique(np.concatenate([[start], events, [stop]]))
    lengths, middles = np.diff(ends), (ends[1:] + ends[:-1]) / 2
    moves = (motion.at(middles)[1] != 0) | (motion.acceleration(middles) != 0)
    finest = min(
        min(motion.system.forcing.time_scale, 1.0) / SAMPLES_PER_TIME, (stop - start) / SAMPLES_PER_PICTURE
    )
    step = max(finest, float(lengths[moves].sum()) / MAX_SAMPLES)
    steps = np.where(moves, np.ceil(lengths / step), 1).astype(int)
    arc = np.repeat(np.arange(len(steps)), steps - 1)
    number = 1 + np.arange(len(arc)) - np.repeat(np.cumsum(steps - 1) - (steps - 1), steps - 1)
    return np.concatenate([[start, stop], ends[arc] + number / steps[arc] * lengths[arc]])


def inside(records: NDArray, start: float, stop: float) -> NDArray:
    """Return the structured `records` whose time lies in [start, stop]."""
    return records[(records["time"] >= start) & (records["time"] <= stop)]
