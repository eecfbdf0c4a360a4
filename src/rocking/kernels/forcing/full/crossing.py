"""First zero of a polynomial on a step, with the proof that there is none before.

The known zero of order m at the start is divided out. For g = p/t^m and a bound b of |g''|, g cannot vanish within a time x of t if
g + g' x - b x^2/2 > 0. So the search goes from t to t + x. If g' < 0 stays negative until g must have vanished, there is one zero at
most.
"""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.full.series import (
    bend_0,
    bend_1,
    bend_2,
    bend_3,
    divided_0,
    divided_1,
    divided_2,
    divided_3,
)

STEPS = 200
ITERATIONS = 100
ROUNDING = 2.0**-53


@njit(**INTERNAL)
def quotient(a, b, c, order, t):
    """Return g and g' of the polynomial divided by t^``order``."""
    if order == 0:
        return divided_0(a, b, c, t)
    if order == 1:
        return divided_1(a, b, c, t)
    if order == 2:
        return divided_2(a, b, c, t)
    return divided_3(a, b, c, t)


@njit(**INTERNAL)
def bend_of(a, b, c, order, h):
    """Return the bound of |g''| on [0, h]."""
    if order == 0:
        return bend_0(a, b, c, h)
    if order == 1:
        return bend_1(a, b, c, h)
    if order == 2:
        return bend_2(a, b, c, h)
    return bend_3(a, b, c, h)


@njit(**INTERNAL)
def order_at_start(a, b, c):
    """Return the order of the zero at the start of a step: 0 if there is none."""
    if a > 0.0:
        return 0
    if b > 0.0:
        return 1
    return 2 if c[0] > 0.0 else 3


@njit(**INTERNAL)
def bracketed_zero(a, b, c, order, low, high):
    """Return the only zero of g in [low, high], where g falls."""
    x = 0.5 * (low + high)
    for _ in range(ITERATIONS):
        g, dg = quotient(a, b, c, order, x)
        if g > 0.0:
            low = x
        else:
            high = x
        ahead = x - g / dg if dg < 0.0 else 0.5 * (low + high)
        if not low <= ahead <= high:
            ahead = 0.5 * (low + high)
        if abs(ahead - x) <= 2.0 * ROUNDING * ahead:
            return ahead
        x = ahead
    return x


@njit(**INTERNAL)
def first_zero(a, b, c, h):
    """Return the first time in (0, h] at which a + b t + c2 t^2 + ... falls through zero; infinity if there is none."""
    if a == 0.0 and b < 0.0:
        return 0.0
    order = order_at_start(a, b, c)
    bend, t = bend_of(a, b, c, order, h) * (1.0 + 1e-12), 0.0
    for _ in range(STEPS):
        g, dg = quotient(a, b, c, order, t)
        if g <= 0.0:
            return t
        x = 2.0 * g / (math.sqrt(dg * dg + 2.0 * bend * g) - dg) if bend > 0.0 or dg < 0.0 else math.inf
        if t + x >= h:
            return math.inf
        if dg < 0.0 and 2.0 * bend * g < dg * dg:
            end = min(t - 2.0 * g / dg, h)
            if quotient(a, b, c, order, end)[0] > 0.0:
                return math.inf if end == h else end
            return bracketed_zero(a, b, c, order, t, end)
        if t + x == t:
            return t
        t += x
    return t
