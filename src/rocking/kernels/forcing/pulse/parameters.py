"""Parameters of a system whose base acceleration is A cos(Omega tau + phi) up to its end, and 0 afterwards."""

import math
from typing import NamedTuple

from rocking.kernels.forcing.harmonic.parameters import HarmonicParameters, harmonic_parameters
from rocking.kernels.parameters import BlockParameters, Clock


class PulseForcing(NamedTuple):
    """Pulse: the same block under the whole cosine, and on a base at rest."""

    duration: float
    during: HarmonicParameters
    after: HarmonicParameters
    # A (cos psi - Omega sin psi)/(1 + Omega**2) at the end
    end_response: float


class PulseParameters(NamedTuple):
    """Parameters of a block under a pulse."""

    block: BlockParameters
    forcing: PulseForcing
    clock: Clock


def pulse_parameters(
    amplitude: float,
    frequency: float,
    phase: float,
    duration: float,
    cycle_length: float,
    block: BlockParameters,
) -> PulseParameters:
    """Return the parameters of a system under a pulse."""
    period = math.tau / frequency
    during, after = (harmonic_parameters(a, frequency, period, phase, *block) for a in (amplitude, 0.0))
    psi = frequency * duration + phase
    end_response = during.forcing.response * (math.cos(psi) - frequency * math.sin(psi))
    forcing = PulseForcing(float(duration), during, after, end_response)
    return PulseParameters(during.block, forcing, Clock(float(cycle_length)))
