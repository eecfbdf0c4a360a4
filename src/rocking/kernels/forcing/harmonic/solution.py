"""Closed form of an arc, eqs (4)-(5) of Yim & Lin (1991), free of cancellation on short arcs.

On side sigma = sign(Theta) the variable is u = sigma Theta >= 0: u'' - u = f = -1 - A cos eta. From (u0, v0)
at eta0

    u = u0 + v0 sinh t + steady (cosh t - 1) + G(t).

Here ``steady`` is a constant part of u0 - 1 - A cos eta, and G the response from rest to the remainder
(``harmonic.forced_response``). The exponential form u = c+ e^t + c- e^-t + 1 + beta cos eta serves bounds.
"""

from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL_INLINE, KERNEL, KERNEL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.arc import Arc, Instant
from rocking.kernels.forcing.drives import HarmonicConstants, HarmonicDrive
from rocking.kernels.forcing.harmonic.acceleration import (
    ForcedStep,
    forced_response,
    forced_step,
    forcing_at,
    forcing_term,
    particular,
)
from rocking.kernels.numerics.elementary import fma, hyperbolic

ROUNDING = 2.0**-53


class Propagator(NamedTuple):
    """Propagation coefficients for a time step.

    They depend on the system and the time only, so that a periodic motion computes them once.
    """

    time: float
    sinh: float
    versinh: float
    forced_step: ForcedStep


# Propagator of no time step.
NONE_YET = Propagator(0.0, 0.0, 0.0, ForcedStep(True, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


@njit(**KERNEL_INLINE)
def arc_from(p, side, start, angle, velocity):
    """Return the arc that starts at (u, u') = (angle, velocity) on ``side`` at time ``start`` within the cycle."""
    cosine, sine, psi, acceleration = forcing_at(p, side, start, angle)
    return Arc(
        side, start, angle, velocity, HarmonicDrive(cosine, sine), HarmonicConstants(psi, acceleration)
    )


@njit(**INTERNAL_INLINE)
def arc_with(p, side, start, angle, velocity, drive):
    """Return the arc that starts at (angle, velocity), where cos eta and sin eta are known already."""
    acceleration = angle + forcing_term(p, drive.cosine)
    psi = p.forcing.frequency * start + p.forcing.phase
    return Arc(side, start, angle, velocity, drive, HarmonicConstants(psi, acceleration))


@njit(**INTERNAL_INLINE)
def propagator_of(p, t):
    """Return the propagator of a time t >= 0."""
    sinh, versinh, excess, higher = hyperbolic(t)
    return Propagator(t, sinh, versinh, forced_step(p, t, sinh, versinh, excess, higher))


@njit(**KERNEL)
def propagator_or_none(p, t):
    """Return the propagator of a time t > 0, else NONE_YET; not inlined, because it is rarely needed."""
    return propagator_of(p, t) if t > 0.0 else NONE_YET


@njit(**INTERNAL_INLINE)
def evaluate(p, arc, t):
    """Return the state of an arc at a time t >= 0 after its start."""
    return propagate(p, arc, propagator_of(p, t))


@njit(**INTERNAL_INLINE)
def propagate(p, arc, propagator):
    """Return the state of an arc after the time step of a propagator, eq. (5)."""
    _, sinh, versinh, forced_step = propagator
    steady, displaced, moved, cosine, sine = forced_response(
        p, arc.drive.cosine, arc.drive.sine, arc.angle - 1.0, arc.constants.acceleration, forced_step
    )
    risen = fma(arc.velocity, sinh, fma(steady, versinh, displaced))
    velocity = arc.velocity + fma(arc.velocity, versinh, fma(steady, sinh, moved))
    return Instant(arc.angle + risen, risen, velocity, HarmonicDrive(cosine, sine), sinh, versinh)


@njit(**INTERNAL_INLINE)
def exponentials(p, arc):
    """Return the coefficients of u = c+ e^t + c- e^-t + 1 + beta cos eta.

    Returns
    -------
    tuple of (float, float, float)
        c+ and c-.
        An upper bound on the rounding error of either.
    """
    displacement, forced_velocity = particular(p, arc.drive.cosine, arc.drive.sine)
    mean = arc.angle - 1.0 - displacement
    half = arc.velocity - forced_velocity
    error = (
        4.0
        * ROUNDING
        * (abs(arc.angle) + abs(arc.velocity) + 1.0 + 2.0 * p.forcing.response * (1.0 + p.forcing.frequency))
    )
    return 0.5 * (mean + half), 0.5 * (mean - half), error
