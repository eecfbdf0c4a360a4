"""Harmonic base motion A cos(Omega tau + phi), eq. (3) of Yim & Lin (1991), and a piece of one, a pulse.

With the phase psi = Omega tau + phi, on side sigma of the base the forcing of the block is
sigma A cos psi = A cos eta. Here eta = psi on the positive side and psi + pi
on the negative side; (cosine, sine) are those of eta. The response to the forcing, the forced part of eq. (5), its sensitivities
and the sign changes of the forcing term are here, too.
"""

import math
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from rocking.kernels import contract
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import (
    SHORT,
    arccosine,
    circular,
    cosine_of,
    direction,
    exponential,
    fma,
    hyperbolic_tangent,
    sine_of,
)
from rocking.kernels.numerics.replace_fields import replacing

EXACT_TURN = Fraction("6.28318530717958647692528676655900576839433879875021")


class Cosine(NamedTuple):
    """Base acceleration A cos(Omega tau + phi), in normalised units.

    ``base_half`` and ``brace_half`` bound the *sign intervals* of an arc, on which the forcing term of the base (or
    brace) keeps its sign. The intervals meet where eta = +-half, with eta = psi (+ pi on the negative side). The bounds
    are infinite if the sign never changes.
    """

    amplitude: float
    frequency: float
    period: float
    phase: float
    per_frequency: float  # 1/Omega
    reciprocal: float  # 1/(1 + Omega**2)
    response: float  # beta = A/(1 + Omega**2)
    base_half: float
    brace_half: float
    # At the sign changes of the base's forcing term: 1 + beta cos eta and the absolute value of its
    # derivative. Lengths of the sign intervals, |eta| < half ("inside") and the other one ("outside").
    # e^+-length of the outer interval and of a whole forcing period.
    sign_change_displacement: float
    sign_change_velocity: float
    base_inside: float
    base_outside: float
    base_outside_growth: float
    base_outside_decay: float
    turn_growth: float
    turn_decay: float
    base_outside_tanh: float


@kernel
def stiffness(frequency):
    """Return 1 + Omega**2 in two parts: the rounded sum and its rounding error."""
    square = frequency * frequency
    total = 1.0 + square
    large, small = max(square, 1.0), min(square, 1.0)
    return total, (small - (total - large)) + fma(frequency, frequency, -square)


@kernel
def share(numerator, whole, rest):
    """Return numerator/(whole + rest), correctly rounded except for a rare error in the last place."""
    quotient = numerator / whole
    return quotient + (fma(-quotient, whole, numerator) - quotient * rest) / whole


@entry_point
def cosine_with(
    amplitude: float, frequency: float, period: float, phase: float, brace_angle: float
) -> Cosine:
    """Return the base motion under a block with braces.

    beta and 1/(1 + Omega**2) are rounded only once because every term of an arc contains them.
    """
    whole, rest = stiffness(frequency)
    response, reciprocal = share(amplitude, whole, rest), share(1.0, whole, rest)
    base_half = arccosine(-1.0 / amplitude) if amplitude > 1.0 else math.inf
    inside = 2.0 * base_half / frequency
    outside = max(2.0 * (math.pi - base_half) / frequency, 0.0)
    brace_half = (
        arccosine((brace_angle - 1.0) / amplitude) if abs(brace_angle - 1.0) < amplitude else math.inf
    )
    growth, turn_growth = exponential(min(outside, 700.0)), exponential(min(period, 700.0))
    return Cosine(
        amplitude,
        frequency,
        period,
        phase,
        1.0 / frequency,
        reciprocal,
        response,
        base_half,
        brace_half,
        1.0 - reciprocal,
        response * frequency * sine_of(base_half) if amplitude > 1.0 else 0.0,
        inside,
        outside,
        growth,
        1.0 / growth,
        turn_growth,
        1.0 / turn_growth,
        hyperbolic_tangent(outside),
    )


def within_a_turn(phase: float) -> float:
    """Reduce a phase by whole turns, with one rounding, so that later additions keep its last digits."""
    return (
        phase
        if abs(phase) <= EXACT_TURN
        else float(Fraction(phase) - round(Fraction(phase) / EXACT_TURN) * EXACT_TURN)
    )


