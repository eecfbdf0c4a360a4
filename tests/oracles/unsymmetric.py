"""Motion of a block with unequal sides, against a wall, or with a vertical elastic restrainer, by two methods.

They are DOP853 of SciPy with events, and Runge-Kutta of order 4 with located impacts.
Nothing is taken from the package. The equation is that of the angle theta in rad, in units of time 1/p of the right side. With w =
alpha_i sigma - theta on side sigma, theta'' = -p_i^2 (sin w + a cos w), or -p_i^2 (w + a) for a slender block; a is in g. A restrainer
with the ratios kappa of its stiffness and rho of its force adds kappa sin theta + sigma rho sin(alpha) cos(theta/2) to sin w + a cos w,
and kappa theta + sigma rho alpha to w + a.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.integrate import solve_ivp

# Speed below which a block rests, relative to alpha, if the base does not lift it.
STILL = 1e-9
RIGHT_ANGLE = 0.5 * math.pi


class Block(NamedTuple):
    """Critical angles, frequency parameters and coefficients of restitution of both sides; first the right one.

    Against a wall only the right side counts: it lifts there only, and an impact turns theta' to -e theta'.
    """

    alpha: tuple[float, float]
    rate: tuple[float, float]
    restitution: tuple[float, float]
    full: bool
    wall: bool = False
    kappa: float = 0.0  # for equal sides alone, as rho
    rho: float = 0.0


class Base(NamedTuple):
    """Base acceleration: samples in units of g, linear between them, or a cosine; 0 after the last sample or after ``duration``."""

    samples: np.ndarray
    step: float
    amplitude: float
    frequency: float
    phase: float
    duration: float


class Result(NamedTuple):
    """Whether the block overturned, the largest angle over the critical angle of the right side, and the state at the end."""

    overturned: bool
    peak: float
    angle: float
    velocity: float


@njit
def acceleration_in(base, part, time):
    """Base acceleration in part of it between two corners: an interval between samples, or part 0 of a cosine."""
    if base.samples.size == 0:
        return base.amplitude * math.cos(base.frequency * time + base.phase) if part == 0 else 0.0
    if part >= base.samples.size - 1:
        return 0.0
    first, second = base.samples[part], base.samples[part + 1]
    return first + (second - first) * (time / base.step - part)


@njit
def bend_of(block, side, theta, push):
    i = 0 if side > 0 else 1
    w, square = block.alpha[i] * side - theta, block.rate[i] * block.rate[i]
    if block.full:
        tied = block.kappa * math.sin(theta) + side * block.rho * math.sin(block.alpha[i]) * math.cos(
            0.5 * theta
        )
        return -square * (math.sin(w) + push * math.cos(w) + tied)
    return -square * (w + push + block.kappa * theta + side * block.rho * block.alpha[i])


@njit
def level_of(block, i):
    return (math.tan(block.alpha[i]) if block.full else block.alpha[i]) * (1.0 + block.rho)


@njit
def reach_of(block, largest, i):
    """Angle beyond which the block certainly never comes back if it moves away: it lies flat, or theta'' > 0 for ever."""
    if block.full:
        return RIGHT_ANGLE
    return (block.alpha[i] * (1.0 + block.rho) + largest + 1e-9) / (1.0 - block.kappa)


@njit
def lifts(block, push):
    """Side to which a block at rest lifts; 0 if it stays."""
    if -push > level_of(block, 0):
        return 1
    return -1 if push > level_of(block, 1) and not block.wall else 0


@njit
def is_lost(block, largest, side, theta, speed):
    """Whether the block certainly never comes back: it lies flat, or theta'' > 0 for ever."""
    i = 0 if side > 0 else 1
    if block.full:
        return side * theta >= RIGHT_ANGLE
    return side * theta > reach_of(block, largest, i) and side * speed > 0.0


@njit
def rk4(block, base, side, part, theta, speed, time, h):
    a, b = acceleration_in(base, part, time), acceleration_in(base, part, time + 0.5 * h)
    c = acceleration_in(base, part, time + h)
    k1 = bend_of(block, side, theta, a)
    v2 = speed + 0.5 * h * k1
    k2 = bend_of(block, side, theta + 0.5 * h * speed, b)
    v3 = speed + 0.5 * h * k2
    k3 = bend_of(block, side, theta + 0.5 * h * v2, b)
    v4 = speed + h * k3
    k4 = bend_of(block, side, theta + h * v3, c)
    return theta + h * (speed + 2 * v2 + 2 * v3 + v4) / 6, speed + h * (k1 + 2 * k2 + 2 * k3 + k4) / 6


@njit
def by_runge_kutta(block, base, theta, speed, until, longest):
    """Return the fields of the ``Result`` by steps of ``longest`` at most, which end at corners of the base acceleration."""
    largest = abs(base.amplitude)
    for sample in base.samples:
        largest = max(largest, abs(sample))
    time, part, peak, alpha = 0.0, 0, abs(theta), block.alpha[0]
    side = 1 if theta > 0 or (theta == 0 and speed > 0) else -1
    resting = theta == 0.0 and speed == 0.0
    while time < until:
        corner = math.inf
        if base.samples.size > 0:
            corner = (part + 1) * base.step if part < base.samples.size - 1 else math.inf
        elif part == 0:
            corner = base.duration
        end = min(corner, until)
        to_end = end - time <= longest
        h = end - time if to_end else longest
        passes = to_end and end == corner
        if resting:
            if lifts(block, acceleration_in(base, part, time)) == 0:
                if lifts(block, acceleration_in(base, part, time + h)) == 0:
                    time, part = end if to_end else time + h, part + passes
                    continue
                low, high = 0.0, h
                for _ in range(80):
                    middle = 0.5 * (low + high)
                    if lifts(block, acceleration_in(base, part, time + middle)) == 0:
                        low = middle
                    else:
                        high = middle
                time += high
            side = lifts(block, acceleration_in(base, part, time))
            resting, theta, speed = side == 0, 0.0, 0.0
            continue
        ahead, fast = rk4(block, base, side, part, theta, speed, time, h)
        if side * ahead < 0.0:
            low, high = 0.0, h
            for _ in range(80):
                middle = 0.5 * (low + high)
                if side * rk4(block, base, side, part, theta, speed, time, middle)[0] > 0.0:
                    low = middle
                else:
                    high = middle
            _, fast = rk4(block, base, side, part, theta, speed, time, high)
            time, theta, speed = time + high, 0.0, block.restitution[0 if side > 0 else 1] * fast
            if block.wall:
                speed = -speed
            else:
                side = -side
            if abs(speed) < STILL * alpha:
                side, speed = lifts(block, acceleration_in(base, part, time)), 0.0
                resting = side == 0
            continue
        if speed * fast < 0.0:  # a maximum, by bisection of theta'
            low, high = 0.0, h
            for _ in range(60):
                middle = 0.5 * (low + high)
                if speed * rk4(block, base, side, part, theta, speed, time, middle)[1] > 0.0:
                    low = middle
                else:
                    high = middle
            peak = max(peak, abs(rk4(block, base, side, part, theta, speed, time, high)[0]))
        theta, speed, time, part = ahead, fast, end if to_end else time + h, part + passes
        peak = max(peak, abs(theta))
        if is_lost(block, largest, side, theta, speed):
            return True, math.inf, theta / alpha, speed / alpha
    return False, peak / alpha, theta / alpha, speed / alpha


def with_runge_kutta(block, base, angle=0.0, velocity=0.0, until=math.inf, longest=2e-3):
    """Return the ``Result`` of a motion from (Theta, Theta'), in units of the right side, by ``by_runge_kutta``."""
    alpha = block.alpha[0]
    return Result(*by_runge_kutta(block, base, angle * alpha, velocity * alpha, until, longest))


def with_dop853(block, base, angle=0.0, velocity=0.0, until=math.inf):
    """Return the ``Result`` by SciPy's DOP853 from corner to corner of the base acceleration, with events."""
    alpha, sampled = block.alpha[0], base.samples.size > 0
    theta, speed, time, peak = angle * alpha, velocity * alpha, 0.0, abs(angle)
    largest = max(abs(base.amplitude), *np.abs(base.samples).tolist(), 0.0)
    side = 1 if theta > 0 or (theta == 0 and speed > 0) else -1
    resting = theta == 0.0 == speed
    corners = base.step * np.arange(1, base.samples.size) if sampled else np.array([base.duration])
    corners = [float(corner) for corner in corners if corner < until] + [until]
    for number, end in enumerate(corners):

        def push(t, number=number):
            return acceleration_in(base, number, t)

        while time < end:
            if resting:
                fine = np.linspace(time, end, 2 if sampled else 4_000)
                sides = [lifts(block, push(t)) for t in fine.tolist()]
                found = next((k for k, each in enumerate(sides) if each != 0), None)
                if found is None:
                    time = end
                    continue
                low, high = (fine[max(found - 1, 0)], fine[found])
                for _ in range(200):
                    middle = 0.5 * (low + high)
                    low, high = (low, middle) if lifts(block, push(middle)) != 0 else (middle, high)
                resting, side, theta, speed, time = False, sides[found], 0.0, 0.0, float(high)
                if time >= end:
                    continue

            def slope(t, y, side=side, push=push):
                return y[1], bend_of(block, side, y[0], push(t))

            # an arc that leaves the base is divided by the time since then, so that its start is no event
            moving = theta != 0.0
            begun, bend = time, bend_of(block, side, theta, push(time))

            def at_base(t, y, side=side, moving=moving, begun=begun, speed=speed, bend=bend):
                if moving:
                    return side * y[0]
                if t - begun < 1e-9:
                    return abs(speed) + max(side * bend, 0.0) * 0.5 * (t - begun) + 1e-300
                return side * y[0] / (t - begun)

            def at_top(t, y):
                return y[1]

            def fallen(t, y, side=side):
                return side * y[0] - reach_of(block, largest, 0 if side > 0 else 1)

            at_base.terminal = fallen.terminal = True
            at_base.direction, fallen.direction = -1, 1
            made = solve_ivp(
                slope,
                (time, end),
                (theta, speed),
                "DOP853",
                rtol=1e-12,
                atol=1e-15,
                events=(at_base, at_top, fallen),
                first_step=min(1e-3, 0.5 * (end - time)),
            )
            peak = max(peak, *[abs(each[0]) / alpha for each in made.y_events[1]], 0.0)
            time, theta, speed = float(made.t[-1]), float(made.y[0, -1]), float(made.y[1, -1])
            if made.t_events[2].size:
                return Result(True, math.inf, theta / alpha, speed / alpha)
            peak = max(peak, abs(theta) / alpha)
            if made.t_events[0].size:
                speed *= block.restitution[0 if side > 0 else 1]
                theta, side, speed = (0.0, side, -speed) if block.wall else (0.0, -side, speed)
                if abs(speed) < 1e2 * STILL * alpha:
                    side, speed = lifts(block, push(time)), 0.0
                    resting = side == 0
    return Result(False, peak, theta / alpha, speed / alpha)
