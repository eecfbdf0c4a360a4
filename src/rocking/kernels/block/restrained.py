"""Full block with a vertical elastic restrainer, whose equation is that of ``kernels.restrainer``.

At the base its force makes the press and the level of lift-off 1 + rho times as large. Impacts are those of the free block.
"""

import math

from rocking.kernels import contract
from rocking.kernels.base.cosine import Pulse, pulse_with
from rocking.kernels.base.samples import Samples
from rocking.kernels.contract import acceleration_of
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import RIGHT_ANGLE, cosine_of, sine_of
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.restrainer import Restrainer, energy_between, restrainer_of
from rocking.kernels.system import (
    AnyPulseParameters,
    AnySampledParameters,
    Clock,
    Full,
    FullBlock,
    FullSide,
    Restrained,
    Slender,
    SlenderBlock,
    Tables,
    full_with_pulse,
    full_with_run,
)

with_press = replacing(FullSide, "press")
with_sides = replacing(FullBlock, "right", "left", "level")


@kernel
def restrained_block(block, restrainer):
    """Return a full block with the press and the level of lift-off that its restrainer gives it."""
    more = 1.0 + restrainer.prestress
    right, left = block.right, block.left
    return with_sides(
        block, with_press(right, more * right.press), with_press(left, more * left.press), more * block.level
    )


@kernel
def restrained_samples(full, block, restrainer, tables, rate):
    """Return a restrained system under samples, from the free one, its block and tables whose unit of time is smaller by a rate.

    Near the unstable balance the base acceleration acts by the factor cosine/rate. Also Python calls this, without the compiler.
    """
    scale = full.forcing.scale
    resting = Slender(full.resting.block, Samples(scale / block.level, full.forcing.tables), full.clock)
    balanced = Slender(
        SlenderBlock(block.restitution, math.inf, 1.0),
        Samples(scale * restrainer.cosine / restrainer.rate, tables),
        Clock(full.clock.cycle_length * rate),
    )
    return Restrained(block, full.forcing, full.clock, resting, restrainer, balanced)


@kernel
def restrained_pulse(full, block, restrainer):
    """Return a restrained system under a pulse, from the free one and its block, as ``restrained_samples`` does."""
    wave, duration = full.forcing.during, full.forcing.duration
    own = pulse_with(wave.amplitude / block.level, wave.frequency, wave.phase, duration, math.inf)
    rate, amplitude = restrainer.rate, wave.amplitude * restrainer.cosine / restrainer.rate
    there = pulse_with(amplitude, wave.frequency / rate, wave.phase, duration * rate, math.inf)
    balanced = Slender(
        SlenderBlock(block.restitution, math.inf, 1.0), there, Clock(full.clock.cycle_length * rate)
    )
    resting = Slender(full.resting.block, own, full.clock)
    return Restrained(block, full.forcing, full.clock, resting, restrainer, balanced)


@body(contract.with_run, Restrained)
def with_run(p, run):
    """Provide ``contract.with_run``; the ratios of the restrainer and the tables of the balance are those of ``p``."""
    restrainer = restrainer_of(run.critical_angle, p.restrainer.stiffness, p.restrainer.prestress)
    rate = p.balanced.clock.cycle_length / p.clock.cycle_length
    full = full_with_run(p, run)
    block = restrained_block(full.block, restrainer)
    return restrained_samples(full, block, restrainer, p.balanced.forcing.tables, rate)


@body(contract.with_pulse, Restrained)
def with_pulse(p, pulse):
    """Provide ``contract.with_pulse``; the ratios of the restrainer are those of ``p``."""
    restrainer = restrainer_of(pulse.critical_angle, p.restrainer.stiffness, p.restrainer.prestress)
    full = full_with_pulse(p, pulse)
    return restrained_pulse(full, restrained_block(full.block, restrainer), restrainer)


@body(contract.acceleration, Restrained, inline=True)
def acceleration(p, side, angle, drive):
    """Provide ``contract.acceleration``."""
    alpha, own = p.block.critical_angle, p.restrainer
    theta = alpha * angle
    w = alpha - theta
    push = side * alpha * acceleration_of(p, drive) + own.push
    return -(own.weight * sine_of(w) + push * cosine_of(w) + own.force * cosine_of(0.5 * theta)) / alpha


@body(contract.forcing_term, Restrained, inline=True)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``: u'' at the base, where the stiffness has no effect."""
    return -p.block.right.press - side * acceleration_of(p, drive) * p.block.right.cosine


@body(contract.parts_at_base, Restrained, inline=True)
def parts_at_base(p, side, weight):
    """Provide ``contract.parts_at_base``: two parts of the stiffness cancel there."""
    return p.block.right.press + 2.0 * p.restrainer.stiffness


@body(contract.escape_speed, Restrained)
def escape_speed(p):
    """Provide ``contract.escape_speed``: from the energy up to the unstable balance, or to where the block lies flat."""
    alpha, own = p.block.critical_angle, p.restrainer
    barrier = energy_between(alpha, own.stiffness, own.prestress, 0.0, 0.0, min(own.balance, RIGHT_ANGLE))
    return math.sqrt(2.0 * barrier) / alpha


def _block_of(free: Full[Samples] | Full[Pulse], restrainer: Restrainer) -> FullBlock:
    """Return ``restrained_block`` without the compiler."""
    more, block = 1.0 + restrainer.prestress, free.block
    right, left = (side._replace(press=more * side.press) for side in (block.right, block.left))
    return block._replace(right=right, left=left, level=more * block.level)


def restrained_under_samples(
    free: AnySampledParameters, restrainer: Restrainer, tables: Tables
) -> Restrained[Samples]:
    """Return the system of a full block with a restrainer, from the free one.

    ``tables`` are those of the samples with steps longer by the ``rate`` of the restrainer.
    """
    assert isinstance(free, Full)
    return restrained_samples.py_func(free, _block_of(free, restrainer), restrainer, tables, restrainer.rate)


def restrained_under_pulse(free: AnyPulseParameters, restrainer: Restrainer) -> Restrained[Pulse]:
    """Return the system of a full block with a restrainer, from the free one."""
    assert isinstance(free, Full)
    return restrained_pulse.py_func(free, _block_of(free, restrainer), restrainer)
