"""Instructions of the processor, and the elementary functions of the kernels.

No function of the C library is called: its last digits differ from one version, and from one processor, to the next. Each
function here is a fixed sequence of additions, products and divisions, with the same bits everywhere. Their errors stay
below four units of the last digit, and below two for ``exponential``, ``logarithm``, sine and cosine.

For short arcs the standard functions lose digits by cancellation in ``cosh t - 1``, ``sinh t - t``, ``1 - cos x`` and
``x - sin x``. ``hyperbolic`` and ``circular`` are accurate for arbitrarily short arcs. Short arguments are evaluated by
their Taylor series. Long arguments use exponentials, and the sine and cosine of an argument reduced by pi/2 in three
parts.

The rough logarithm and power of two take a tenth of the time. They serve where a bound decides afterwards, as for the
length of a step.
"""

import math

import numpy as np

from rocking.kernels.library.kernel import intrinsic, kernel

# Coefficients by increasing power of the squared argument: 1/3!, 1/5!, ... and 1/4!, 1/6!, .... The first
# omitted term is below 2**-55 of the sum at 2.
ODD = tuple(1.0 / math.factorial(k) for k in range(3, 27, 2))
EVEN = tuple(1.0 / math.factorial(k) for k in range(4, 28, 2))
# Enough of them for |argument| <= pi/4.
SHORT_ODD, SHORT_EVEN = ODD[:8], EVEN[:8]
# 1/3, 1/5, ...: of the arctangent up to tan(pi/8), and of artanh up to tan(pi/8)**2, where the first omitted term
# is below 2**-56 of the argument.
ARCTANGENT = tuple(1.0 / k for k in range(3, 43, 2))
ARTANH = ARCTANGENT[:10]
# Series in powers of the squared argument, for |argument| <= ln 2 / 2: Taylor series of sinh from the third power on, and of
# cosh from the fourth, shortened by Lanczos's economisation. They are as accurate as longer Taylor series.
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

# pi/2 in three parts. The first two have 33 bits, so their products with the quadrant number are exact up to
# 2**20 quadrants.
HALF_PI = (1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21)
TWO_OVER_PI = 2.0 / math.pi
EIGHTH_TURN, RIGHT_ANGLE = 0.25 * math.pi, 0.5 * math.pi
# Up to here the three parts suffice. A larger angle is first reduced by whole turns; 2 pi in two parts of 53 bits.
LARGE_ANGLE = 1e6
TURN = (6.283185307179586, 2.4492935982947064e-16)
# What rounding takes from pi/2.
REST_OF_HALF_PI = 6.123233995736766e-17
# tan(pi/8).
EIGHTH_TANGENT = math.sqrt(2.0) - 1.0
# From here on tanh rounds to 1.
LONG = 20.0

# ln 2 in two parts; the first has 32 bits.
LN2 = (0.6931471803691238, 1.9082149292705877e-10)
PER_LN2 = 1.4426950408889634
PER_LN10 = 0.4342944819032518
# Adding and subtracting this rounds a number to an integer, which is then held in its last bits.
ROUNDER = 1.5 * 2.0**52
EXPONENT = 52
HALF, ONE = 1022 << EXPONENT, 1023 << EXPONENT
# Bit patterns of 2**-1/2 and of ROUNDER.
ROOT_HALF = int(np.float64(0.5**0.5).view(np.int64))
INTEGER = int(np.float64(ROUNDER).view(np.int64))
LEAST_NORMAL = 2.0**-1022
# Exponents for which neither e^t nor e^-t leaves the normal numbers, and those for which e^t is neither 0 nor infinite.
NORMAL_EXPONENT, LEAST_EXPONENT, LARGEST_EXPONENT = 700.0, -746.0, 709.79
# Squares of sizes between these neither overflow nor underflow. Others are scaled by 2**600.
SMALL_SIZE, LARGE_SIZE, SCALE = 1e-140, 1e140, 2.0**600


SHORT = 2.0
# Up to here four terms suffice: the first omitted one is below 2**-54 of the sum.
BRIEF = 0.0625
# Up to here 1/(1 - x) bounds exp x closely enough: 1.22 times.
NEAR_ONE = 0.5
LEAST_BIT = 2.0**-EXPONENT
# log2 m lies at most twice this above m - 1, for m from 1 to 2.
HALFWAY = 0.04304
# 2**f = 1 + f (a + b f), to 0.002 for |f| <= 1/2.
POWER = (0.70294, 0.23986)


@intrinsic
def fma(typingctx, a, b, c):
    """Return ``a*b + c`` with one rounding."""
    from numba import types

    def generate(context, builder, signature, arguments):
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), generate


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


