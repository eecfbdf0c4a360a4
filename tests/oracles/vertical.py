"""Motion of a block on a base that moves horizontally and vertically, by DOP853 of SciPy with events.

Nothing is taken from the package. The equation is that of the angle theta in rad, in units of time 1/p of the right side. With
w = alpha_i sigma - theta on side sigma, theta'' = -p_i^2 [(1 + v) sin w + a cos w], or -p_i^2 [(1 + v) w + a] for a slender block; a and v
are in g, linear between the same samples, and 0 after the last one.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

# Speed after an impact below which the block rests, relative to alpha, if the base does not lift it.
STILL = 1e-7
# Angle, relative to alpha, from which a slender block that moves away is taken as overturned.
FAR = 50.0


class Block(NamedTuple):
    """Critical angles, frequency parameters and coefficients of restitution of both sides; first the right one.

    Against a wall only the right side counts: it lifts there only, and an impact turns theta' to -e theta'.
    """

    alpha: tuple[float, float]
    rate: tuple[float, float]
    restitution: tuple[float, float]
    full: bool
    wall: bool


class Base(NamedTuple):
    """Samples of the horizontal and the vertical acceleration in units of g, and the step."""

    push: np.ndarray
    lift: np.ndarray
    step: float

    def at(self, part, time):
        """Both accelerations in part of the motion between two samples."""
        if part >= self.push.size - 1:
            return 0.0, 0.0
        share = time / self.step - part
        return tuple(
            float(each[part] + share * (each[part + 1] - each[part])) for each in (self.push, self.lift)
        )


class Result(NamedTuple):
    """Whether the block overturned, and the largest angle over the critical angle."""

    overturned: bool
    peak: float


def place(side):
    """Return the place of a side: 0 of the right one, 1 of the left one."""
    return 0 if side > 0 else 1


def bend_of(block, side, theta, push, lift):
    """Return theta''."""
    i = place(side)
    w, square = block.alpha[i] * side - theta, block.rate[i] ** 2
    if block.full:
        return -square * ((1.0 + lift) * math.sin(w) + push * math.cos(w))
    return -square * ((1.0 + lift) * w + push)


def lifts(block, push, lift):
    """Return the side to which a block at rest lifts; 0 if it stays."""
    right, left = ((math.tan(each) if block.full else each) * (1.0 + lift) for each in block.alpha)
    return 1 if -push > right else -1 if push > left and not block.wall else 0


def next_lift(block, base, part, time, end):
    """Return the first time up to ``end`` at which the block at rest lifts, and the side; None if it stays."""
    if (side := lifts(block, *base.at(part, time))) != 0:
        return time, side
    if (side := lifts(block, *base.at(part, end))) == 0:
        return None
    low, high = time, end
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if lifts(block, *base.at(part, middle)) else (middle, high)
    return high, side


def arc(block, base, part, side, state, time, end):
    """Follow one side until the base, until the block has overturned, or until ``end``; return SciPy's solution."""
    theta, speed = state
    bend = bend_of(block, side, theta, *base.at(part, time))

    def slope(t, y):
        return y[1], bend_of(block, side, y[0], *base.at(part, t))

    def at_base(t, y):  # divided by the time since an arc left the base, so that its start is no event
        if theta != 0.0:
            return side * y[0]
        if t - time < 1e-9:
            return abs(speed) + max(side * bend, 0.0) * 0.5 * (t - time) + 1e-300
        return side * y[0] / (t - time)

    def at_top(t, y):
        return y[1]

    def fallen(t, y):
        return side * y[0] - (0.5 * math.pi if block.full else FAR * block.alpha[place(side)])

    at_base.terminal = fallen.terminal = True
    at_base.direction, fallen.direction = -1, 1
    events, first = (at_base, at_top, fallen), min(1e-3, 0.5 * (end - time))
    return solve_ivp(
        slope, (time, end), state, "DOP853", rtol=1e-12, atol=1e-15, events=events, first_step=first
    )


def follow(block, base, angle=0.0, velocity=0.0, until=60.0):
    """Return the ``Result`` of a motion from (Theta, Theta'), in units of the right side."""
    alpha = block.alpha[0]
    theta, speed, time, peak = angle * alpha, velocity * alpha, 0.0, abs(angle)
    side = 1 if theta > 0 or (theta == 0 and speed > 0) else -1
    resting = theta == 0.0 == speed
    ends = [*(base.step * np.arange(1, base.push.size)).tolist(), until]
    for part, end in enumerate(ends):
        while time < end:
            if resting:
                found = next_lift(block, base, part, time, end)
                if found is None or found[0] >= end:
                    time = end
                    continue
                (time, side), theta, speed, resting = found, 0.0, 0.0, False
            made = arc(block, base, part, side, (theta, speed), time, end)
            time, theta, speed = float(made.t[-1]), float(made.y[0, -1]), float(made.y[1, -1])
            if made.t_events[2].size:
                return Result(True, math.inf)
            peak = max(peak, abs(theta) / alpha, *[abs(each[0]) / alpha for each in made.y_events[1]])
            if made.t_events[0].size:
                speed *= block.restitution[place(side)]
                theta, side, speed = (0.0, side, -speed) if block.wall else (0.0, -side, speed)
                if abs(speed) < STILL * alpha:
                    side, speed = lifts(block, *base.at(part, time)), 0.0
                    resting = side == 0
    return Result(False, peak)
