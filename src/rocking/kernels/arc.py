"""One arc of rocking in closed form, eqs (4)-(5) of Yim & Lin (1991), free of cancellation on short arcs.

On side sigma = sign(Theta) work with u = sigma Theta >= 0: u'' - u = f = -1 - A cos eta. From (u0, v0) at eta0

    u = u0 cosh t + v0 sinh t - (cosh t - 1) - F(t),

F the response from rest to the base acceleration (``harmonic.respond``). The exponential form u = c+ e^t +
c- e^-t + 1 + beta cos eta serves bounds.
"""

from typing import NamedTuple

from numba import njit

from .elementary import INLINED, hyperbolic
from .harmonic import begin, particular, respond

ROUNDING = 2.0**-53


class Arc(NamedTuple):
    """Where an arc starts: side of the base, time within the cycle, u, u', and the forcing there."""

    side: int
    start: float
    angle: float
    velocity: float
    cosine: float
    sine: float
    psi: float


class Instant(NamedTuple):
    """What an arc is at one instant: u, u', the forcing there, and the hyperbolic functions of the time since its start."""

    angle: float
    velocity: float
    cosine: float
    sine: float
    sinh: float
    versinh: float  # cosh t - 1


@njit(**INLINED)
def arc_from(p, side, start, angle, velocity):
    """The arc that leaves (u, u') = (angle, velocity) on ``side`` at time ``start`` within the cycle."""
    cosine, sine, psi = begin(p, side, start)
    return Arc(side, start, angle, velocity, cosine, sine, psi)


@njit(**INLINED)
def arc_after(p, side, start, velocity, cosine, sine):
    """The arc that leaves the base on ``side``, where the forcing there is known already."""
    return Arc(side, start, 0.0, velocity, cosine, sine, p.frequency * start + p.phase)


@njit(**INLINED)
def earlier(arc, time):
    """The same arc as seen from ``time`` later: its start lies so much earlier."""
    return Arc(arc.side, arc.start - time, arc.angle, arc.velocity, arc.cosine, arc.sine, arc.psi)


@njit(**INLINED)
def evaluate(p, arc, t):
    """The arc a time t >= 0 after its start: eq. (5)."""
    sinh, versinh, excess = hyperbolic(t)
    displaced, moved, cosine, sine = respond(p, arc.cosine, arc.sine, t, sinh, versinh, excess)
    below = arc.angle - 1.0
    angle = arc.angle + (below * versinh + arc.velocity * sinh - displaced)
    velocity = arc.velocity + (below * sinh + arc.velocity * versinh - moved)
    return Instant(angle, velocity, cosine, sine, sinh, versinh)


@njit(**INLINED)
def forcing_term(p, cosine):
    """f = u'' - u on one side of the base: eq. (4)."""
    return -1.0 - p.amplitude * cosine


@njit(**INLINED)
def exponentials(p, arc):
    """(c+, c-, a bound on the rounding error of either): u = c+ e^t + c- e^-t + 1 + beta cos eta."""
    place, rate = particular(p, arc.cosine, arc.sine)
    mean = arc.angle - 1.0 - place
    half = arc.velocity - rate
    error = (
        4.0 * ROUNDING * (abs(arc.angle) + abs(arc.velocity) + 1.0 + 2.0 * p.response * (1.0 + p.frequency))
    )
    return 0.5 * (mean + half), 0.5 * (mean - half), error
