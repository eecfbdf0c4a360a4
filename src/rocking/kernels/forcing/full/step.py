"""One step of an arc: u = angle + velocity t + c2 t^2 + ..., up to a time at which the terms reach rounding level.

The last two terms are below TOLERANCE at the end. The error is then bounded, by Schwarz's lemma. The defect of the polynomial p is
D = p'' - f(p, t), an entire function and O(t^(n-1)). On |t| = r it is at most M. So |D(t)| <= M (t/r)^(n-1), and

    |u - p| <= M (h/r)^(n-1) h^2/(n (n + 1)) cosh(sqrt(1 + a^2) h).

Exponentials bound the hyperbolic functions.
"""

import math
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.full.base import largest_near, series_from, smooth_time
from rocking.kernels.forcing.full.series import ORDER, divided_1, sizes

TOLERANCE = 2e-17
LONGEST = 1.0
# Limit of the bound of the error of u; a step that exceeds it is shortened.
ERROR = 1e-16
# Radius of the circle of the bound, in steps.
RADIUS = 4.0


class Step(NamedTuple):
    """Polynomial of u, and the time up to which it holds."""

    angle: float
    velocity: float
    series: tuple[float, ...]
    length: float
    to_corner: bool  # whether the step ends at a corner of the base acceleration


@njit(**INTERNAL_INLINE)
def time_of_term(coefficient, order):
    """Return the time at which a term reaches the tolerance."""
    size = abs(coefficient)
    return math.exp(math.log(TOLERANCE / size) / order) if size > TOLERANCE else LONGEST


@njit(**INTERNAL)
def error_bound(p, velocity, series, h, drive):
    """Return the bound of |u - p| up to a time h of a step."""
    alpha = p.block.critical_angle
    radius = RADIUS * h
    y, z = sizes(velocity, series, radius)
    y, z = alpha * y, alpha * z
    base = alpha * largest_near(p, drive, radius)
    largest = z + (1.0 + base) * math.exp(y)
    ratio = (1.0 / RADIUS) ** (ORDER - 1)
    stiffness = math.sqrt(1.0 + base * base)
    return largest / alpha * ratio * h * h / (ORDER * (ORDER + 1)) * math.exp(stiffness * h)


@njit(**INTERNAL)
def step_from(p, side, angle, velocity, drive):
    """Return the step of an arc from an instant on."""
    block = p.block
    sine, cosine = block.sine, block.cosine
    if angle != 0.0:
        w = block.critical_angle * (1.0 - angle)
        sine, cosine = math.sin(w), math.cos(w)
    c = series_from(p, side, -block.critical_angle * velocity, sine, cosine, drive)
    length = min(time_of_term(c[ORDER - 2], ORDER), time_of_term(c[ORDER - 3], ORDER - 1), LONGEST)
    corner = smooth_time(p, drive)
    to_corner, length = corner <= length, min(length, corner)
    while error_bound(p, velocity, c, length, drive) > ERROR:
        to_corner, length = False, 0.5 * length
    return Step(angle, velocity, c, length, to_corner)


@njit(**INTERNAL_INLINE)
def state_in(step, t):
    """Return u - u0 and u' a time t into a step."""
    slope, bend = divided_1(step.angle, step.velocity, step.series, t)
    return slope * t, slope + bend * t
