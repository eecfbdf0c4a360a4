"""The first impact of an arc from a good guess, proved at a fraction of the cost.

A steady motion repeats its arcs, so the last arc on this side tells where the next zero of u is; one
evaluation there and a Taylor series reach it. It is the *first* zero if no stretch before it holds one, and
at the ends of stretches u needs no elementary function: cos eta is known there, and e^t grows from end to
end by one of two factors. Whatever is not certain by a wide margin is left to ``crossing``.
"""

import math

from numba import njit

from .arc import Instant, evaluate, exponentials
from .crossing import reversion, step_to_zero
from .elementary import INLINED
from .harmonic import first_cut, forcing_rates, forcing_term

TRIES = 6
MOST_STRETCHES = 64
# The fifth-order step and the Taylor series that follow it are exact to rounding for steps below this, in
# units of 1/max(1, Omega) and of u'/u''.
SMALL = 3e-4
# Beyond this bend the series is not trusted with a step, and a parabola takes it.
NEAR = 0.35
MARGIN = 1e-11


@njit(**INLINED)
def advance(p, now, step):
    """An instant carried on by a small step: Taylor series with all its derivatives from u'' = u + f."""
    f = forcing_term(p, now.cosine)
    df, ddf = forcing_rates(p, now.cosine, now.sine)
    second = now.angle + f
    third = now.velocity + df
    fourth = second + ddf
    fifth = third - p.frequency * p.frequency * df
    velocity = now.velocity + step * (
        second + step * (0.5 * third + step * ((1.0 / 6.0) * fourth + step * ((1.0 / 24.0) * fifth)))
    )
    x = p.frequency * step
    sin_x = x * (1.0 - x * x * (1.0 / 6.0 - x * x * (1.0 / 120.0)))
    versine = x * x * (0.5 - x * x * (1.0 / 24.0))
    cosine = now.cosine - (now.cosine * versine + now.sine * sin_x)
    sine = now.sine - (now.sine * versine - now.cosine * sin_x)
    h = step * (1.0 + step * step * (1.0 / 6.0))
    v = step * step * (0.5 + step * step * (1.0 / 24.0))
    sinh = now.sinh + (now.sinh * v + h + now.versinh * h)
    versinh = now.versinh + (now.versinh * v + v + now.sinh * h)
    return Instant(0.0, 0.0, velocity, cosine, sine, sinh, versinh)


@njit(**INLINED)
def may_dip(p, u, du, u_right, du_right):
    """Whether u, positive at both ends of a stretch with f > 0, may reach zero within.

    The free motions (u'' = u) through either end lie below u there; u stays clear of zero if they would reach
    it only after passing each other.
    """
    if u + du >= 0.0 or du_right <= u_right:
        return False
    crossed = u * du_right - u_right * du
    return crossed < p.base_outside_tanh * (u * u_right - du * du_right) * (1.0 + MARGIN)


@njit(**INLINED)
def unbroken_until(p, arc, t):
    """Whether u certainly stays positive on (0, t) of an arc off the base with u' > 0, given that u(t) = 0 and u'(t) < 0."""
    if p.base_half == math.inf:
        return True
    cut, concave = first_cut(p, arc.side, arc.psi, 0.0, p.base_half)
    if t <= cut:
        return concave
    grow, shrink, _ = exponentials(p, arc)
    z = math.exp(cut)
    per_z = 1.0 / z
    sine = p.cut_rate if concave else -p.cut_rate
    u, du = 0.0, 1.0
    for _ in range(MOST_STRETCHES):
        growing, shrinking = grow * z, shrink * per_z
        u_right = growing + shrinking + p.cut_place
        du_right = growing - shrinking - sine
        if not u_right > MARGIN * (abs(growing) + abs(shrinking) + 1.0):
            return False
        if not concave and may_dip(p, u, du, u_right, du_right):
            return False
        u, du = u_right, du_right
        sine = -sine
        concave = not concave
        if concave:
            cut += p.base_inside
            z *= p.base_inside_growth
            per_z *= p.base_inside_decay
        else:
            cut += p.base_outside
            z *= p.base_outside_growth
            per_z *= p.base_outside_decay
        if t <= cut:
            return True
    return False


@njit(**INLINED)
def close(p, now):
    """Whether the zero of u is so near that one step of the series reaches it."""
    u, v = now.angle, now.velocity
    bend = abs(u * (u + forcing_term(p, now.cosine)))
    return abs(u) * max(1.0, p.frequency) < -SMALL * v and bend < SMALL * v * v


@njit(**INLINED)
def stride(p, now, t):
    """A step towards the zero of u from further off, at time t."""
    u, v = now.angle, now.velocity
    f = forcing_term(p, now.cosine)
    fall = u + f
    if v < 0.0 and abs(u * fall) < NEAR * v * v:
        return step_to_zero(u, v, (f, *forcing_rates(p, now.cosine, now.sine)))
    under = v * v - 2.0 * u * fall
    if fall < 0.0 and under > 0.0:
        return (v + math.sqrt(under)) / -fall  # where the parabola comes down
    return -u / v if v < 0.0 else t  # pushed up: wait


@njit(**INLINED)
def likely_impact(p, arc, guess):
    """(certain, time, instant) of the first impact of an arc off the base, from a guess of its time."""
    t = guess
    now = evaluate(p, arc, t)
    tries = 0
    while not close(p, now):
        t += stride(p, now, t)
        tries += 1
        if not t > 0.0 or tries > TRIES:
            return False, t, now
        now = evaluate(p, arc, t)
    forcing = (forcing_term(p, now.cosine), *forcing_rates(p, now.cosine, now.sine))
    y, correction = reversion(now.angle, now.velocity, forcing)
    step = y * correction
    t += step
    if t > 0.0 and unbroken_until(p, arc, t):
        return True, t, advance(p, now, step)
    return False, t, now
