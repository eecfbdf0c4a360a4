"""Harmonic base acceleration A cos(Omega tau + phi), eq. (3) of Yim & Lin (1991).

An arc uses its forcing through these functions alone; another forcing is another module with the same
functions. They give the forcing at the start of an arc, the particular solution from rest, and the sign
changes of a forcing term. On side sigma of the base the forcing of the block is sigma A cos psi = A cos eta.
Here eta = psi on the positive side and psi + pi on the negative side; (cosine, sine) are those of eta.
"""

import math
from typing import NamedTuple

import numpy as np

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.numerics.elementary import SHORT, circular, direction, fma

TURN = 2.0 * math.pi


class ForcedStep(NamedTuple):
    """Effect of the forcing on every arc within a time, for unit amplitude.

    It holds the response to each of cos eta and sin eta at the start.
    """

    near: bool  # shorter than about a third of a forcing period
    sin_x: float
    versine: float
    in_phase: float
    quadrature: float
    displacement: float
    forced_velocity: float


@njit(**INTERNAL_INLINE)
def clock(frequency, phase, side, time):
    """Evaluate the forcing phase at a time within the cycle.

    Returns
    -------
    tuple of (float, float, float, float, bool)
        cos eta, sin eta, psi and 1 - |cos eta|.
        Whether 1 - |cos eta| is accurate relative to its size.
    """
    psi = frequency * time + phase
    sine, cosine, versine, exact = direction(psi)
    return side * cosine, side * sine, psi, versine, exact


@njit(**INTERNAL_INLINE)
def forcing_at(p, side, time, angle):
    """Evaluate the forcing and the acceleration u'' at a time within the cycle and an angle u.

    Returns
    -------
    tuple of (float, float, float, float)
        cos eta, sin eta and psi.
        u'' = u - 1 - A cos eta, accurate even if it is close to 0.
    """
    cosine, sine, psi, versine, exact = clock(p.forcing.frequency, p.forcing.phase, side, time)
    above = angle - 1.0
    acceleration = fma(-p.forcing.amplitude, cosine, above)
    if exact:
        most = math.copysign(p.forcing.amplitude, cosine)
        acceleration = fma(most, versine, above - most)
    return cosine, sine, psi, acceleration


@njit(**INTERNAL_INLINE)
def forcing_term(p, cosine):
    """Return f = u'' - u = -1 - A cos eta on one side of the base, eq. (4)."""
    return fma(-p.forcing.amplitude, cosine, -1.0)


@njit(**INTERNAL_INLINE)
def forcing_rates(p, cosine, sine):
    """Return f' and f'' of ``forcing_term``; each higher derivative is -Omega**2 times the last but one."""
    return (
        p.forcing.amplitude * p.forcing.frequency * sine,
        p.forcing.amplitude * p.forcing.frequency * p.forcing.frequency * cosine,
    )


@njit(**INTERNAL_INLINE)
def forced_step(p, t, sinh, versinh, excess, higher):
    """Return the ``ForcedStep`` of a time t."""
    sin_x, versine, lag, deficit = circular(p.forcing.frequency, t)
    in_phase = versinh + versine
    quadrature = fma(p.forcing.frequency, excess, lag)
    near = p.forcing.frequency * t < SHORT
    displacement, forced_velocity = in_phase, fma(p.forcing.frequency, sin_x, sinh)
    if near:
        displacement = -fma(p.forcing.frequency * p.forcing.frequency, higher, deficit)
        forced_velocity = -p.forcing.frequency * quadrature
    return ForcedStep(near, sin_x, versine, in_phase, quadrature, displacement, forced_velocity)


