"""One step of an arc of the full block: u = angle + velocity t + c2 t^2 + ..., up to a time at which the terms reach rounding level.

The last two terms are about TOLERANCE at the end. The error is then bounded, by Schwarz's lemma. The defect of the polynomial p is
D = p'' - f(p, t), an entire function and O(t^(n-1)). On |t| = r it is at most M. So |D(t)| <= M (t/r)^(n-1), and

    |u - p| <= M (h/r)^(n-1) h^2/(n (n + 1)) cosh(k h),

because the derivative of f by w is at most k^2 = r^2 sqrt(1 + a^2) <= r^2 (1 + a), where r is the ``rate`` of the side. Here a
bounds the acceleration on |t| = h. And cosh x is at most exp(x^2/2) <= 1/(1 - x^2/2).
"""

import math
from typing import NamedTuple

from rocking.kernels import contract
from rocking.kernels.arc.arc import Transfer
from rocking.kernels.arc.full_series import ORDER, SHORT_ORDER, divided_1, short_divided_1, short_sizes, sizes
from rocking.kernels.contract import (
    acceleration_near,
    acceleration_of,
    largest_near,
    largest_within,
    series_from,
    smooth_time,
    transfer_series,
    weight_of,
)
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import (
    exponential_bound,
    fma,
    rough_exp2,
    rough_log2,
    sine_and_cosine,
)
from rocking.kernels.system import Full, side_of

# With it most bounds hold at once.
TOLERANCE = 6e-18
LOG_TOLERANCE = math.log2(TOLERANCE)
# Limit of the bound of the error of u; a step that exceeds it is shortened.
ERROR = 1e-16
# Up to a corner of the base acceleration that is nearer than this, a short series is tried first.
NEAR = 0.1
# Distance from the base beyond which no rounding error of a step counts.
CLEAR = 1e-9
# A step is not shortened further: its bound is infinite or NaN.
SHORTEST = 1e-300
# Part of a step that is kept if its bound is too large: 34 % of the bound is left.
SHORTER = 0.95


class Truncation(NamedTuple):
    """Order n of a series, the radius r/h of the circle of its bound, and (r/h)^(1 - n)."""

    order: int
    radius: float
    ratio: float


# With these radii the bounds are least, or nearly so, over all base motions.
LONG = Truncation(ORDER, 7.0, 7.0 ** (1.0 - ORDER))
SHORT = Truncation(SHORT_ORDER, 40.0, 40.0 ** (1.0 - SHORT_ORDER))


class Step(NamedTuple):
    """Polynomial of u, and the time up to which it holds."""

    angle: float
    velocity: float
    series: tuple[float, ...]
    length: float
    to_corner: bool  # whether the step ends at a corner of the base acceleration
    short: bool  # whether the series is short
    sine: float  # of w = alpha (1 - u) at the start
    cosine: float


@kernel(inline=True)
def log_time_of_term(coefficient, order):
    """Return about the logarithm of the time at which a term reaches the tolerance; 0 if it is below it at the time 1."""
    return (LOG_TOLERANCE - rough_log2(max(abs(coefficient), TOLERANCE))) * (1.0 / order)


@kernel(inline=True)
def ends_at_corner(c, corner, order):
    """Return whether the last two terms are below the tolerance up to a corner, which spares their logarithms."""
    power = corner ** (order - 1)
    return abs(c[order - 3]) * power <= TOLERANCE and abs(c[order - 2]) * (power * corner) <= TOLERANCE


@body(contract.excess_push, Full, inline=True)
def no_excess_push(p):
    """Provide ``contract.excess_push``."""
    return 0.0


@body(contract.stiffness, Full, inline=True)
def stiffness(p, side, sine, cosine, drive):
    """Provide ``contract.stiffness``, W cos w - sigma alpha a sin w with the weight W."""
    return weight_of(p, drive) * cosine - side * p.block.critical_angle * acceleration_of(p, drive) * sine


@body(contract.growth_of, Full, inline=True)
def growth_of(p, stiffness):
    """Provide ``contract.growth_of``: the block falls away from its unstable balance."""
    return stiffness


@body(contract.acceleration_near, Full, inline=True)
def acceleration_near_place(p, side, sine, change, drive, radius):
    """Provide ``contract.acceleration_near``: |sin w| and |cos w| are at most exp |w - w0|."""
    push = side_of(p.block, side).stiffness * (1.0 + p.block.critical_angle * largest_near(p, drive, radius))
    return push * exponential_bound(change)


