"""Parameters of a system with harmonic forcing, with derived quantities that depend on the system alone."""

import math
from fractions import Fraction
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.parameters import BlockParameters, Clock

TURN = Fraction("6.28318530717958647692528676655900576839433879875021")


class HarmonicForcing(NamedTuple):
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


class HarmonicParameters(NamedTuple):
    """Parameters of a block with harmonic forcing; a cycle of the clock is a forcing period."""

    block: BlockParameters
    forcing: HarmonicForcing
    clock: Clock


@njit(**INTERNAL)
def stiffness(frequency):
    """Return 1 + Omega**2 in two parts: the rounded sum and its rounding error."""
    square = frequency * frequency
    total = 1.0 + square
    large, small = max(square, 1.0), min(square, 1.0)
    return total, (small - (total - large)) + fma(frequency, frequency, -square)


@njit(**INTERNAL)
def share(numerator, whole, rest):
    """Return numerator/(whole + rest), correctly rounded except for a rare error in the last place."""
    quotient = numerator / whole
    return quotient + (fma(-quotient, whole, numerator) - quotient * rest) / whole


@njit(**INTERNAL)
def make(amplitude, frequency, period, phase, restitution, brace_angle, brace_restitution):
    """Return the parameters of a system.

    beta and 1/(1 + Omega**2) are rounded only once because every term of an arc contains them.
    """
    whole, rest = stiffness(frequency)
    response, reciprocal = share(amplitude, whole, rest), share(1.0, whole, rest)
    base_half = math.acos(-1.0 / amplitude) if amplitude > 1.0 else math.inf
    inside = 2.0 * base_half / frequency
    outside = max(2.0 * (math.pi - base_half) / frequency, 0.0)
    brace_half = (
        math.acos((brace_angle - 1.0) / amplitude) if abs(brace_angle - 1.0) < amplitude else math.inf
    )
    growth, turn_growth = math.exp(min(outside, 700.0)), math.exp(min(period, 700.0))
    forcing = HarmonicForcing(
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
        response * frequency * math.sin(base_half) if amplitude > 1.0 else 0.0,
        inside,
        outside,
        growth,
        1.0 / growth,
        turn_growth,
        1.0 / turn_growth,
        math.tanh(outside),
    )
    block = BlockParameters(restitution, brace_angle, brace_restitution)
    return HarmonicParameters(block, forcing, Clock(period))


@njit(**INTERNAL)
def parameters_from_row(row):
    """Return the parameters of a system from a row that holds the arguments of ``make``."""
    return make(row[0], row[1], row[2], row[3], row[4], row[5], row[6])


@njit(**INTERNAL)
def with_row(p, row):
    """Provide ``periodic.with_row``."""
    return parameters_from_row(row)


@entry_point(**KERNEL)
def make_plain(
    amplitude: float,
    frequency: float,
    period: float,
    phase: float,
    restitution: float,
    brace_angle: float,
    brace_restitution: float,
) -> HarmonicParameters:
    """Return ``make``; entry point for Python."""
    return make(amplitude, frequency, period, phase, restitution, brace_angle, brace_restitution)


def harmonic_parameters(
    amplitude: float,
    frequency: float,
    period: float,
    phase: float,
    restitution: float,
    brace_angle: float = math.inf,
    brace_restitution: float = 1.0,
) -> HarmonicParameters:
    """Return the parameters of a system with harmonic forcing."""
    values = amplitude, frequency, period, within_a_turn(phase), restitution, brace_angle, brace_restitution
    return make_plain(*map(float, values))


def within_a_turn(phase: float) -> float:
    """Reduce a phase by whole turns, with one rounding, so that later additions keep its last digits."""
    return phase if abs(phase) <= TURN else float(Fraction(phase) - round(Fraction(phase) / TURN) * TURN)


@njit(**INTERNAL)
def phase_later(forcing, time):
    """Return the forcing phase at a time, within half a turn of 0."""
    phase = forcing.phase + forcing.frequency * time
    return phase - 2.0 * math.pi * round(phase / (2.0 * math.pi))


@njit(**INTERNAL)
def later(p, time):
    """Provide ``periodic.later``."""
    return at_phase(p, phase_later(p.forcing, time))


with_phase = replacing(HarmonicForcing, "phase")


@njit(**INTERNAL)
def at_phase(p, phase):
    """Return the system with a different forcing phase at time 0."""
    return HarmonicParameters(p.block, with_phase(p.forcing, phase), p.clock)
