"""Rough logarithms and powers of two, in a tenth of the time of the standard functions.

They serve where a bound decides afterwards, as for the length of a step.
"""

from rocking.kernels.compile_options import KERNEL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.numerics.simd import EXPONENT, ONE, ROUNDER, bits_of, from_bits

LEAST_BIT = 2.0**-EXPONENT
# log2 m lies at most twice this above m - 1, for m from 1 to 2.
HALFWAY = 0.04304
# 2**f = 1 + f (a + b f), to 0.002 for |f| <= 1/2.
POWER = (0.70294, 0.23986)


@njit(**KERNEL_INLINE)
def rough_log2(x):
    """Return the logarithm of x > 0 to base 2, to 0.0431. Between powers of two it is linear."""
    return (bits_of(x) - ONE) * LEAST_BIT + HALFWAY


@njit(**KERNEL_INLINE)
def rough_exp2(y):
    """Return 2**y for |y| <= 1000, to 0.2 %."""
    whole = y + ROUNDER
    rest = y - (whole - ROUNDER)
    return (1.0 + rest * (POWER[0] + rest * POWER[1])) * from_bits((bits_of(whole) << EXPONENT) + ONE)
