"""Parameters of a system with any forcing: how they are made, and their union, in the order of the types of entry points."""

from rocking.kernels.forcing.harmonic.parameters import (
    HarmonicParameters,
    harmonic_parameters,
    row_of,
    within_a_turn,
)
from rocking.kernels.forcing.sampled.parameters import CYCLE, SampledParameters, sampled_parameters
from rocking.kernels.forcing.sampled.tables import Tables, tables_of

SystemParameters = HarmonicParameters | SampledParameters
FiniteParameters = SampledParameters
"""Parameters of systems whose base motion ends."""

__all__ = [
    "CYCLE",
    "FiniteParameters",
    "HarmonicParameters",
    "SampledParameters",
    "SystemParameters",
    "Tables",
    "harmonic_parameters",
    "row_of",
    "sampled_parameters",
    "tables_of",
    "within_a_turn",
]
