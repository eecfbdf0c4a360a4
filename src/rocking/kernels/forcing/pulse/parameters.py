"""Parameters of a system whose base acceleration is A cos(Omega tau + phi) up to its end, and 0 afterwards."""

import math
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.forcing.harmonic.parameters import HarmonicParameters, make, within_a_turn
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


@njit(**INTERNAL)
def make_pulse(amplitude, frequency, phase, duration, cycle_length, block):
    """Return the parameters of a block under a pulse; the phase is one within a turn."""
    period = 2.0 * math.pi / frequency
    during = make(
        amplitude, frequency, period, phase, block.restitution, block.brace_angle, block.brace_restitution
    )
    after = make(0.0, frequency, period, phase, block.restitution, block.brace_angle, block.brace_restitution)
    psi = frequency * duration + phase
    end_response = during.forcing.response * (math.cos(psi) - frequency * math.sin(psi))
    return PulseParameters(block, PulseForcing(duration, during, after, end_response), Clock(cycle_length))


@njit(**INTERNAL)
def with_pulse(p, pulse):
    """Provide ``finite.with_pulse``."""
    block = BlockParameters(pulse.restitution, math.inf, 1.0)
    return make_pulse(pulse.amplitude, pulse.frequency, pulse.phase, pulse.duration, pulse.duration, block)


@entry_point(**KERNEL)
def make_pulse_plain(
    amplitude: float,
    frequency: float,
    phase: float,
    duration: float,
    cycle_length: float,
    block: BlockParameters,
) -> PulseParameters:
    """Return ``make_pulse``; entry point for Python."""
    return make_pulse(amplitude, frequency, phase, duration, cycle_length, block)


def pulse_parameters(
    amplitude: float,
    frequency: float,
    phase: float,
    duration: float,
    cycle_length: float,
    block: BlockParameters,
) -> PulseParameters:
    """Return the parameters of a system under a pulse."""
    values = amplitude, frequency, within_a_turn(phase), duration, cycle_length
    return make_pulse_plain(*map(float, values), BlockParameters(*map(float, block)))