@kernel(inline=True)
def polynomial(q, c):
    """Return the sum of c[k] q**k for an even number of coefficients, in two interleaved chains (half the latency of one)."""
    q2, last = q * q, len(c) - 2
    even = c[last]
    odd = c[last + 1]
    for k in range(last - 2, -1, -2):
        even = fma(even, q2, c[k])
        odd = fma(odd, q2, c[k + 1])
    return fma(odd, q, even)


@kernel(inline=True)
def five_terms(q, c):
    """Return the sum of c[k] q**k for 5 coefficients, in two independent chains."""
    q2 = q * q
    return fma(fma(c[3], q2, c[1]), q, fma(fma(c[4], q2, c[2]), q2, c[0]))


@kernel(inline=True)
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


@kernel(inline=True)
def both_exponentials(t):
    """Return e^t and e^-t for abs(t) < 700, from the even and odd parts of one reduced argument."""
    odd, even, _, _, _, up, down = reduced_exponential(t, ONE)
    return (1.0 + (even + odd)) * up, (1.0 + (even - odd)) * down


@kernel(seldom=True)
def exponential(t):
    """Return e^t: 0 or infinity outside the range of the floating-point numbers."""
    if abs(t) < NORMAL_EXPONENT:
        return both_exponentials(t)[0]
    if t > LARGEST_EXPONENT:
        return math.inf
    if t < LEAST_EXPONENT:
        return 0.0
    half = both_exponentials(0.5 * t)[0]
    return half * half


@kernel(inline=True)
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


@kernel(seldom=True)
def logarithm(x):
    """Return ln x: minus infinity at 0, NaN below.

    With x = (1 + f) 2**k and s = f/(2 + f), ln(1 + f) = 2 artanh s = f - f**2/2 + s (f**2/2 + R), where R is what the series
    of 2 artanh s adds to 2 s, over s.
    """
    if not LEAST_NORMAL <= x < math.inf:
        if x > 0.0:
            return x if x == math.inf else logarithm_of_normal(x * 2.0**54, -54.0)
        return -math.inf if x == 0.0 else math.nan
    return logarithm_of_normal(x, 0.0)


@kernel(inline=True)
def logarithm_of_normal(x, power):
    """Return ln(2**power x) of a normal number x > 0."""
    m, k = parts(x)
    k += power
    f = m - 1.0
    s = f / (2.0 + f)
    q, half = s * s, 0.5 * f * f
    rest = 2.0 * q * polynomial(q, ARTANH)
    return fma(k, LN2[0], f - (half - fma(s, half + rest, k * LN2[1])))


@kernel
def logarithm_2(x):
    """Return the logarithm of x to base 2."""
    return logarithm(x) * PER_LN2


@kernel
def logarithm_10(x):
    """Return the logarithm of x to base 10."""
    return logarithm(x) * PER_LN10