@kernel(inline=True)
def error_bound(p, side, velocity, series, sine, h, drive, truncation):
    """Return the bound of the module's text of |u - p| up to a time h of a step, which starts where r^2 sin w = ``sine``.

    M is at most w'' of the polynomial and the acceleration that it should have, on the circle.
    """
    alpha, n, radius = p.block.critical_angle, truncation.order, truncation.radius * h
    stiffness = side_of(p.block, side).stiffness
    if n == SHORT_ORDER:
        change, bend = short_sizes(velocity, series, radius)
    else:
        change, bend = sizes(velocity, series, radius)
    largest = alpha * bend + acceleration_near(p, side, sine, alpha * change, drive, radius)
    half = 0.5 * (stiffness * (1.0 + alpha * largest_near(p, drive, h))) * h * h
    if half >= 1.0:
        return math.inf
    return largest * truncation.ratio * h * h / (alpha * (n * (n + 1)) * (1.0 - half))


@kernel(inline=True)
def lean_of(block, side, angle):
    """Return the sine and cosine of w = alpha (s - u), times r^2: the series, linear in both, are then those of the side."""
    own = side_of(block, side)
    if angle == 0.0:
        return own.sine, own.cosine
    sine, cosine = sine_and_cosine(block.critical_angle * (own.ratio - angle))
    return own.stiffness * sine, own.stiffness * cosine


@kernel
def series_at(p, side, angle, velocity, sine, cosine, drive, short):
    """Return the series from an instant on. A block that starts from rest leaves the base, or its brace, also to rounding."""
    c = series_from(p, side, -p.block.critical_angle * velocity, sine, cosine, drive, short)
    if velocity == 0.0:
        if angle == 0.0:
            return (max(c[0], 0.0), *c[1:])
        if angle == p.block.brace_angle:
            return (min(c[0], 0.0), *c[1:])
    return c


@kernel
def step_from(p, side, angle, velocity, drive):
    """Return the step of an arc from an instant on."""
    sine, cosine = lean_of(p.block, side, angle)
    corner = smooth_time(p, drive)
    if corner < NEAR:
        c = series_at(p, side, angle, velocity, sine, cosine, drive, True)
        near = ends_at_corner(c, corner, SHORT_ORDER)
        if near and error_bound(p, side, velocity, c, sine, corner, drive, SHORT) <= ERROR:
            return Step(angle, velocity, c, corner, True, True, sine, cosine)
    c = series_at(p, side, angle, velocity, sine, cosine, drive, False)
    if corner < 1.0 and ends_at_corner(c, corner, ORDER):
        to_corner, length = True, corner
    else:
        length = rough_exp2(
            min(log_time_of_term(c[ORDER - 2], ORDER), log_time_of_term(c[ORDER - 3], ORDER - 1))
        )
        to_corner, length = corner <= length, min(length, corner)
    while not error_bound(p, side, velocity, c, sine, length, drive, LONG) <= ERROR and length > SHORTEST:
        to_corner, length = False, SHORTER * length
    return Step(angle, velocity, c, length, to_corner, False, sine, cosine)


@kernel
def transfer_in(p, side, step, drive, t):
    """Return the ``Transfer`` from the start of a step to a time t in it."""
    slope = -p.block.critical_angle * step.velocity
    x, y = transfer_series(p, side, slope, step.sine, step.cosine, drive)
    by_angle, by_angle_rate = divided_1(1.0, 0.0, x, t)
    by_velocity, by_velocity_rate = divided_1(0.0, 1.0, y, t)
    return Transfer(
        1.0 + by_angle * t,
        by_velocity * t,
        by_angle + by_angle_rate * t,
        by_velocity + by_velocity_rate * t,
    )


@kernel(inline=True)
def state_in(step, t):
    """Return u - u0 and u' a time t into a step."""
    if step.short:
        slope, bend = short_divided_1(step.angle, step.velocity, step.series, t)
    else:
        slope, bend = divided_1(step.angle, step.velocity, step.series, t)
    return slope * t, fma(bend, t, slope)


@kernel(inline=True)
def cannot_reach_base(p, side, step, drive):
    """Return whether the block is so far from the base that it cannot reach it within a step: |u''| <= r^2 (1/alpha + |a|)."""
    alpha, h = p.block.critical_angle, step.length
    push = side_of(p.block, side).stiffness * (1.0 + alpha * largest_within(p, drive, h))
    return alpha * (step.angle + min(step.velocity, 0.0) * h - CLEAR) > 0.5 * push * h * h
