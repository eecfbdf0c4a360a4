"""The first impact of an arc from a good guess, proved at a fraction of the cost.

A steady motion repeats its arcs, so the last arc on this side tells where the next zero of u is, and what
carries an arc on by that time is still at hand (``Lapse``): from there a Taylor series reaches the zero. Where it
lies further off the series guesses, and one new evaluation follows. It is the *first* zero if no stretch
before it holds one: most often their order alone proves that, else u at their ends, which needs no elementary
function, since cos eta is known there and e^t grows from end to end by given factors. Whatever is not certain by a
wide margin is left to ``crossing``.
"""

import math

from numba import njit

from .arc import Instant, after, exponentials, lapse_of
from .crossing import reversion, step_to_zero
from .elementary import INNER
from .harmonic import first_cut, forcing_rates, forcing_term

TRIES = 6
MOST_STRETCHES = 64
# The fifth-order step and the Taylor series that follow it are exact to rounding for steps below this, in
# units of 1/max(1, Omega) and of u'/u''.
SMALL = 3e-4
# A longer step is polished where it is shorter than REACH, in units of 1/max(1, Omega), in so many rounds; from a
# bend below this one more round would not show.
REACH, ROUNDS, BEND = 1.5, 3, 0.1
I2, I3, I4, I5, I6, I7, I8 = (1.0 / math.factorial(k) for k in range(2, 9))
MARGIN = 1e-11


@njit(**INNER)
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


@njit(**INNER)
def may_dip(p, u, du, u_right, du_right):
    """Whether u, positive at both ends of a stretch with f > 0, may reach zero within.

    The free motions (u'' = u) through either end lie below u there; u stays clear of zero if they would reach
    it only after passing each other.
    """
    if u + du >= 0.0 or du_right <= u_right:
        return False
    crossed = u * du_right - u_right * du
    return crossed < p.base_outside_tanh * (u * u_right - du * du_right) * (1.0 + MARGIN)


@njit(**INNER)
def unbroken_until(p, arc, t):
    """Whether u certainly stays positive on (0, t) of an arc that rises from u >= 0, given that u(t) = 0 and u'(t) < 0.

    A concave stretch between ends with u >= 0 holds no zero, nor does a convex one in which the arc begins,
    rising, or ends, falling. That leaves the convex stretches which an arc passes from end to end.
    """
    if p.base_half == math.inf:
        return True
    cut, concave = first_cut(p, arc.side, arc.psi, 0.0, p.base_half)
    left = cut if concave else cut + p.base_inside
    if t <= left + p.base_outside:
        return concave or t > cut
    grow, shrink, _ = exponentials(p, arc)
    z = math.exp(left)
    per_z = 1.0 / z
    passed = left + p.base_outside
    for _ in range(MOST_STRETCHES):
        growing, shrinking = grow * z, shrink * per_z
        u, du = growing + shrinking + p.cut_place, growing - shrinking - p.cut_rate
        error = MARGIN * (abs(growing) + abs(shrinking) + 1.0)
        growing, shrinking = growing * p.base_outside_growth, shrinking * p.base_outside_decay
        u_right, du_right = growing + shrinking + p.cut_place, growing - shrinking + p.cut_rate
        error += MARGIN * (abs(growing) + abs(shrinking))
        if not (u > error and u_right > error) or may_dip(p, u, du, u_right, du_right):
            return False
        passed += p.period
        if t <= passed:
            return True
        z *= p.turn_growth
        per_z *= p.turn_decay
    return False


@njit(**INNER)
def close(p, now):
    """Whether the zero of u is so near that one step of the series reaches it."""
    u, v = now.angle, now.velocity
    bend = abs(u * (u + forcing_term(p, now.cosine)))
    return abs(u) * max(1.0, p.frequency) < -SMALL * v and bend < SMALL * v * v


@njit(**INNER)
def stride(p, now, t):
    """A step towards the zero of u from further off, at time t: to where the parabola comes down."""
    u, v = now.angle, now.velocity
    fall = u + forcing_term(p, now.cosine)
    under = v * v - 2.0 * u * fall
    if fall < 0.0 and under > 0.0:
        return (v + math.sqrt(under)) / -fall
    return -u / v if v < 0.0 else t  # pushed up: wait


@njit(**INNER)
def polished(p, now, rough):
    """A rough step to the zero of u, corrected by where the Taylor series about ``now`` has it: no new elementary functions.

    c_k are the derivatives of u there, w_k those at the end of the step. Only a guess: the series stops where it is
    good to some five digits within REACH.
    """
    if max(1.0, p.frequency) * abs(rough) > REACH:
        return rough
    f = forcing_term(p, now.cosine)
    df, ddf = forcing_rates(p, now.cosine, now.sine)
    turned = -p.frequency * p.frequency
    c0, c1 = now.angle, now.velocity
    c2, c3 = c0 + f, c1 + df
    c4, c5 = c2 + ddf, c3 + turned * df
    c6, c7 = c4 + turned * ddf, c5 + turned * turned * df
    c8 = c6 + turned * turned * ddf
    s = rough
    for _ in range(ROUNDS):
        w4 = c4 + s * (c5 + s * (I2 * c6))
        w3 = c3 + s * (c4 + s * (I2 * c5 + s * (I3 * c6)))
        w2 = c2 + s * (c3 + s * (I2 * c4 + s * (I3 * c5 + s * (I4 * c6 + s * (I5 * c7)))))
        w1 = c1 + s * (c2 + s * (I2 * c3 + s * (I3 * c4 + s * (I4 * c5 + s * (I5 * c6 + s * (I6 * c7))))))
        high = I4 * c4 + s * (I5 * c5 + s * (I6 * c6 + s * (I7 * c7 + s * (I8 * c8))))
        w0 = c0 + s * (c1 + s * (I2 * c2 + s * (I3 * c3 + s * high)))
        if not w1 < 0.0:
            return rough
        s += step_to_zero(w0, w1, (w2 - w0, w3 - w1, w4 - w2))
        if abs(w0 * w2) < BEND * w1 * w1:
            break
    return s


@njit(**INNER)
def likely_impact(p, arc, guess):
    """(certain, time, instant, lapse close by) of the first impact of an arc that rises, from the lapse that is guessed."""
    lapse = guess
    now = after(p, arc, lapse)
    tries = 0
    while not close(p, now):
        t = lapse.time + polished(p, now, stride(p, now, lapse.time))
        tries += 1
        if not t > 0.0 or tries > TRIES:
            return False, t, now, lapse
        lapse = lapse_of(p, t)
        now = after(p, arc, lapse)
    forcing = (forcing_term(p, now.cosine), *forcing_rates(p, now.cosine, now.sine))
    y, correction = reversion(now.angle, now.velocity, forcing)
    step = y * correction
    t = lapse.time + step
    if t > 0.0 and unbroken_until(p, arc, t):
        return True, t, advance(p, now, step), lapse
    return False, t, now, lapse
