"""Parameters of the full block, under harmonic and sampled base accelerations and under pulses."""

import math
from typing import NamedTuple

import numpy as np

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.forcing.harmonic.parameters import (
    HarmonicParameters,
    make,
    phase_later,
    within_a_turn,
)
from rocking.kernels.forcing.sampled.parameters import SampledForcing, SampledParameters
from rocking.kernels.forcing.sampled.tables import Tables
from rocking.kernels.parameters import BlockParameters, Clock
from rocking.kernels.signature import Floats2

NO_LAW = np.empty((0, 2))


class FullBlock(NamedTuple):
    """Block of any slenderness."""

    restitution: float  # largest coefficient of restitution
    brace_angle: float  # infinite without braces
    brace_restitution: float
    critical_angle: float  # alpha
    sine: float
    cosine: float
    press: float  # sin(alpha)/alpha: acceleration back to the base, without base motion
    law: Floats2  # (n, 2): speed before an impact, ascending, and coefficient of restitution; n = 0 for a constant


class Shape(NamedTuple):
    """Numbers that follow from the critical angle and the angle of the braces."""

    sine: float
    cosine: float
    press: float
    level: float  # tan(alpha)/alpha: base acceleration at which the block lifts off, in units of g alpha
    resting_brace: (
        float  # brace angle of the slender block that stays at its brace as long as the full one does
    )


class FullCosine(NamedTuple):
    """Harmonic base acceleration, and the slender system that rests as long as the full one does."""

    amplitude: float
    frequency: float
    period: float
    phase: float
    per_frequency: float  # 1/Omega
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


class FullPulse(NamedTuple):
    """Piece of a cosine from time 0 on: the fields of ``FullCosine`` for the whole cosine, and the time of its end."""

    amplitude: float
    frequency: float
    phase: float
    resting: HarmonicParameters
    duration: float


class FullPulseParameters(NamedTuple):
    """Parameters of the full block under a pulse."""

    block: FullBlock
    forcing: FullPulse
    clock: Clock


@njit(**INTERNAL)
def shape_of(critical_angle, brace_angle):
    """Return the ``Shape``. At a brace the block stays while side * A < tan(alpha (brace_angle - 1))/alpha."""
    sine, level = math.sin(critical_angle), math.tan(critical_angle) / critical_angle
    resting_brace = math.inf
    if brace_angle < math.inf:
        resting_brace = 1.0 + math.tan(critical_angle * (brace_angle - 1.0)) / (critical_angle * level)
    return Shape(sine, math.cos(critical_angle), sine / critical_angle, level, resting_brace)


@njit(**INTERNAL)
def cosine_of(shape, resting_block, amplitude, frequency, period, phase):
    """Return the harmonic forcing of a full block, with the slender ``resting_block``."""
    resting = make(
        amplitude / shape.level,
        frequency,
        period,
        phase,
        resting_block.restitution,
        resting_block.brace_angle,
        resting_block.brace_restitution,
    )
    return FullCosine(amplitude, frequency, period, phase, resting.forcing.per_frequency, resting)


@njit(**INTERNAL)
def full_with_cosine(block, amplitude, frequency, period, phase):
    """Return the parameters of the full block with harmonic forcing."""
    shape = shape_of(block.critical_angle, block.brace_angle)
    resting = BlockParameters(block.restitution, shape.resting_brace, block.brace_restitution)
    forcing = cosine_of(shape, resting, amplitude, frequency, period, phase)
    return FullHarmonicParameters(block, forcing, Clock(period))


@njit(**INTERNAL)
def with_angle(p, restitution, brace_angle, brace_restitution, critical_angle):
    """Return the shape and the parameters of another block with the law of restitution of ``p``."""
    shape = shape_of(critical_angle, brace_angle)
    block = FullBlock(
        restitution,
        brace_angle,
        brace_restitution,
        critical_angle,
        shape.sine,
        shape.cosine,
        shape.press,
        p.block.law,
    )
    return shape, block


@njit(**INTERNAL)
def with_row(p, row):
    """Provide ``periodic.with_row``."""
    _, block = with_angle(p, row[4], row[5], row[6], row[7])
    return full_with_cosine(block, row[0], row[1], row[2], row[3])


