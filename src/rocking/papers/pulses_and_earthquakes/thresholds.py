"""Amplitudes that overturn a block under a pulse, from the simulation by bisection, and their distance from printed numbers."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

import rocking as rk
from rocking.motion.motion import Motion

GRAVITY = 9.80665
RELATIVE = 1e-13
"""Relative width at which a bisection ends."""
TURNS = {"rectangular": math.pi, "half-sine": math.pi, "one-sine": math.tau, "one-cosine": math.tau}
"""Ω T of each pulse; that of a rectangular pulse is a convention."""
STEP = 0.02
"""Step of the search for the lowest amplitude that overturns the block."""
THIRD_DIGIT = 0.01
"""One unit of the last digit of Zhang & Makris (2001), whose numbers have three digits."""
IN_G = 1e-3
"""Smallest difference between two accelerations that Makris & Roussos (2000) print, in g, except in Fig. 9."""


def system(
    kind: str, amplitude: float, frequency: float, restitution: float, angle: float | None = None
) -> rk.System:
    """Return a block under a pulse with the normalised frequency Ω; with a critical angle, for the full equation."""
    pulse = rk.Pulse(kind, amplitude=amplitude, duration=TURNS[kind] / frequency)
    return rk.System(pulse, restitution, critical_angle=angle)


def run(
    kind: str, amplitude: float, frequency: float, restitution: float, angle: float | None = None
) -> Motion:
    """Return the motion from rest under a pulse."""
    return rk.simulate(system(kind, amplitude, frequency, restitution, angle), record="none")


def falls(
    kind: str, amplitude: float, frequency: float, restitution: float, angle: float | None = None
) -> bool:
    """Return whether a pulse overturns the block."""
    return run(kind, amplitude, frequency, restitution, angle).outcome is rk.Outcome.OVERTURNED


def speed_lacking(
    kind: str, amplitude: float, frequency: float, restitution: float, angle: float | None = None
) -> float:
    """Return the share of the speed after the first impact that the block lacks to overturn then; 1 without an impact.

    The impact must come after the pulse.
    """
    events = rk.simulate(system(kind, amplitude, frequency, restitution, angle)).events
    speeds = np.abs(events["after"][events["kind"] == "impact"])
    needed = 1.0 if angle is None else 2 * math.sin(angle / 2) / angle
    return 1 - float(speeds[0]) / needed if speeds.size else 1.0


def at_once(kind: str, frequency: float, amplitude: float) -> bool:
    """Return whether a pulse overturns the block without an impact."""
    motion = run(kind, amplitude, frequency, 0.0)
    return motion.outcome is rk.Outcome.OVERTURNED and motion.impacts == 0


def bisected(condition: Callable[[float], bool], no: float, yes: float) -> float:
    """Return the number between `no` and `yes` at which the answer changes; NaN if it does not."""
    if condition(no) or not condition(yes):
        return math.nan
    while abs(yes - no) > RELATIVE * abs(yes):
        middle = 0.5 * (no + yes)
        no, yes = (no, middle) if condition(middle) else (middle, yes)
    return yes


def threshold(
    kind: str, frequency: float, restitution: float, no: float, yes: float, angle: float | None = None
) -> float:
    """Return the amplitude between `no` and `yes` at which a pulse begins or ceases to overturn the block."""
    return bisected(lambda amplitude: falls(kind, amplitude, frequency, restitution, angle), no, yes)


def lowest(kind: str, frequency: float, restitution: float) -> float:
    """Return the lowest amplitude that overturns the block, as a search in steps finds it."""
    amplitude = 1.0
    while not falls(kind, amplitude, frequency, restitution):
        amplitude += STEP
    return threshold(kind, frequency, restitution, max(amplitude - STEP, 1.0), amplitude)


def lowest_of(kind: str, frequencies: np.ndarray, restitution: float) -> np.ndarray:
    """Return the lowest amplitudes at several frequencies."""
    return np.array([lowest(kind, frequency, restitution) for frequency in frequencies.tolist()])


def in_g(
    block: rk.Block, kind: str, duration: float, stands: float, overturns: float, angle: float | None = None
) -> float:
    """Return the acceleration in g at which a pulse begins to overturn a block, between `stands` and `overturns`."""
    frequency = TURNS[kind] / block.time(duration)

    def condition(acceleration: float) -> bool:
        return falls(kind, block.amplitude(acceleration * GRAVITY), frequency, block.restitution, angle)

    return bisected(condition, stands, overturns)


def outside(value: float, one: float, other: float) -> float:
    """Return the distance of a value from the interval between two numbers; 0 inside."""
    low, high = sorted((one, other))
    return max(low - value, value - high, 0.0)
