"""The elementary functions of an arc without a branch, so that the compiler computes them for many blocks at once.

As accurate as those of ``elementary``: short arguments through their Taylor series, long ones through an
exponential and a sine and cosine of reduced arguments; both are computed and one is chosen.
"""

import math

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic

from .elementary import EVEN, HALF_PI, ODD, SHORT, TWO_OVER_PI, fma, series, short_series

# Where the compiler may not choose which product it fuses with a sum, a result hangs neither on the width of the
# machine's vectors nor on what was compiled together: what is fused is written so.
EXACT = dict(
    nogil=True,
    error_model="numpy",
    fastmath={"nsz"},
    no_cfunc_wrapper=True,
    no_cpython_wrapper=True,
    _nrt=False,
)
EXACT_INNER = dict(EXACT, forceinline=True)

# Added to a number and taken off again it rounds to an integer, which its last bits hold.
ROUNDER = 1.5 * 2.0**52
PER_LN2 = 1.0 / math.log(2.0)
# More than ``logarithms_of_ratios`` are wrong by.
ROUGHLY = 2e-6
# ln 2 in two parts; the first has 32 bits.
LN2 = (0.6931471803691238, 1.9082149292705877e-10)
EXPONENT = 52
ONE = 1023 << EXPONENT
# The bits of 2**-1/2, and of ROUNDER.
ROOT_HALF = int(np.float64(0.5**0.5).view(np.int64))
INTEGER = int(np.float64(ROUNDER).view(np.int64))


@intrinsic
def choose(typingctx, condition, yes, no):
    """``yes if condition else no`` of two numbers at hand, without a branch."""

    def generate(context, builder, signature, arguments):
        return builder.select(*arguments)

    return yes(types.boolean, yes, yes), generate


@intrinsic
def bits_of(typingctx, x):
    """The bits of a number as an integer."""

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), generate


@intrinsic
def from_bits(typingctx, n):
    """The number with these bits."""

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.DoubleType())

    return types.float64(types.int64), generate


@njit(**EXACT_INNER)
def both_exponentials(t):
    """(e^t, e^-t) for abs(t) < 700: even and odd part of the reduced argument serve both."""
    shifted = fma(t, PER_LN2, ROUNDER)
    k = shifted - ROUNDER
    r = fma(-k, LN2[1], fma(-k, LN2[0], t))
    q = r * r
    even = q * fma(q, short_series(q, EVEN), 0.5)
    odd = fma(r * q, short_series(q, ODD), r)
    power = bits_of(shifted) << EXPONENT
    return (1.0 + (even + odd)) * from_bits(ONE + power), (1.0 + (even - odd)) * from_bits(ONE - power)


@njit(**EXACT_INNER)
def hyperbolic(t):
    """(sinh t, cosh t - 1, sinh t - t, cosh t - 1 - t**2/2) for t >= 0."""
    q = t * t
    excess = q * t * series(q, ODD)
    higher = q * q * series(q, EVEN)
    grown, shrunk = both_exponentials(t)
    sinh = 0.5 * grown - 0.5 * shrunk
    versinh = (0.5 * grown - 1.0) + 0.5 * shrunk
    short = t < SHORT
    return (
        choose(short, t + excess, sinh),
        choose(short, fma(0.5, q, higher), versinh),
        choose(short, excess, sinh - t),
        choose(short, higher, fma(-0.5, q, versinh)),
    )


@njit(**EXACT_INNER)
def circular(rate, t):
    """(sin x, 1 - cos x, x - sin x, for short x also x**2/2 - 1 + cos x) of x = rate * t, 0 <= x up to 10**6."""
    x = rate * t
    q = x * x
    short_lag = q * x * series(-q, ODD)
    higher = q * q * series(-q, EVEN)
    shifted = fma(x, TWO_OVER_PI, ROUNDER)
    quadrant = shifted - ROUNDER
    high = fma(-quadrant, HALF_PI[0], x)
    tail = fma(-quadrant, HALF_PI[1], fma(rate, t, -x))
    r = high + tail
    tail = fma(-quadrant, HALF_PI[2], tail - (r - high))
    p = r * r
    excess = r * p * short_series(-p, ODD)
    versine = p * fma(-p, short_series(-p, EVEN), 0.5)
    odd_part = r + (tail * (1.0 - versine) - excess)
    even_part = 1.0 - (versine + r * tail)
    k = bits_of(shifted)
    swapped = (k & 1) != 0
    sine = choose(swapped, even_part, odd_part)
    cosine = choose(swapped, odd_part, even_part)
    sine = choose((k & 2) != 0, -sine, sine)
    cosine = choose(((k + 1) & 2) != 0, -cosine, cosine)
    short = x < SHORT
    return (
        choose(short, x - short_lag, sine),
        choose(short, fma(0.5, q, -higher), 1.0 - cosine),
        choose(short, short_lag, x - sine),
        higher,
    )


@njit(**EXACT_INNER)
def parts(x):
    """(m, k) with x = m * 2**k of a normal x > 0; m lies between 2**-1/2 and 2**1/2 whatever x is, NaN too."""
    bits = bits_of(x)
    exponent = (bits - ROOT_HALF) >> EXPONENT
    return from_bits(bits - (exponent << EXPONENT)), from_bits(exponent + INTEGER) - ROUNDER


@njit(**EXACT_INNER)
def logarithms_of_ratios(a, b, c, d):
    """ln(a/b) and ln(c/d) of normal numbers above 0, to 1.2e-6 (``ROUGHLY``); one division, the slowest step, serves both.

    Either is right whatever the numbers of the other are.
    """
    (a, i), (b, j) = parts(a), parts(b)
    (c, k), (d, n) = parts(c), parts(d)
    per = 1.0 / ((a + b) * (c + d))
    return logarithm(i - j, (a - b) * (c + d) * per), logarithm(k - n, (c - d) * (a + b) * per)


@njit(**EXACT_INNER)
def logarithm(power, s):
    """power ln 2 + 2 artanh s for |s| <= 1/3, from five terms."""
    q = s * s
    odd = fma(q, fma(q, fma(q, fma(q, 1.0 / 9.0, 1.0 / 7.0), 0.2), 1.0 / 3.0), 1.0)
    return fma(power, LN2[0], 2.0 * s * odd)
