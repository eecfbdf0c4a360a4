"""Elementary functions of an arc, to full relative accuracy for arbitrarily short arcs.

For short arcs the standard functions lose digits by cancellation in ``cosh t - 1``, ``sinh t - t``, ``1 - cos
x`` and ``x - sin x``. Short arguments are evaluated by their Taylor series, which avoids this. Long arguments
use exponentials, and the sine and cosine of an argument reduced by pi/2 in three parts.
"""

import math

import numpy as np

from rocking.kernels.compile_options import KERNEL_INLINE
from rocking.kernels.deferred import intrinsic, njit

# Coefficients by increasing power of the squared argument: 1/3!, 1/5!, ... and 1/4!, 1/6!, .... The first
# omitted term is below 2**-55 of the sum at 2.
ODD = tuple(1.0 / math.factorial(k) for k in range(3, 27, 2))
EVEN = tuple(1.0 / math.factorial(k) for k in range(4, 28, 2))
SHORT = 2.0
# Up to here four terms suffice: the first omitted one is below 2**-54 of the sum.
BRIEF = 0.0625
# Up to here 1/(1 - x) bounds exp x closely enough: 1.22 times.
NEAR_ONE = 0.5

# pi/2 in three parts. The first two have 33 bits, so their products with the quadrant number are exact up to
# 2**20 quadrants.
HALF_PI = (1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21)
TWO_OVER_PI = 2.0 / math.pi
EIGHTH_TURN = 0.25 * math.pi


@intrinsic
def fma(typingctx, a, b, c):
    """Return ``a*b + c`` with one rounding."""
    from numba import types

    def generate(context, builder, signature, arguments):
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), generate


@njit(**KERNEL_INLINE)
def series(q, c):
    """Return the sum of c[k] q**k for 12 coefficients, in two interleaved chains (half the latency of one)."""
    q2 = q * q
    even = c[10]
    odd = c[11]
    for k in range(8, -1, -2):
        even = fma(even, q2, c[k])
        odd = fma(odd, q2, c[k + 1])
    return fma(odd, q, even)


@njit(**KERNEL_INLINE)
def short_series(q, c):
    """Return the sum of the first 8 terms, enough for |argument| <= pi/4."""
    q2 = q * q
    even = fma(fma(fma(c[6], q2, c[4]), q2, c[2]), q2, c[0])
    odd = fma(fma(fma(c[7], q2, c[5]), q2, c[3]), q2, c[1])
    return fma(odd, q, even)


@njit(**KERNEL_INLINE)
def size(x, y):
    """Return the length of (x, y) in a third of the time of ``math.hypot``; the squares must not overflow."""
    return math.sqrt(x * x + y * y)


@njit(**KERNEL_INLINE)
def hyperbolic(t):
    """Evaluate the hyperbolic functions of t >= 0 without cancellation.

    Returns
    -------
    tuple of (float, float, float, float)
        sinh t and cosh t - 1.
        sinh t - t and cosh t - 1 - t**2/2.
    """
    q = t * t
    if t < SHORT:
        excess = q * t * series(q, ODD)
        higher = q * q * series(q, EVEN)
        return t + excess, fma(0.5, q, higher), excess, higher
    grown = 0.5 * math.exp(t)
    shrunk = 0.25 / grown
    sinh = grown - shrunk
    versinh = (grown - 1.0) + shrunk
    return sinh, versinh, sinh - t, fma(-0.5, q, versinh)


@njit(**KERNEL_INLINE)
def brief_hyperbolic(t):
    """Evaluate sinh t, cosh t - 1 and sinh t - t of t >= 0 as ``hyperbolic`` does, faster up to BRIEF."""
    if t > BRIEF:
        sinh, versinh, excess, _ = hyperbolic(t)
        return sinh, versinh, excess
    q = t * t
    excess = q * t * fma(fma(fma(ODD[3], q, ODD[2]), q, ODD[1]), q, ODD[0])
    versinh = q * fma(fma(fma(fma(EVEN[3], q, EVEN[2]), q, EVEN[1]), q, EVEN[0]), q, 0.5)
    return t + excess, versinh, excess