@kernel(inline=True)
def quarter_turn(x, correction):
    """Evaluate sine and cosine of ``x + correction``, for 0 <= x up to LARGE_ANGLE.

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
    excess = r * q * polynomial(-q, SHORT_ODD)
    versine = q * fma(-q, polynomial(-q, SHORT_EVEN), 0.5)
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


@kernel(inline=True)
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


@kernel(seldom=True)
def direction_of_large(angle):
    """Return sine and cosine of an angle beyond LARGE_ANGLE, to the rounding error of 1 up to 10**15."""
    turns = np.floor(angle / TURN[0] + 0.5)
    whole = turns * TURN[0]
    left = (angle - whole) - (fma(turns, TURN[0], -whole) + turns * TURN[1])
    sine, cosine, _, _ = direction(left)
    return sine, cosine


@kernel(inline=True)
def sine_and_cosine(x):
    """Return sin x and cos x."""
    if abs(x) > EIGHTH_TURN:
        if abs(x) > LARGE_ANGLE:
            return direction_of_large(x)
        sine, cosine, _, _ = direction(x)
        return sine, cosine
    q = x * x
    sine = fma(-x * q, polynomial(-q, SHORT_ODD), x)
    return sine, fma(-q, fma(-q, polynomial(-q, SHORT_EVEN), 0.5), 1.0)


@kernel
def sine_of(x):
    """Return sin x."""
    return sine_and_cosine(x)[0]


@kernel
def cosine_of(x):
    """Return cos x."""
    return sine_and_cosine(x)[1]


@kernel
def tangent_of(x):
    """Return tan x."""
    sine, cosine = sine_and_cosine(x)
    return sine / cosine


@kernel
def arctangent(x):
    """Return the angle between -pi/2 and pi/2 whose tangent is x.

    The argument of the series lies within +-tan(pi/8), after a turn by 0, pi/4 or pi/2.
    """
    a, turn, rest, y = abs(x), 0.0, 0.0, abs(x)
    if a * EIGHTH_TANGENT > 1.0:
        turn, rest, y = 2.0 * EIGHTH_TURN, REST_OF_HALF_PI, -1.0 / a
    elif a > EIGHTH_TANGENT:
        turn, rest, y = EIGHTH_TURN, 0.5 * REST_OF_HALF_PI, (a - 1.0) / (a + 1.0)
    q = y * y
    return math.copysign(turn + (y - (y * q * polynomial(-q, ARCTANGENT) - rest)), x)


@kernel
def angle_of(y, x):
    """Return the angle of the point (x, y), between -pi and pi."""
    if x == 0.0 and y == 0.0:
        return math.copysign(math.pi if math.copysign(1.0, x) < 0.0 else 0.0, y)
    if x == 0.0:
        return math.copysign(RIGHT_ANGLE, y)
    angle = arctangent(y / x)
    return angle if x > 0.0 else math.copysign(math.pi, y) + angle


@kernel
def arccosine(x):
    """Return the angle between 0 and pi whose cosine is x; NaN beyond 1."""
    return 2.0 * angle_of(math.sqrt(1.0 - x), math.sqrt(1.0 + x))


@kernel
def artanh(x):
    """Return the number whose hyperbolic tangent is x; infinite at 1."""
    if abs(x) > EIGHTH_TANGENT * EIGHTH_TANGENT:
        return 0.5 * logarithm((1.0 + x) / (1.0 - x))
    q = x * x
    return fma(x * q, polynomial(q, ARTANH), x)


@kernel(inline=True)
def size(x, y):
    """Return the length of (x, y); the squares must neither overflow nor underflow."""
    return math.sqrt(x * x + y * y)


@kernel(seldom=True)
def hypotenuse(x, y):
    """Return the length of (x, y), whatever their sizes."""
    longer = max(abs(x), abs(y))
    if SMALL_SIZE < longer < LARGE_SIZE:
        return size(x, y)
    scale = SCALE if longer <= SMALL_SIZE else 1.0 / SCALE
    return size(scale * x, scale * y) / scale


@kernel(inline=True)
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
        excess = q * t * polynomial(q, ODD)
        higher = q * q * polynomial(q, EVEN)
        return t + excess, fma(0.5, q, higher), excess, higher
    grown = 0.5 * exponential(t)
    shrunk = 0.25 / grown
    sinh = grown - shrunk
    versinh = (grown - 1.0) + shrunk
    return sinh, versinh, sinh - t, fma(-0.5, q, versinh)


@kernel(inline=True)
def brief_hyperbolic(t):
    """Evaluate sinh t, cosh t - 1 and sinh t - t of t >= 0 as ``hyperbolic`` does, faster up to BRIEF."""
    if t > BRIEF:
        sinh, versinh, excess, _ = hyperbolic(t)
        return sinh, versinh, excess
    q = t * t
    excess = q * t * fma(fma(fma(ODD[3], q, ODD[2]), q, ODD[1]), q, ODD[0])
    versinh = q * fma(fma(fma(fma(EVEN[3], q, EVEN[2]), q, EVEN[1]), q, EVEN[0]), q, 0.5)
    return t + excess, versinh, excess


@kernel(inline=True)
def rough_hyperbolic(t):
    """Evaluate sinh t and cosh t of t >= 0 for estimates: the relative error is below 0.002."""
    if t > SHORT:
        grown = 0.5 * exponential(t)
        shrunk = 0.25 / grown
        return grown - shrunk, grown + shrunk
    q = t * t
    sinh = t * fma(fma(fma(ODD[2], q, ODD[1]), q, ODD[0]), q, 1.0)
    return sinh, fma(fma(fma(EVEN[1], q, EVEN[0]), q, 0.5), q, 1.0)


@kernel(inline=True)
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


@kernel(inline=True)
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
        lag = q * x * polynomial(-q, ODD)
        higher = q * q * polynomial(-q, EVEN)
        return x - lag, fma(0.5, q, -higher), lag, higher
    sine, cosine, versine, k = quarter_turn(x, fma(rate, t, -x))
    if k != 0:
        versine = 1.0 - cosine
    return sine, versine, x - sine, 0.0


@kernel
def hyperbolic_tangent(t):
    """Return tanh t."""
    if abs(t) > LONG:
        return math.copysign(1.0, t)
    sinh, versinh, _, _ = hyperbolic(abs(t))
    return math.copysign(sinh / (1.0 + versinh), t)


@kernel(inline=True)
def rough_log2(x):
    """Return the logarithm of x > 0 to base 2, to 0.0431. Between powers of two it is linear."""
    return (bits_of(x) - ONE) * LEAST_BIT + HALFWAY


@kernel(inline=True)
def rough_exp2(y):
    """Return 2**y for |y| <= 1000, to 0.2 %."""
    whole = y + ROUNDER
    rest = y - (whole - ROUNDER)
    return (1.0 + rest * (POWER[0] + rest * POWER[1])) * from_bits((bits_of(whole) << EXPONENT) + ONE)
