"""Parameters of a system with any forcing: how they are made, and their union, in the order of the types of entry points."""

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

SystemParameters = HarmonicParameters | SampledParameters | PulseParameters
FiniteParameters = SampledParameters | PulseParameters
"""Parameters of systems whose base motion ends."""

__all__ = [
    "CYCLE",
    "BlockParameters",
    "FiniteParameters",
    "HarmonicParameters",
    "PulseParameters",
    "SampledParameters",
    "SystemParameters",
    "Tables",
    "harmonic_parameters",
    "pulse_parameters",
    "row_of",
    "sampled_parameters",
    "tables_of",
    "within_a_turn",
]
