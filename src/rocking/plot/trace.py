"""Instants at which a motion is sampled for a picture, chosen so that corners, jumps and extremes are exact."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

SAMPLES_PER_TIME = 64
MOST_SAMPLES = 60_000
FALLEN = 3.0


def window(motion, cycles: tuple[float, float] | None) -> tuple[float, float]:
    """First and last instant shown, in τ, for `cycles` = (first, last) counted from the start; None is the whole motion.

    The whole of an overturned motion goes on past the proof that it never returns, until |Θ| = 3.
    """
    if cycles is None:
        return 0.0, motion.duration if motion.overturning is None else fall(motion, FALLEN)
    first, last = cycles
    if not 0 <= first < last <= motion.cycles:
        raise ValueError(f"cycles must be (first, last) with 0 <= first < last <= {motion.cycles}; got {cycles!r}")
    period = motion.system.forcing.period
    return first * period, last * period


def fall(motion, angle: float) -> float:
    """Time τ at which an overturned motion reaches |Θ| = `angle`, at the earliest the time of the proof."""

    def beyond(time: float) -> float:
        return abs(float(motion.at(time)[0])) - angle

    before = after = motion.overturning.time
    while beyond(after) < 0:
        before, after = after, after + 0.25
    return after if before == after else brentq(beyond, before, after, xtol=1e-12)


def trace(motion, start: float, stop: float) -> tuple[NDArray, NDArray, NDArray]:
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
