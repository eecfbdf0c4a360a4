"""Branch-free elementary functions of an arc, which the compiler vectorises over many blocks.

The functions of an arc are series of a reduced argument. If the reduction leaves a short argument unchanged,
the series also give the differences, such as sinh t - t, to full relative accuracy. For longer arguments
these differences are formed by subtraction.
"""

import math

import numpy as np

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import intrinsic, njit
from rocking.kernels.numerics.elementary import HALF_PI, TWO_OVER_PI, fma

# Adding and subtracting this rounds a number to an integer, which is then held in its last bits.
ROUNDER = 1.5 * 2.0**52
PER_LN2 = 1.0 / math.log(2.0)
# Times and angles up to these, below ln 2 / 2 and pi / 4, are not reduced.
SHORT_TIME, SHORT_ANGLE = 0.34, 0.78
# Upper bound on the error of ``logarithms_of_ratios``.
ROUGHLY = 6e-6
# ln 2 in two parts; the first has 32 bits.
LN2 = (0.6931471803691238, 1.9082149292705877e-10)
EXPONENT = 52
HALF, ONE = 1022 << EXPONENT, 1023 << EXPONENT
# Bit patterns of 2**-1/2 and of ROUNDER.
ROOT_HALF = int(np.float64(0.5**0.5).view(np.int64))
INTEGER = int(np.float64(ROUNDER).view(np.int64))

# Series in powers of the squared argument: Taylor series shortened by Lanczos's economisation. On the short
# range of the reduced argument they are as accurate as longer Taylor series. Those of sinh and sin begin with
# the third power, those of cosh and cos with the fourth.
SINH_SERIES = (
    0.16666666666666666,
    0.008333333333330063,
    0.00019841269863041792,
    2.755726847865102e-06,
    2.510037652317223e-08,
)
COSH_SERIES = (
    0.041666666666666664,
    0.0013888888888886554,
    2.4801587317135943e-05,
    2.755728298301917e-07,
    2.0911230161316327e-09,
)
SIN_SERIES = (
    0.16666666666666663,
    -0.00833333333333095,
    0.0001984126983675979,
    -2.7557316103105014e-06,
    2.5051131947374597e-08,
    -1.5918135932869772e-10,
)
COS_SERIES = (
    0.041666666666666664,
    -0.0013888888888887398,
    2.4801587298766363e-05,
    -2.7557317272036996e-07,
    2.087614632531677e-09,
    -1.1382636115964061e-11,
)
# (ln(1 + s) - ln(1 - s))/s in powers of s**2. Here s = (a - b)/(a + b); a and b differ by at most a factor of
# two.
LOGARITHM = (
    2.0000143422285115,
    0.664383255352155,
    0.45293753899232775,
)


@intrinsic
def choose(typingctx, condition, yes, no):
    """Return ``yes if condition else no`` without a branch; both numbers are already computed."""
    from numba import types

    def generate(context, builder, signature, arguments):
        return builder.select(*arguments)

    return yes(types.boolean, yes, yes), generate


@intrinsic
def bits_of(typingctx, x):
    """Return the bits of a number as an integer."""
    from llvmlite import ir
    from numba import types

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), generate


@intrinsic
def from_bits(typingctx, n):
    """Return the number with the given bits."""
    from llvmlite import ir
    from numba import types

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.DoubleType())

    return types.float64(types.int64), generate


@njit(**INTERNAL_INLINE)
def five_terms(q, c):
    """Return the sum of c[k] q**k for 5 coefficients, in two independent chains."""
    q2 = q * q
    return fma(fma(c[3], q2, c[1]), q, fma(fma(c[4], q2, c[2]), q2, c[0]))


@njit(**INTERNAL_INLINE)
def six_terms(q, c):
    """Return the sum of c[k] q**k for 6 coefficients, in two independent chains."""
    q2 = q * q
    return fma(fma(fma(c[5], q2, c[3]), q2, c[1]), q, fma(fma(c[4], q2, c[2]), q2, c[0]))


