"""Parameters of a system with any forcing: how they are made, and their union, in the order of the types of entry points."""

from rocking.kernels.forcing.full.parameters import (
    FullHarmonicParameters,
    FullSampledParameters,
    full_block,
    full_harmonic_parameters,
    full_sampled_parameters,
)
from rocking.kernels.forcing.harmonic.parameters import (
    HarmonicParameters,
    harmonic_parameters,
    row_of,
    within_a_turn,
)
from rocking.kernels.forcing.pulse.parameters import PulseParameters, pulse_parameters
from rocking.kernels.forcing.sampled.parameters import CYCLE, SampledParameters, sampled_parameters
from rocking.kernels.forcing.sampled.tables import Tables, tables_of
from rocking.kernels.parameters import BlockParameters

SystemParameters = (
    HarmonicParameters | SampledParameters | PulseParameters | FullHarmonicParameters | FullSampledParameters
)
FiniteParameters = SampledParameters | PulseParameters
"""Parameters of systems whose base motion ends."""

__all__ = [
    "CYCLE",
    "BlockParameters",
    "FiniteParameters",
    "FullHarmonicParameters",
    "FullSampledParameters",
    "HarmonicParameters",
    "PulseParameters",
    "SampledParameters",
    "SystemParameters",
    "Tables",
    "full_block",
    "full_harmonic_parameters",
    "full_sampled_parameters",
    "harmonic_parameters",
    "pulse_parameters",
    "row_of",
    "sampled_parameters",
    "tables_of",
    "within_a_turn",
]
