"""The numbers a kernel reads: one flat tuple a system, with what depends on the system alone worked out once."""

import math
from fractions import Fraction
from typing import NamedTuple


class HarmonicParameters(NamedTuple):
    """A block shaken by A cos(Omega tau + phi), in normalised units; ``brace_angle`` is infinite where there are no braces.

    ``base_half`` and ``brace_half`` bound the *stretches* of an arc, on which the forcing term of the base (or brace) keeps its sign: with
    eta = psi + (pi on the negative side) they are cut where eta = +-half; infinite where the sign never changes.
    """

    amplitude: float
    frequency: float
    period: float
    phase: float
    restitution: float
    brace_angle: float
    brace_restitution: float
    reciprocal: float  # 1/(1 + Omega**2)
    response: float  # beta = A/(1 + Omega**2)
    base_half: float
    brace_half: float


def harmonic_parameters(
    amplitude: float,
    frequency: float,
    period: float,
    phase: float,
    restitution: float,
    brace_angle: float = math.inf,
    brace_restitution: float = 1.0,
) -> HarmonicParameters:
    """The tuple of a harmonic forcing; beta and 1/(1 + Omega**2) rounded once, since every term of an arc carries them."""
    stiffness = 1 + Fraction(frequency) ** 2
    return HarmonicParameters(
        amplitude,
        frequency,
        period,
        phase,
        restitution,
        brace_angle,
        brace_restitution,
        float(1 / stiffness),
        float(Fraction(amplitude) / stiffness),
        math.acos(-1.0 / amplitude) if amplitude > 1.0 else math.inf,
        math.acos((brace_angle - 1.0) / amplitude) if abs(brace_angle - 1.0) < amplitude else math.inf,
    )
