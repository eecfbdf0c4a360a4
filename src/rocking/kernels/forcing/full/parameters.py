"""Parameters of the full block, with a harmonic and with a sampled base acceleration."""

import math
from typing import NamedTuple

from rocking.kernels.forcing.harmonic.parameters import HarmonicParameters, harmonic_parameters
from rocking.kernels.forcing.sampled.parameters import SampledForcing, SampledParameters
from rocking.kernels.forcing.sampled.tables import Tables
from rocking.kernels.parameters import BlockParameters, Clock


class FullBlock(NamedTuple):
    """Block of any slenderness, without braces."""

    restitution: float
    brace_angle: float  # infinite
    brace_restitution: float
    critical_angle: float  # alpha
    sine: float
    cosine: float
    press: float  # sin(alpha)/alpha: acceleration back to the base, without base motion


class FullCosine(NamedTuple):
    """Harmonic base acceleration, and the slender system that rests as long as the full one does."""

    amplitude: float
    frequency: float
    phase: float
    resting: HarmonicParameters


class FullHarmonicParameters(NamedTuple):
    """Parameters of the full block with harmonic forcing."""

    block: FullBlock
    forcing: FullCosine
    clock: Clock


class FullSamples(NamedTuple):
    """Sampled base acceleration, and the slender system that rests as long as the full one does."""

    scale: float
    tables: Tables
    resting: SampledParameters


class FullSampledParameters(NamedTuple):
    """Parameters of the full block with a sampled base acceleration."""

    block: FullBlock
    forcing: FullSamples
    clock: Clock


def full_block(restitution: float, critical_angle: float) -> FullBlock:
    """Return the parameters of a block with a critical angle in rad."""
    sine = math.sin(critical_angle)
    return FullBlock(
        restitution, math.inf, 1.0, critical_angle, sine, math.cos(critical_angle), sine / critical_angle
    )


def lift_off_level(block: FullBlock) -> float:
    """Return the size of the base acceleration at which the block lifts off, tan(alpha)/alpha, in units of g alpha."""
    return math.tan(block.critical_angle) / block.critical_angle


def full_harmonic_parameters(
    block: FullBlock, amplitude: float, frequency: float, period: float, phase: float
) -> FullHarmonicParameters:
    """Return the parameters of the full block with harmonic forcing."""
    level = lift_off_level(block)
    resting = harmonic_parameters(amplitude / level, frequency, period, phase, block.restitution)
    forcing = FullCosine(amplitude, frequency, resting.forcing.phase, resting)
    return FullHarmonicParameters(block, forcing, resting.clock)


def full_sampled_parameters(
    block: FullBlock, tables: Tables, scale: float, cycle_length: float
) -> FullSampledParameters:
    """Return the parameters of the full block with a sampled base acceleration."""
    clock = Clock(cycle_length)
    slender = BlockParameters(block.restitution, math.inf, 1.0)
    resting = SampledParameters(slender, SampledForcing(scale / lift_off_level(block), tables), clock)
    return FullSampledParameters(block, FullSamples(scale, tables, resting), clock)