@njit(**KERNEL_INLINE)
def rough_hyperbolic(t):
    """Evaluate sinh t and cosh t of t >= 0 for estimates: the relative error is below 0.002."""
    if t > SHORT:
        grown = 0.5 * math.exp(t)
        shrunk = 0.25 / grown
        return grown - shrunk, grown + shrunk
    q = t * t
    sinh = t * fma(fma(fma(ODD[2], q, ODD[1]), q, ODD[0]), q, 1.0)
    return sinh, fma(fma(fma(EVEN[1], q, EVEN[0]), q, 0.5), q, 1.0)


@njit(**KERNEL_INLINE)
def sine_and_cosine(x):
    """Return sin x and cos x, up to pi/4 in half the time of the standard functions."""
    if abs(x) > EIGHTH_TURN:
        return math.sin(x), math.cos(x)
    q = x * x
    return fma(-x * q, short_series(-q, ODD), x), fma(-q, fma(-q, short_series(-q, EVEN), 0.5), 1.0)


@njit(**KERNEL_INLINE)
def exponential_bound(x):
    """Return an upper bound of exp x for x >= 0: at most 1.3 times as large up to 5.

    exp(z) <= 1/(1 - z). From NEAR_ONE on z = x/64, which is then squared six times.
    """
    if x >= 32.0:
        return math.inf
    if x < NEAR_ONE:
        return 1.0 / (1.0 - x)
    once = 1.0 / (1.0 - x / 64.0)
    for _ in range(6):
        once = once * once
    return once


@njit(**KERNEL_INLINE)
def quarter_turn(x, correction):
    """Evaluate sine and cosine of ``x + correction``, for 0 <= x up to 10**6.

    The ``correction`` is about one ulp of x.

    Returns
    -------
    tuple of (float, float, float, int)
        sin, cos, 1 - |cos| and the quadrant (0 to 3).
        In the even quadrants, around the multiples of pi, 1 - |cos| is accurate relative to its size.
    """
    # ``math.floor`` converts to an integer and back
    quadrant = np.floor(x * TWO_OVER_PI + 0.5)
    high = fma(-quadrant, HALF_PI[0], x)
    tail = fma(-quadrant, HALF_PI[1], correction)
    r = high + tail
    tail = fma(-quadrant, HALF_PI[2], tail - (r - high))
    q = r * r
    excess = r * q * short_series(-q, ODD)
    versine = q * fma(-q, short_series(-q, EVEN), 0.5)
    sine = r + (tail * (1.0 - versine) - excess)
    versine += r * tail
    cosine = 1.0 - versine
    k = np.int64(quadrant) & 3
    if k & 1:
        sine, cosine = cosine, sine
        versine = 1.0 - abs(cosine)
    if k & 2:
        sine = -sine
    if (k + 1) & 2:
        cosine = -cosine
    return sine, cosine, versine, k


@njit(**KERNEL_INLINE)
def circular(rate, t):
    """Evaluate the circular functions of x = rate * t >= 0 without cancellation.

    The product is computed to twice double precision.

    Returns
    -------
    tuple of (float, float, float, float)
        sin x and 1 - cos x.
        x - sin x and, for short x only, x**2/2 - 1 + cos x.
    """
    x = rate * t
    if x < SHORT:
        q = x * x
        lag = q * x * series(-q, ODD)
        higher = q * q * series(-q, EVEN)
        return x - lag, fma(0.5, q, -higher), lag, higher
    sine, cosine, versine, k = quarter_turn(x, fma(rate, t, -x))
    if k != 0:
        versine = 1.0 - cosine
    return sine, versine, x - sine, 0.0


@njit(**KERNEL_INLINE)
def direction(angle):
    """Evaluate sine and cosine of an angle of either sign.

    Returns
    -------
    tuple of (float, float, float, bool)
        sin, cos and 1 - |cos|.
        Whether 1 - |cos| is accurate relative to its size.
    """
    sine, cosine, versine, k = quarter_turn(abs(angle), 0.0)
    return (-sine if angle < 0.0 else sine), cosine, versine, k & 1 == 0
