"""Instants at which a motion is sampled for a picture, chosen so that corners, jumps and extremes are exact."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rocking.model import refusal, within

if TYPE_CHECKING:
    from rocking.model import Overturning
    from rocking.motion import Motion

SAMPLES_PER_TIME = 64
MOST_SAMPLES = 60_000
FALLEN = 3.0


def window(motion: Motion, cycles: tuple[float, float] | None) -> tuple[float, float]:
    """First and last instant shown, in τ, for `cycles` = (first, last) counted from the start; None is the whole motion.

    The whole of an overturned motion goes on past the proof that it never returns, until |Θ| = 3.
    """
    if cycles is None:
        return 0.0, motion.duration if motion.overturning is None else fall(
            motion, motion.overturning, FALLEN
        )
    try:
        first, last = cycles
    except (TypeError, ValueError):
        raise TypeError(refusal("cycles", "be a pair (first, last)", cycles)) from None
    first = within("cycles", first, 0, motion.cycles)
    if within("cycles", last, 0, motion.cycles) <= first:
        raise ValueError(refusal("cycles", "be a pair (first, last) with first < last", cycles))
    period = motion.system.forcing.period
    return first * period, last * period


def fall(motion: Motion, overturning: Overturning, angle: float) -> float:
    """Time τ at which a motion that is past return reaches |Θ| = `angle`; the end of the run if it began beyond."""
    from scipy.optimize import brentq

    def beyond(time: float) -> float:
        return abs(float(motion.at(time)[0])) - angle

    before = after = overturning.time
    if beyond(after) >= 0:
        return after if after > 0 else motion.duration
    while beyond(after) < 0:
        before, after = after, after + 0.25
    return brentq(beyond, before, after, xtol=1e-12)


def trace(motion: Motion, start: float, stop: float) -> tuple[NDArray, NDArray, NDArray]:
    """Times, angles and velocities from `start` to `stop`: a grid, every extreme, and every event twice, before and after.

    The grid is fine against both the forcing's period and the block's own unit of time; over a long window it thins out
    (to 60,000 instants), the events and the extremes never do.
    """
    step = max(min(motion.system.forcing.period, 1.0) / SAMPLES_PER_TIME, (stop - start) / MOST_SAMPLES)
    grid = np.linspace(start, stop, math.ceil((stop - start) / step) + 1)
    peaks, events = inside(motion.peaks, start, stop), inside(motion.events, start, stop)
    smooth = np.union1d(grid, peaks["time"])
    angle, velocity = motion.at(smooth)
    arrivals = events[events["time"] > start]
    time = np.concatenate([arrivals["time"], smooth, events["time"]])
    # A stable sort keeps, at an event's instant, the state before it in front of the state after it.
    order = np.argsort(time, kind="stable")
    angles = np.concatenate([arrivals["angle"], angle, events["angle"]])
    velocities = np.concatenate([arrivals["before"], velocity, events["after"]])
    return time[order], angles[order], velocities[order]


def inside(records: NDArray, start: float, stop: float) -> NDArray:
    """Those of the structured `records` whose time lies in [start, stop]."""
    return records[(records["time"] >= start) & (records["time"] <= stop)]