@njit(**INTERNAL_INLINE)
def forced_response(p, cosine, sine, above, acceleration, forced_step):
    """Evaluate the response to the forcing a time t later, without cancellation.

    u'' - u is split into a constant part (``steady``) and a remainder, which moves u by G:

        G'' - G = u0 - 1 - A cos eta - steady, G = G' = 0 at t = 0.

    Within a third of a forcing period ``steady`` is the ``acceleration`` at the start, later u0 - 1
    (``above``). In both cases G is a sum of positive functions, so that no larger terms cancel.

    Returns
    -------
    tuple of (float, float, float, float, float)
        The steady part, G and G'.
        cos eta and sin eta at the end.
    """
    near, sin_x, versine, in_phase, quadrature, displacement, forced_velocity = forced_step
    displaced = p.forcing.response * fma(sine, quadrature, -cosine * displacement)
    moved = p.forcing.response * fma(p.forcing.frequency * sine, in_phase, -cosine * forced_velocity)
    return (
        acceleration if near else above,
        displaced,
        moved,
        cosine - fma(cosine, versine, sine * sin_x),
        sine - fma(sine, versine, -cosine * sin_x),
    )


@njit(**INTERNAL_INLINE)
def particular(p, cosine, sine):
    """Return beta cos eta and its derivative: the bounded particular solution of u'' - u = -A cos eta."""
    return p.forcing.response * cosine, -p.forcing.response * p.forcing.frequency * sine


@njit(**INTERNAL_INLINE)
def first_sign_change(p, side, psi, centre, half):
    """Find the first sign change, eta = centre +- half, at or after the present time.

    Returns
    -------
    tuple of (float, bool)
        Time to the sign change.
        Whether eta lies within ``half`` of the centre until then.
    """
    zeta = psi - centre + half
    if side < 0:
        zeta += math.pi
    zeta -= TURN * np.floor(zeta * (1.0 / TURN))
    if zeta >= TURN:
        zeta = 0.0  # rounded onto the first sign change: the next interval has started
    inside = zeta < 2.0 * half
    return ((2.0 * half if inside else TURN) - zeta) * p.forcing.per_frequency, inside


@njit(**INTERNAL_INLINE)
def next_sign_change(p, half, inside):
    """Return the time from one sign change to the next; ``inside`` says which sign interval lies between them."""
    return (2.0 * half if inside else TURN - 2.0 * half) * p.forcing.per_frequency


@njit(**INTERNAL_INLINE)
def acceleration_change_bound(p, sine, time):
    """Return an upper bound on the change of the base acceleration within the next ``time``."""
    x = p.forcing.frequency * time
    return p.forcing.amplitude * (abs(sine) * x + 0.5 * x * x)


@njit(**INTERNAL_INLINE)
def sensitivities(p, cosine, sine, t, sinh, versinh, excess):
    """Return the derivatives of the response by amplitude, starting phase and frequency.

    Returns
    -------
    tuple of six floats
        F_A, F'_A, F_psi, F'_psi, F_Omega and F'_Omega.
    """
    sin_x, versine, lag, _ = circular(p.forcing.frequency, t)
    frequency, k = p.forcing.frequency, p.forcing.reciprocal
    in_phase = k * (versinh + versine)
    quadrature = k * (frequency * excess + lag)
    in_phase_rate = k * (sinh + frequency * sin_x)
    turned = -2.0 * frequency * k
    in_phase_f = k * t * sin_x + turned * in_phase
    quadrature_f = k * (excess + t * versine) + turned * quadrature
    in_phase_rate_f = k * (sin_x + frequency * t * (1.0 - versine)) + turned * in_phase_rate
    quadrature_rate_f = in_phase + frequency * in_phase_f
    a = p.forcing.amplitude
    return (
        cosine * in_phase - sine * quadrature,
        cosine * in_phase_rate - sine * frequency * in_phase,
        -a * (sine * in_phase + cosine * quadrature),
        -a * (sine * in_phase_rate + cosine * frequency * in_phase),
        a * (cosine * in_phase_f - sine * quadrature_f),
        a * (cosine * in_phase_rate_f - sine * quadrature_rate_f),
    )