@njit(**INTERNAL_INLINE)
def reduced_exponential(t, one):
    """Reduce t = r + k ln 2 with abs(r) <= ln 2 / 2, and evaluate the hyperbolic functions of r.

    ``one`` holds the bits of the number by which both powers of two are multiplied.

    Returns
    -------
    tuple of seven floats
        sinh r and cosh r - 1.
        sinh r - r and cosh r - 1 - r**2/2.
        k, 2**k and 2**-k.
    """
    shifted = fma(t, PER_LN2, ROUNDER)
    k = shifted - ROUNDER
    r = fma(-k, LN2[1], fma(-k, LN2[0], t))
    q = r * r
    higher, excess = q * q * five_terms(q, COSH_SERIES), r * q * five_terms(q, SINH_SERIES)
    power = bits_of(shifted) << EXPONENT
    return r + excess, fma(0.5, q, higher), excess, higher, k, from_bits(one + power), from_bits(one - power)


@njit(**INTERNAL_INLINE)
def both_exponentials(t):
    """Return e^t and e^-t for abs(t) < 700, from the even and odd parts of one reduced argument."""
    odd, even, _, _, _, up, down = reduced_exponential(t, ONE)
    return (1.0 + (even + odd)) * up, (1.0 + (even - odd)) * down


@njit(**INTERNAL_INLINE)
def hyperbolic(t):
    """Evaluate the hyperbolic functions of t >= 0 without a branch.

    Returns
    -------
    tuple of (float, float, float, float)
        sinh t and cosh t - 1.
        sinh t - t and, for short t only, cosh t - 1 - t**2/2.
    """
    odd, even, excess, higher, k, up, down = reduced_exponential(t, HALF)
    grown, shrunk = (1.0 + (even + odd)) * up, (1.0 + (even - odd)) * down
    sinh, versinh, short = grown - shrunk, (grown - 1.0) + shrunk, k == 0.0
    return choose(short, odd, sinh), choose(short, even, versinh), choose(short, excess, sinh - t), higher


@njit(**INTERNAL_INLINE)
def circular(rate, t):
    """Evaluate the circular functions of x = rate * t, 0 <= x up to 10**4, without a branch.

    Returns
    -------
    tuple of (float, float, float, float)
        sin x and 1 - cos x.
        x - sin x and, for short x only, x**2/2 - 1 + cos x.
    """
    x = rate * t
    shifted = fma(x, TWO_OVER_PI, ROUNDER)
    quadrant = shifted - ROUNDER
    high = fma(-quadrant, HALF_PI[0], x)
    tail = fma(-quadrant, HALF_PI[1], fma(rate, t, -x))
    r = high + tail
    # the third part of pi/2 is below the rounding error
    tail -= r - high
    p = r * r
    excess, higher = r * p * six_terms(p, SIN_SERIES), p * p * six_terms(p, COS_SERIES)
    versine = fma(0.5, p, -higher)
    odd_part = r + (tail * (1.0 - versine) - excess)
    even_part = 1.0 - (versine + r * tail)
    k = bits_of(shifted)
    swapped = (k & 1) != 0
    sine = choose(swapped, even_part, odd_part)
    cosine = choose(swapped, odd_part, even_part)
    sine = from_bits(bits_of(sine) ^ ((k & 2) << 62))
    cosine = from_bits(bits_of(cosine) ^ (((k + 1) & 2) << 62))
    short = quadrant == 0.0
    return sine, choose(short, versine, 1.0 - cosine), choose(short, excess, x - sine), higher


@njit(**INTERNAL_INLINE)
def parts(x):
    """Split a normal x > 0 into m * 2**k.

    Returns
    -------
    tuple of (float, float)
        The factor m, between 2**-1/2 and 2**1/2 for every x, NaN included.
        The exponent k.
    """
    bits = bits_of(x)
    exponent = (bits - ROOT_HALF) >> EXPONENT
    return from_bits(bits - (exponent << EXPONENT)), from_bits(exponent + INTEGER) - ROUNDER


@njit(**INTERNAL_INLINE)
def logarithms_of_ratios(a, b, c, d):
    """Return ln(a/b) and ln(c/d) of normal numbers above 0, to 5.4e-6 (``ROUGHLY``).

    One division, the slowest operation, serves both. The accuracy of either does not depend on the other's
    numbers.
    """
    (a, i), (b, j) = parts(a), parts(b)
    (c, k), (d, n) = parts(c), parts(d)
    per = 1.0 / ((a + b) * (c + d))
    return logarithm(i - j, (a - b) * (c + d) * per), logarithm(k - n, (c - d) * (a + b) * per)


@njit(**INTERNAL_INLINE)
def logarithm(power, s):
    """Return power ln 2 + 2 artanh s for |s| <= 1/3."""
    q = s * s
    return fma(power, LN2[0], s * fma(q, fma(q, LOGARITHM[2], LOGARITHM[1]), LOGARITHM[0]))
