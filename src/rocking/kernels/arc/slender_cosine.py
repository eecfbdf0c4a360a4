"""Closed form of an arc, eq. (5) of Yim & Lin (1991), the solution of eq. (4), free of cancellation on short arcs.

``base.cosine`` defines A, eta and beta. On side sigma = sign(Theta) the variable
is u = sigma Theta >= 0: u'' - u = f = -1 - A cos eta. From (u0, v0)
at eta0

    u = u0 + v0 sinh t + steady (cosh t - 1) + G(t).

Here ``steady`` is a constant part of u0 - 1 - A cos eta, and G the response from rest to the remainder
(``forced_response``). The exponential form u = c+ e^t + c- e^-t + 1 + beta cos eta serves bounds.
"""

from typing import NamedTuple

from rocking.kernels import contract
from rocking.kernels.arc.arc import Arc, Instant
from rocking.kernels.base.cosine import (
    Cosine,
    ForcedStep,
    HarmonicConstants,
    HarmonicDrive,
    forced_response,
    forced_step,
    forcing_at,
    harmonic_term,
    particular,
    response_sensitivities,
)
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import fma, hyperbolic
from rocking.kernels.system import Slender

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


@kernel(inline=True)
def arc_from(p, side, start, angle, velocity):
    """Return the arc that starts at (u, u') = (angle, velocity) on ``side`` at time ``start`` within the cycle."""
    cosine, sine, psi, acceleration = forcing_at(p, side, start, angle)
    return Arc(
        side, start, angle, velocity, HarmonicDrive(cosine, sine), HarmonicConstants(psi, acceleration)
    )


@kernel(inline=True)
def arc_with(p, side, start, angle, velocity, drive):
    """Return the arc that starts at (angle, velocity), where cos eta and sin eta are known already."""
    acceleration = angle + harmonic_term(p, drive.cosine)
    psi = p.forcing.frequency * start + p.forcing.phase
    return Arc(side, start, angle, velocity, drive, HarmonicConstants(psi, acceleration))


@kernel(inline=True)
def propagator_of(p, t):
    """Return the propagator of a time t >= 0."""
    sinh, versinh, excess, higher = hyperbolic(t)
    return Propagator(t, sinh, versinh, forced_step(p, t, sinh, versinh, excess, higher))


@body(contract.guess_from, Slender, Cosine)
def propagator_or_none(p, t):
    """Return the propagator of a time t > 0, else NONE_YET; not inlined, because it is rarely needed."""
    return propagator_of(p, t) if t > 0.0 else NONE_YET


@body(contract.evaluate, Slender, Cosine, inline=True)
def evaluate(p, arc, t):
    """Return the state of an arc at a time t >= 0 after its start, eq. (5)."""
    return propagate(p, arc, propagator_of(p, t))


@kernel(inline=True)
def propagate(p, arc, propagator):
    """Return the state of an arc after the time step of a propagator, eq. (5)."""
    _, sinh, versinh, forced_step = propagator
    steady, displaced, moved, cosine, sine = forced_response(
        p, arc.drive.cosine, arc.drive.sine, arc.angle - 1.0, arc.constants.acceleration, forced_step
    )
    risen = fma(arc.velocity, sinh, fma(steady, versinh, displaced))
    velocity = arc.velocity + fma(arc.velocity, versinh, fma(steady, sinh, moved))
    return Instant(arc.angle + risen, risen, velocity, HarmonicDrive(cosine, sine), sinh, versinh)


@kernel(inline=True)
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


@body(contract.arc_at, Slender, Cosine, inline=True)
def arc_at(p, side, cycle, start, angle, velocity):
    """Provide ``contract.arc_at``: each cycle is the same."""
    return arc_from(p, side, start, angle, velocity)


@body(contract.arc_renewed, Slender, Cosine, inline=True)
def arc_renewed(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_renewed``: the clock is more accurate than the event."""
    return arc_from(p, side, start, angle, velocity)


@body(contract.arc_after, Slender, Cosine, inline=True)
def arc_after(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_after``: eta turns by pi with the side."""
    turned = side * coming.side
    drive = HarmonicDrive(turned * coming.drive.cosine, turned * coming.drive.sine)
    return arc_with(p, side, start, angle, velocity, drive)


@body(contract.resynchronise, Slender, Cosine, inline=True)
def resynchronise(p, arc):
    """Provide ``contract.resynchronise``."""
    return arc_from(p, arc.side, arc.start, arc.angle, arc.velocity)


@body(contract.forcing_term, Slender, Cosine, inline=True)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``: eta contains the side."""
    return harmonic_term(p, drive.cosine)


@body(contract.sensitivities, Slender, Cosine, inline=True)
def sensitivities(p, arc, t, sinh, versinh, excess):
    """Provide ``contract.sensitivities``."""
    return response_sensitivities(p, arc.drive.cosine, arc.drive.sine, t, sinh, versinh, excess)
