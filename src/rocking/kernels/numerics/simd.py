"""Branch-free elementary functions of an arc, which the compiler vectorises over many blocks.

The functions of an arc are series of a reduced argument. If the reduction leaves a short argument unchanged,
the series also give the differences, such as sinh t - t, to full relative accuracy. For longer arguments
these differences are formed by subtraction.
"""

from rocking.kernels.library.kernel import kernel
from rocking.kernels.numerics.elementary import (
    HALF,
    HALF_PI,
    LN2,
    ROUNDER,
    TWO_OVER_PI,
    bits_of,
    choose,
    fma,
    from_bits,
    parts,
    polynomial,
    reduced_exponential,
)

# Times and angles up to these, below ln 2 / 2 and pi / 4, are not reduced.
SHORT_TIME, SHORT_ANGLE = 0.34, 0.78
# Upper bound on the error of ``logarithms_of_ratios``.
ROUGHLY = 6e-6

# Series in powers of the squared argument, for |argument| <= pi/4, shortened as those of ``elementary``. That of sin begins
# with the third power, that of cos with the fourth.
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


@kernel(inline=True)
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


@kernel(inline=True)
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
    excess, higher = r * p * polynomial(p, SIN_SERIES), p * p * polynomial(p, COS_SERIES)
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


@kernel(inline=True)
def logarithms_of_ratios(a, b, c, d):
    """Return ln(a/b) and ln(c/d) of normal numbers above 0, to 5.4e-6 (``ROUGHLY``).

    One division, the slowest operation, serves both. The accuracy of either does not depend on the other's
    numbers.
    """
    (a, i), (b, j) = parts(a), parts(b)
    (c, k), (d, n) = parts(c), parts(d)
    per = 1.0 / ((a + b) * (c + d))
    return logarithm(i - j, (a - b) * (c + d) * per), logarithm(k - n, (c - d) * (a + b) * per)


@kernel(inline=True)
def logarithm(power, s):
    """Return power ln 2 + 2 artanh s for |s| <= 1/3."""
    q = s * s
    return fma(power, LN2[0], s * fma(q, fma(q, LOGARITHM[2], LOGARITHM[1]), LOGARITHM[0]))
