"""One arc of rocking in closed form, eqs (4)-(5) of Yim & Lin (1991), free of cancellation on short arcs.

On side sigma = sign(Theta) work with u = sigma Theta >= 0: u'' - u = f = -1 - A cos eta. From (u0, v0) at eta0

    u = u0 + v0 sinh t + steady (cosh t - 1) + G(t),

``steady`` a steady part of u0 - 1 - A cos eta, G the response from rest to the remainder (``harmonic.forced_response``).
The exponential form u = c+ e^t + c- e^-t + 1 + beta cos eta serves bounds.
"""

from typing import NamedTuple

from numba import njit

from rocking.kernels.compile_options import INTERNAL_INLINE, KERNEL, KERNEL_INLINE
from rocking.kernels.forcing.harmonic import (
    ForcedStep,
    forced_response,
    forced_step,
    forcing_at,
    forcing_term,
    particular,
)
from rocking.kernels.numerics.elementary import hyperbolic

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
    acceleration: float  # u''


class Instant(NamedTuple):
    """What an arc is at one instant: u, u', the forcing there, and the hyperbolic functions of the time since its start."""

    angle: float
    risen: float  # u - u0, to relative accuracy
    velocity: float
    cosine: float
    sine: float
    sinh: float
    versinh: float  # cosh t - 1


class Propagator(NamedTuple):
    """A time, and what carries an arc on by it: the same for every arc, so that a motion which repeats itself needs it but once."""

    time: float
    sinh: float
    versinh: float
    forced_step: ForcedStep


# No time.
NONE_YET = Propagator(0.0, 0.0, 0.0, ForcedStep(True, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


@njit(**KERNEL_INLINE)
def arc_from(p, side, start, angle, velocity):
    """The arc that leaves (u, u') = (angle, velocity) on ``side`` at time ``start`` within the cycle."""
    cosine, sine, psi, acceleration = forcing_at(p, side, start, angle)
    return Arc(side, start, angle, velocity, cosine, sine, psi, acceleration)


@njit(**INTERNAL_INLINE)
def arc_after(p, side, start, angle, velocity, cosine, sine):
    """``arc_from`` where the forcing is known already."""
    acceleration = angle + forcing_term(p, cosine)
    return Arc(side, start, angle, velocity, cosine, sine, p.frequency * start + p.phase, acceleration)


@njit(**INTERNAL_INLINE)
def shift_clock(arc, time):
    """The same arc as seen from ``time`` later: its start lies so much earlier."""
    return Arc(
        arc.side, arc.start - time, arc.angle, arc.velocity, arc.cosine, arc.sine, arc.psi, arc.acceleration
    )


@njit(**INTERNAL_INLINE)
def propagator_of(p, t):
    """The lapse of a time t >= 0."""
    sinh, versinh, excess, higher = hyperbolic(t)
    return Propagator(t, sinh, versinh, forced_step(p, t, sinh, versinh, excess, higher))


@njit(**KERNEL)
def propagator_or_none(p, t):
    """``propagator_of`` where it is rarely needed."""
    return propagator_of(p, t) if t > 0.0 else NONE_YET


@njit(**INTERNAL_INLINE)
def evaluate(p, arc, t):
    """The arc a time t >= 0 after its start."""
    return propagate(p, arc, propagator_of(p, t))


@njit(**INTERNAL_INLINE)
def propagate(p, arc, propagator):
    """The arc a lapse after its start: eq. (5)."""
    _, sinh, versinh, forced_step = propagator
    steady, displaced, moved, cosine, sine = forced_response(
        p, arc.cosine, arc.sine, arc.angle - 1.0, arc.acceleration, forced_step
    )
    risen = arc.velocity * sinh + steady * versinh + displaced
    velocity = arc.velocity + (arc.velocity * versinh + steady * sinh + moved)
    return Instant(arc.angle + risen, risen, velocity, cosine, sine, sinh, versinh)


@njit(**INTERNAL_INLINE)
def within_reach(p, angle):
    """An angle as the base and the braces allow it: near an event rounding may put it beyond."""
    return min(max(angle, 0.0), p.brace_angle)


@njit(**INTERNAL_INLINE)
def exponentials(p, arc):
    """(c+, c-, a bound on the rounding error of either): u = c+ e^t + c- e^-t + 1 + beta cos eta."""
    displacement, forced_velocity = particular(p, arc.cosine, arc.sine)
    mean = arc.angle - 1.0 - displacement
    half = arc.velocity - forced_velocity
    error = (
        4.0 * ROUNDING * (abs(arc.angle) + abs(arc.velocity) + 1.0 + 2.0 * p.response * (1.0 + p.frequency))
    )
    return 0.5 * (mean + half), 0.5 * (mean - half), error