@njit(**INTERNAL)
def with_run(p, run):
    """Provide ``finite.with_run``."""
    block = p.block
    shape, block = with_angle(
        p, run.restitution, block.brace_angle, block.brace_restitution, run.critical_angle
    )
    slender = BlockParameters(block.restitution, shape.resting_brace, block.brace_restitution)
    tables = p.forcing.tables
    resting = SampledParameters(slender, SampledForcing(run.scale / shape.level, tables), p.clock)
    return FullSampledParameters(block, FullSamples(run.scale, tables, resting), p.clock)


@njit(**INTERNAL)
def with_pulse(p, pulse):
    """Provide ``finite.with_pulse``."""
    _, block = with_angle(p, pulse.restitution, math.inf, 1.0, pulse.critical_angle)
    period = 2.0 * math.pi / pulse.frequency
    whole = full_with_cosine(block, pulse.amplitude, pulse.frequency, period, pulse.phase).forcing
    forcing = FullPulse(pulse.amplitude, pulse.frequency, pulse.phase, whole.resting, pulse.duration)
    return FullPulseParameters(block, forcing, Clock(pulse.duration))


@njit(**INTERNAL)
def later(p, time):
    """Provide ``periodic.later``."""
    forcing = p.forcing
    phase = phase_later(forcing, time)
    return full_with_cosine(p.block, forcing.amplitude, forcing.frequency, forcing.period, phase)


@entry_point(**KERNEL)
def full_shape(critical_angle: float, brace_angle: float) -> Shape:
    """Return ``shape_of``; entry point for Python."""
    return shape_of(critical_angle, brace_angle)


@entry_point(**KERNEL)
def full_cosine(
    shape: Shape,
    resting_block: BlockParameters,
    amplitude: float,
    frequency: float,
    period: float,
    phase: float,
) -> FullCosine:
    """Return ``cosine_of``; entry point for Python."""
    return cosine_of(shape, resting_block, amplitude, frequency, period, phase)


def full_block(
    restitution: float,
    critical_angle: float,
    brace_angle: float = math.inf,
    brace_restitution: float = 1.0,
    law: np.ndarray = NO_LAW,
) -> FullBlock:
    """Return the parameters of a block; with a ``law``, restitution is the largest of its coefficients."""
    shape = full_shape(critical_angle, brace_angle)
    return FullBlock(
        restitution,
        brace_angle,
        brace_restitution,
        critical_angle,
        shape.sine,
        shape.cosine,
        shape.press,
        law,
    )


def resting_of(block: FullBlock) -> tuple[Shape, BlockParameters]:
    """Return the shape of a block, and the slender block that rests as long as it does."""
    shape = full_shape(block.critical_angle, block.brace_angle)
    return shape, BlockParameters(block.restitution, shape.resting_brace, block.brace_restitution)


def full_harmonic_parameters(
    block: FullBlock, amplitude: float, frequency: float, period: float, phase: float
) -> FullHarmonicParameters:
    """Return the parameters of the full block with harmonic forcing."""
    forcing = full_cosine(*resting_of(block), amplitude, frequency, period, within_a_turn(phase))
    return FullHarmonicParameters(block, forcing, Clock(period))


def full_pulse_parameters(
    amplitude: float, frequency: float, phase: float, duration: float, cycle_length: float, block: FullBlock
) -> FullPulseParameters:
    """Return the parameters of the full block under a pulse."""
    whole = full_harmonic_parameters(block, amplitude, frequency, 2.0 * math.pi / frequency, phase).forcing
    forcing = FullPulse(amplitude, frequency, whole.phase, whole.resting, duration)
    return FullPulseParameters(block, forcing, Clock(cycle_length))


def full_sampled_parameters(
    block: FullBlock, tables: Tables, scale: float, cycle_length: float
) -> FullSampledParameters:
    """Return the parameters of the full block with a sampled base acceleration."""
    shape, slender = resting_of(block)
    clock = Clock(cycle_length)
    resting = SampledParameters(slender, SampledForcing(scale / shape.level, tables), clock)
    return FullSampledParameters(block, FullSamples(scale, tables, resting), clock)
