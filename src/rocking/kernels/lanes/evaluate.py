"""An instant of each lane's arc: the elementary functions there, u and its derivatives, and how steps go on from it."""

from numba import njit

from rocking.kernels.arc.fast_path import I2, I3, I4
from rocking.kernels.compile_options import SIMD_INLINE
from rocking.kernels.lanes.rows import (  # fmt: skip
    AMPLITUDE,
    AMPLITUDE_RATE,
    COSINE,
    DEFICIT,
    EXCESS,
    FREQUENCY,
    FREQUENCY_SQUARE,
    HIGHER,
    LAG,
    LANES,
    RESPONSE,
    RESPONSE_RATE,
    SHORT_TIME_LIMIT,
    SIN_X,
    SINE,
    SINH,
    TIME,
    VELOCITY,
    VERSINE,
    VERSINH,
    load,
    store,
)
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import choose, circular, hyperbolic


@njit(**SIMD_INLINE)
def correction(y, second, third, fourth, per):
    """``first_zero.reversion``: what a Newton step y must be multiplied by, given the higher derivatives and 1/u'."""
    a, b, c = I2 * second * per, I3 * third * per, I4 * fourth * per
    return fma(y, fma(y, fma(y, fma(5.0 * a, fma(-a, a, b), -c), fma(2.0 * a, a, -b)), -a), 1.0)


@njit(**SIMD_INLINE)
def derivatives(s, i, there):
    """u and its first six derivatives at an instant (u, u', cos eta, sin eta) in lane i, from u'' = u + f."""
    u, v, cosine, sine = there
    square, acceleration = load(s, i, FREQUENCY_SQUARE), load(s, i, AMPLITUDE) * cosine
    df, ddf = load(s, i, AMPLITUDE_RATE) * sine, square * acceleration
    c2, c3 = u - (1.0 + acceleration), v + df
    c4, c5 = c2 + ddf, fma(-square, df, c3)
    return u, v, c2, c3, c4, c5, fma(-square, ddf, c4)


@njit(**SIMD_INLINE)
def halved(factor):
    """A factor between 1/2 and 2; 1 where it is not."""
    return choose((factor > 0.5) & (factor < 2.0), factor, 1.0)


@njit(**SIMD_INLINE)
def instant_of(s, i, above):
    """(u - u0, u', cos eta, sin eta) of lane i where it looks, eq. (5) as in ``respond`` and ``after``; u0 = 1 + ``above``."""
    frequency, response = load(s, i, FREQUENCY), load(s, i, RESPONSE)
    velocity, cosine, sine = load(s, i, VELOCITY), load(s, i, COSINE), load(s, i, SINE)
    sinh, versinh, excess = load(s, i, SINH), load(s, i, VERSINH), load(s, i, EXCESS)
    sin_x, versine, lag = load(s, i, SIN_X), load(s, i, VERSINE), load(s, i, LAG)
    near = load(s, i, TIME) < load(s, i, SHORT_TIME_LIMIT)
    in_phase, quadrature = versinh + versine, fma(frequency, excess, lag)
    place = choose(
        near, -fma(load(s, i, FREQUENCY_SQUARE), load(s, i, HIGHER), load(s, i, DEFICIT)), in_phase
    )
    rate = choose(near, -frequency * quadrature, fma(frequency, sin_x, sinh))
    steady = choose(near, fma(-load(s, i, AMPLITUDE), cosine, above), above)
    response_cosine = response * cosine
    displaced = fma(response * sine, quadrature, -response_cosine * place)
    moved = fma(load(s, i, RESPONSE_RATE) * sine, in_phase, -response_cosine * rate)
    return (
        fma(velocity, sinh, fma(steady, versinh, displaced)),
        velocity + fma(velocity, versinh, fma(steady, sinh, moved)),
        cosine - fma(cosine, versine, sine * sin_x),
        sine - fma(sine, versine, -cosine * sin_x),
    )


@njit(**SIMD_INLINE)
def elements(s):
    """The elementary functions at the time that each lane looks at."""
    for i in range(LANES):
        sinh, versinh, excess, higher = hyperbolic(load(s, i, TIME))
        store(s, i, SINH, sinh)
        store(s, i, VERSINH, versinh)
        store(s, i, EXCESS, excess)
        store(s, i, HIGHER, higher)
    for i in range(LANES):
        sin_x, versine, lag, deficit = circular(load(s, i, FREQUENCY), load(s, i, TIME))
        store(s, i, SIN_X, sin_x)
        store(s, i, VERSINE, versine)
        store(s, i, LAG, lag)
        store(s, i, DEFICIT, deficit)


@njit(**SIMD_INLINE)
def onward(x, frequency, cosine, sine, sinh, versinh):
    """(cos eta, sin eta, sinh, cosh - 1) a small time x later, as in ``fast_path.advance``."""
    angle = frequency * x
    sin_x = angle * fma(-angle * angle, I3, 1.0)
    versine = angle * angle * fma(-angle * angle, I4, I2)
    sinh_x, versinh_x = x * fma(x * x, I3, 1.0), x * x * fma(x * x, I4, I2)
    return (
        cosine - fma(cosine, versine, sine * sin_x),
        sine - fma(sine, versine, -cosine * sin_x),
        sinh + fma(sinh, versinh_x, fma(versinh, sinh_x, sinh_x)),
        versinh + fma(versinh, versinh_x, fma(sinh, sinh_x, versinh_x)),
    )
