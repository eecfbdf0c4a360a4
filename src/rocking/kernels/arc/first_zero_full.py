"""First zero of a polynomial on a step, with the proof that there is none before.

The known zero of order m at the start is divided out. For g = p/t^m and a bound b of |g''|, g cannot vanish within a time x of t if
g + g' x - b x^2/2 > 0. So the search goes from t to t + x. If g' < 0 stays negative until g must have vanished, there is one zero at
most.
"""

import math

from rocking.kernels.arc.full_series import (
    bend_0,
    bend_1,
    bend_2,
    bend_3,
    divided_0,
    divided_1,
    divided_2,
    divided_3,
    shifted,
)
from rocking.kernels.library.kernel import kernel

# Steps of a search before the polynomial is written in a later time.
STEPS = 50
ITERATIONS = 100
ROUNDING = 2.0**-53
# Factor on a bound, for its rounding.
MARGIN = 1.0 + 1e-12
# Length of a window relative to that of its proof, or to the window before.
NARROWER, WIDER = 6.0, 2.0


@kernel
def quotient(a, b, c, order, t):
    """Return g and g' of the polynomial divided by t^``order``."""
    if order == 0:
        return divided_0(a, b, c, t)
    if order == 1:
        return divided_1(a, b, c, t)
    if order == 2:
        return divided_2(a, b, c, t)
    return divided_3(a, b, c, t)


@kernel
def bend_of(a, b, c, order, h):
    """Return the bound of |g''| on [0, h]."""
    if order == 0:
        return bend_0(a, b, c, h)
    if order == 1:
        return bend_1(a, b, c, h)
    if order == 2:
        return bend_2(a, b, c, h)
    return bend_3(a, b, c, h)


@kernel
def order_at_start(a, b, c):
    """Return the order of the zero at the start of a step: 0 if there is none."""
    if a > 0.0:
        return 0
    if b > 0.0:
        return 1
    return 2 if c[0] > 0.0 else 3


@kernel
def leading(a, b, c, order):
    """Return g and g' at the start."""
    if order == 0:
        return a, b
    if order == 1:
        return b, c[0]
    if order == 2:
        return c[0], c[1]
    return c[1], c[2]


@kernel
def between(low, start, high, end):
    """Return a guess of the zero in [low, high] from (g, g') at both ends: the cubic for the time as a function of g.

    If g does not fall at both ends, the guess is the middle.
    """
    (g, dg), (g_end, dg_end) = start, end
    if not (dg < 0.0 and dg_end < 0.0):
        return 0.5 * (low + high)
    span = g - g_end
    share = g / span
    rest = 1.0 - share
    guess = rest * rest * ((1.0 + 2.0 * share) * low - share * span / dg)
    guess += share * share * ((1.0 + 2.0 * rest) * high + rest * span / dg_end)
    return guess if low < guess < high else 0.5 * (low + high)


@kernel
def bracketed_zero(a, b, c, order, bend, low, high, x):
    """Return the only zero of g in [low, high], where g falls and |g''| is at most ``bend``, from a guess x.

    Newton's step d from x leaves an error of at most bend d^2/(2 |g'(x)|), to its first order. Below rounding no further step is
    needed.
    """
    for _ in range(ITERATIONS):
        g, dg = quotient(a, b, c, order, x)
        if g > 0.0:
            low = x
        else:
            high = x
        ahead = x - g / dg if dg < 0.0 else 0.5 * (low + high)
        if not low <= ahead <= high:
            ahead = 0.5 * (low + high)
        step = abs(ahead - x)
        if step <= 2.0 * ROUNDING * ahead or bend * step * step <= -ROUNDING * ahead * dg:
            return ahead
        x = ahead
    return x


@kernel
def search(a, b, c, order, h):
    """Search for the first time in (0, h] at which g falls through zero; it is positive just after the start.

    The bound of |g''| holds up to the end of a window. If a proof reaches a small part of the window only, the window is
    shortened, which makes the bound smaller. From the end of a window the next one begins.

    Returns
    -------
    tuple of (bool, float)
        Whether the search is complete: if not, there is no zero up to the time.
        The time, infinite if there is no zero.
    """
    t, end = 0.0, h
    bend = bend_of(a, b, c, order, end) * MARGIN
    for _ in range(STEPS):
        g, dg = leading(a, b, c, order) if t == 0.0 else quotient(a, b, c, order, t)
        if g <= 0.0:
            return True, t
        x, root = math.inf, math.sqrt(dg * dg + 2.0 * bend * g)
        if dg < 0.0:
            x = 2.0 * g / (root - dg)
        elif bend > 0.0:
            x = (root + dg) / bend
        if t + x >= end:
            if end == h:
                return True, math.inf
            t, end = end, min(WIDER * end, h)
            bend = bend_of(a, b, c, order, end) * MARGIN
            continue
        if dg < 0.0 and 2.0 * bend * g < dg * dg:  # g falls as far as its zero, or the end of the window
            low = min(t - 2.0 * g / dg, end)
            there = quotient(a, b, c, order, low)
            if there[0] <= 0.0:
                guess = between(t, (g, dg), low, there)
                return True, bracketed_zero(a, b, c, order, bend, t, low, guess)
            if low < end:
                return True, low
            if end == h:
                return True, math.inf
            t = end
            continue
        if t + x == t:
            return True, t
        if NARROWER * x < end - t:
            end = t + NARROWER * x
            bend = bend_of(a, b, c, order, end) * MARGIN
        t += x
    return False, t


@kernel
def first_zero_of_step(a, b, c, h):
    """Return the first time in (0, h] at which a + b t + c2 t^2 + ... falls through zero; infinity if there is none.

    Where the search advances slowly, the polynomial is expanded again, in the time since then. A start below zero that falls is a
    zero at the end of the step before, to rounding.
    """
    if a <= 0.0 and b < 0.0:
        return 0.0
    order, passed = order_at_start(a, b, c), 0.0
    while True:
        complete, t = search(a, b, c, order, h - passed)
        if complete:
            return passed + t
        a, b, c = shifted(a if order == 0 else 0.0, b if order < 2 else 0.0, c[0] if order < 3 else 0.0, c, t)
        order, passed = 0, passed + t
        if a <= 0.0:
            return passed
