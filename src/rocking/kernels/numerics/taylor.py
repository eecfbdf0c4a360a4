"""Steps by Taylor series, for one block and for lanes: fused products are explicit, so that both round alike."""

import math

from rocking.kernels.library.kernel import kernel
from rocking.kernels.numerics.elementary import choose, fma

I2, I3, I4, I5, I6, I7, I8 = (1.0 / math.factorial(k) for k in range(2, 9))


@kernel(inline=True)
def reversion(y, second, third, fourth, per):
    """Return the factor that extends a Newton step y to the nearest zero of w's Taylor series, to fifth order.

    ``per`` is 1/w'; ``second``, ``third`` and ``fourth`` are higher derivatives of w.
    """
    a, b, c = I2 * second * per, I3 * third * per, I4 * fourth * per
    return fma(y, fma(y, fma(y, fma(5.0 * a, fma(-a, a, b), -c), fma(2.0 * a, a, -b)), -a), 1.0)


@kernel(inline=True)
def within_a_factor_of_two(factor):
    """Return the factor if it lies between 1/2 and 2, else 1.

    A factor near 0 would stop the search away from a zero.
    """
    return choose((factor > 0.5) & (factor < 2.0), factor, 1.0)


@kernel(inline=True)
def series(c, x):
    """Return w and its first four derivatives a time x later, from its first eight derivatives at present.

    ``c`` is (w, w', ..., the eighth derivative). Up to a time of ``fast_search_cosine.REACH`` the truncated series is
    accurate to about three digits.
    """
    c0, c1, c2, c3, c4, c5, c6, c7, c8 = c
    q = x * x
    h = q * q
    w4 = fma(q, I2 * c6, fma(x, c5, c4))
    w3 = fma(q, fma(x, I3 * c6, I2 * c5), fma(x, c4, c3))
    w2 = fma(h, fma(x, I5 * c7, I4 * c6), fma(q, fma(x, I3 * c5, I2 * c4), fma(x, c3, c2)))
    w1 = fma(q, I6 * c7, fma(x, I5 * c6, I4 * c5))
    w1 = fma(h, w1, fma(q, fma(x, I3 * c4, I2 * c3), fma(x, c2, c1)))
    w0 = fma(h, I8 * c8, fma(q, fma(x, I7 * c7, I6 * c6), fma(x, I5 * c5, I4 * c4)))
    w0 = fma(h, w0, fma(q, fma(x, I3 * c3, I2 * c2), fma(x, c1, c0)))
    return w0, w1, w2, w3, w4


@kernel(inline=True)
def velocity_after(derivatives, x):
    """Return w' a small time x later from (w', ..., the fifth derivative) at present."""
    v, second, third, fourth, fifth = derivatives
    return fma(x, fma(x, fma(x, fma(x, I4 * fifth, I3 * fourth), I2 * third), second), v)