@kernel
def phase_later(forcing, time):
    """Return the forcing phase at a time, within half a turn of 0."""
    phase = forcing.phase + forcing.frequency * time
    return phase - 2.0 * math.pi * round(phase / (2.0 * math.pi))


with_phase = replacing(Cosine, "phase")


class Pulse(NamedTuple):
    """Pulse: the whole cosine, and a base at rest."""

    duration: float
    during: Cosine
    after: Cosine
    # A (cos psi - Omega sin psi)/(1 + Omega**2) at the end
    end_response: float


@entry_point
def pulse_with(
    amplitude: float, frequency: float, phase: float, duration: float, brace_angle: float
) -> Pulse:
    """Return the base motion under a block with braces; the phase is one within a turn."""
    period = 2.0 * math.pi / frequency
    during = cosine_with(amplitude, frequency, period, phase, brace_angle)
    after = cosine_with(0.0, frequency, period, phase, brace_angle)
    psi = frequency * duration + phase
    end_response = during.response * (cosine_of(psi) - frequency * sine_of(psi))
    return Pulse(duration, during, after, end_response)


class HarmonicDrive(NamedTuple):
    """Cosine at one instant: eta is its phase psi on the positive side, psi + pi on the negative side; psi for a full block."""

    cosine: float  # of eta
    sine: float


class PulseDrive(NamedTuple):
    """Pulse at one instant: the time since its start, and cos eta and sin eta as for ``HarmonicDrive``."""

    time: float
    cosine: float  # 0 after the end, for a full block
    sine: float


class HarmonicConstants(NamedTuple):
    """Constants of an arc under a cosine or a pulse."""

    psi: float  # forcing phase at the start
    acceleration: float  # u'' there; 0 for a full block


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


@kernel(inline=True)
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


@kernel(inline=True)
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


@kernel(inline=True)
def harmonic_term(p, cosine):
    """Return f = u'' - u = -1 - A cos eta on one side of the base, eq. (4)."""
    return fma(-p.forcing.amplitude, cosine, -1.0)


@kernel(inline=True)
def forcing_rates(p, cosine, sine):
    """Return f' and f'' of ``harmonic_term``; each higher derivative is -Omega**2 times the last but one."""
    return (
        p.forcing.amplitude * p.forcing.frequency * sine,
        p.forcing.amplitude * p.forcing.frequency * p.forcing.frequency * cosine,
    )


@kernel(inline=True)
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


@kernel(inline=True)
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


@kernel(inline=True)
def particular(p, cosine, sine):
    """Return beta cos eta and its derivative: the bounded particular solution of u'' - u = -A cos eta."""
    return p.forcing.response * cosine, -p.forcing.response * p.forcing.frequency * sine


@kernel(inline=True)
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


@kernel(inline=True)
def next_sign_change(p, half, inside):
    """Return the time from one sign change to the next; ``inside`` says which sign interval lies between them."""
    return (2.0 * half if inside else TURN - 2.0 * half) * p.forcing.per_frequency


@body(contract.acceleration_size, None, Cosine, inline=True)
def acceleration_size(p, drive):
    """Provide ``contract.acceleration_size``."""
    return p.forcing.amplitude * abs(drive.cosine)


@body(contract.acceleration_change_bound, None, Cosine, inline=True)
def acceleration_change_bound(p, drive, time):
    """Provide ``contract.acceleration_change_bound``: |A cos(psi + x) - A cos psi| <= A (|sin psi| x + x^2/2)."""
    return change_of_cosine(p.forcing, drive.sine, time)


@kernel(inline=True)
def change_of_cosine(wave, sine, time):
    """Return an upper bound on the change of a cosine within the next ``time``."""
    x = wave.frequency * time
    return wave.amplitude * (abs(sine) * x + 0.5 * x * x)


@kernel(inline=True)
def response_sensitivities(p, cosine, sine, t, sinh, versinh, excess):
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
