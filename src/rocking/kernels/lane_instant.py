"""An instant of each lane's arc: the elementary functions there, u and its derivatives, and how steps go on from it."""

from numba import njit

from .branchless import EXACT_INNER, SHORT_ANGLE, SHORT_TIME, choose, circular, hyperbolic
from .elementary import fma
from .lanes import (
    AMPLITUDE,
    COSINE,
    DEFICIT,
    EXCESS,
    FREQUENCY,
    HIGHER,
    LAG,
    LANES,
    RESPONSE,
    SIN_X,
    SINE,
    SINH,
    TIME,
    VELOCITY,
    VERSINE,
    VERSINH,
    of,
    put,
)  # fmt: skip
from .shortcut import I2, I3, I4, I5


@njit(**EXACT_INNER)
def correction(y, second, third, fourth, per):
    """``crossing.reversion``: what a Newton step y must be multiplied by, given the higher derivatives and 1/u'."""
    a, b, c = I2 * second * per, I3 * third * per, I4 * fourth * per
    return fma(y, fma(y, fma(y, fma(5.0 * a, fma(-a, a, b), -c), fma(2.0 * a, a, -b)), -a), 1.0)


@njit(**EXACT_INNER)
def derivatives(there, amplitude, frequency):
    """u and its first six derivatives at an instant (u, u', cos eta, sin eta), from u'' = u + f."""
    u, v, cosine, sine = there
    turned = -frequency * frequency
    f, df, ddf = fma(-amplitude, cosine, -1.0), amplitude * frequency * sine, -turned * amplitude * cosine
    c2, c3 = u + f, v + df
    c4, c5 = c2 + ddf, fma(turned, df, c3)
    return u, v, c2, c3, c4, c5, fma(turned, ddf, c4)


@njit(**EXACT_INNER)
def halved(factor):
    """A factor between 1/2 and 2; 1 where it is not."""
    return choose((factor > 0.5) & (factor < 2.0), factor, 1.0)


@njit(**EXACT_INNER)
def instant(system, start, t, hyperbolics, circulars):
    """(u - u0, u', cos eta, sin eta) of an arc at a time t, eq. (5) as in ``harmonic.respond`` and ``arc.after``."""
    amplitude, frequency, response = system
    above, velocity, cosine, sine = start
    sinh, versinh, excess, higher = hyperbolics
    sin_x, versine, lag, deficit = circulars
    near = (frequency * t < SHORT_ANGLE) & (t < SHORT_TIME)
    in_phase, lateness = versinh + versine, fma(frequency, excess, lag)
    place = choose(near, -fma(frequency * frequency, higher, deficit), in_phase)
    rate = choose(near, -frequency * lateness, fma(frequency, sin_x, sinh))
    steady = choose(near, fma(-amplitude, cosine, above), above)
    displaced = response * fma(sine, lateness, -cosine * place)
    moved = response * fma(frequency * sine, in_phase, -cosine * rate)
    return (
        fma(velocity, sinh, fma(steady, versinh, displaced)),
        velocity + fma(velocity, versinh, fma(steady, sinh, moved)),
        cosine - fma(cosine, versine, sine * sin_x),
        sine - fma(sine, versine, -cosine * sin_x),
    )


@njit(**EXACT_INNER)
def elements(s):
    """The elementary functions at the time that each lane looks at."""
    for i in range(LANES):
        sinh, versinh, excess, higher = hyperbolic(of(s, i, TIME))
        put(s, i, SINH, sinh)
        put(s, i, VERSINH, versinh)
        put(s, i, EXCESS, excess)
        put(s, i, HIGHER, higher)
    for i in range(LANES):
        sin_x, versine, lag, deficit = circular(of(s, i, FREQUENCY), of(s, i, TIME))
        put(s, i, SIN_X, sin_x)
        put(s, i, VERSINE, versine)
        put(s, i, LAG, lag)
        put(s, i, DEFICIT, deficit)


@njit(**EXACT_INNER)
def instant_of(s, i, above):
    """``instant`` of lane i where it looks, whose arc starts so far ``above`` the angle 1."""
    system = of(s, i, AMPLITUDE), of(s, i, FREQUENCY), of(s, i, RESPONSE)
    start = above, of(s, i, VELOCITY), of(s, i, COSINE), of(s, i, SINE)
    hyperbolics = of(s, i, SINH), of(s, i, VERSINH), of(s, i, EXCESS), of(s, i, HIGHER)
    circulars = of(s, i, SIN_X), of(s, i, VERSINE), of(s, i, LAG), of(s, i, DEFICIT)
    return instant(system, start, of(s, i, TIME), hyperbolics, circulars)


@njit(**EXACT_INNER)
def onward(x, frequency, cosine, sine, sinh, versinh):
    """(cos eta, sin eta, sinh, cosh - 1) a small time x later, as in ``shortcut.advance``."""
    angle = frequency * x
    sin_x = angle * fma(-angle * angle, fma(-angle * angle, I5, I3), 1.0)
    versine = angle * angle * fma(-angle * angle, I4, I2)
    sinh_x, versinh_x = x * fma(x * x, I3, 1.0), x * x * fma(x * x, I4, I2)
    return (
        cosine - fma(cosine, versine, sine * sin_x),
        sine - fma(sine, versine, -cosine * sin_x),
        sinh + fma(sinh, versinh_x, fma(versinh, sinh_x, sinh_x)),
        versinh + fma(versinh, versinh_x, fma(sinh, sinh_x, versinh_x)),
    )
