"""Parameters of a system with any forcing: how they are made, and their union, in the order of the types of entry points."""

from collections.abc import Sequence

from rocking.kernels.forcing.full.parameters import (
    FullHarmonicParameters,
    FullPulseParameters,
    FullSampledParameters,
    full_block,
    full_harmonic_parameters,
    full_pulse_parameters,
    full_sampled_parameters,
)
from rocking.kernels.forcing.harmonic.parameters import (
    HarmonicParameters,
    harmonic_parameters,
    within_a_turn,
)
from rocking.kernels.forcing.pulse.parameters import PulseParameters, pulse_parameters
from rocking.kernels.forcing.sampled.parameters import CYCLE, SampledParameters, sampled_parameters
from rocking.kernels.forcing.sampled.tables import Tables, tables_of
from rocking.kernels.parameters import BlockParameters

SystemParameters = (
    HarmonicParameters
    | SampledParameters
    | PulseParameters
    | FullHarmonicParameters
    | FullSampledParameters
    | FullPulseParameters
)
PeriodicParameters = HarmonicParameters | FullHarmonicParameters
"""Parameters of systems whose base motion is periodic."""
AnySampledParameters = SampledParameters | FullSampledParameters
AnyPulseParameters = PulseParameters | FullPulseParameters
FiniteParameters = SampledParameters | PulseParameters | FullSampledParameters | FullPulseParameters
"""Parameters of systems whose base motion ends."""


def parameters_of_row(row: Sequence[float]) -> PeriodicParameters:
    """Return the parameters of a system with harmonic forcing from a row of a survey.

    It holds amplitude, frequency, period, phase, restitution, angle and restitution of the braces, and the critical angle in
    rad. A slender block has the critical angle 0.
    """
    *wave, restitution, brace_angle, brace_restitution, critical_angle = row
    if critical_angle == 0.0:
        return harmonic_parameters(*wave, restitution, brace_angle, brace_restitution)
    return full_harmonic_parameters(
        full_block(restitution, critical_angle, brace_angle, brace_restitution), *wave
    )


def row_of(p: PeriodicParameters) -> tuple[float, ...]:
    """Return the row from which ``parameters_of_row`` makes the same parameters."""
    forcing, block = p.forcing, p.block
    angle = block.critical_angle if isinstance(p, FullHarmonicParameters) else 0.0
    return (
        forcing.amplitude,
        forcing.frequency,
        forcing.period,
        forcing.phase,
        block.restitution,
        block.brace_angle,
        block.brace_restitution,
        angle,
    )


__all__ = [
    "CYCLE",
    "AnyPulseParameters",
    "AnySampledParameters",
    "BlockParameters",
    "FiniteParameters",
    "FullHarmonicParameters",
    "FullPulseParameters",
    "FullSampledParameters",
    "HarmonicParameters",
    "PeriodicParameters",
    "PulseParameters",
    "SampledParameters",
    "SystemParameters",
    "Tables",
    "full_block",
    "full_harmonic_parameters",
    "full_pulse_parameters",
    "full_sampled_parameters",
    "harmonic_parameters",
    "parameters_of_row",
    "pulse_parameters",
    "row_of",
    "sampled_parameters",
    "tables_of",
    "within_a_turn",
]
