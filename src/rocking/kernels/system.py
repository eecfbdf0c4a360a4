"""Systems: a block, the motion of its base, and the clock. They are the parameters of all kernels.

There are three blocks, ``Slender``, ``Unsymmetric`` (slender, with unequal sides) and ``Full``, and three motions of the base,
``Cosine``, ``Samples`` and ``Pulse``. Compiled code exists for each pair, such as ``Full[Samples]``. A base that also moves vertically,
``Biaxial``, is for the full block alone. A full block with a restrainer is ``Restrained``, for base motions that end.
"""

import math
from collections.abc import Sequence
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from rocking.kernels import contract
from rocking.kernels.base.biaxial import Biaxial
from rocking.kernels.base.cosine import (
    Cosine,
    Pulse,
    cosine_with,
    phase_later,
    pulse_with,
    with_phase,
    within_a_turn,
)
from rocking.kernels.base.samples import CYCLE, Samples, Tables, tables_of
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.library.signature import Floats2
from rocking.kernels.numerics.elementary import cosine_of, sine_of, tangent_of
from rocking.kernels.restrainer import Restrainer

Base = TypeVar("Base", Cosine, Samples, Pulse, Biaxial)
NO_LAW = np.empty((0, 2))


class LeftSide(NamedTuple):
    """Left side of a block (theta < 0), relative to the right one.

    The side of a wall has an infinite ratio, so that no base acceleration lifts the block to it.
    """

    ratio: float  # of the critical angles
    rate: float  # ratio of the frequency parameters
    restitution: float  # of impacts that end an arc on the left


class SlenderBlock(NamedTuple):
    """Slender block and its braces; the angle is infinite if there are no braces."""

    restitution: float
    brace_angle: float
    brace_restitution: float


class Units(NamedTuple):
    """Units of a side: its angles are multiplied by ``angle``, its times divided by ``rate``."""

    angle: float
    rate: float
    speed: float  # the product of both
    per_angle: float  # reciprocals
    per_rate: float
    per_speed: float


class UnsymmetricBlock(NamedTuple):
    """Slender block with unequal sides; it has no braces. Angles and times are in units of the right side."""

    restitution: float  # the larger one of both directions
    brace_angle: float  # infinite
    brace_restitution: float
    right_restitution: float  # of impacts that end an arc on the right
    left: LeftSide
    units: Units  # of the left side


class FullSide(NamedTuple):
    """Side of a full block."""

    restitution: float  # of impacts that end an arc on this side
    ratio: float  # of its critical angle to that of the right side
    rate: float  # ratio of the frequency parameters
    stiffness: float  # rate^2
    sine: float  # of its critical angle, times the stiffness
    cosine: float
    press: float  # sine/alpha: acceleration back to the base, without base motion


class Scatter(NamedTuple):
    """Scatter of the coefficient of restitution from impact to impact: e(v) + offset, within [0, 1] (``block.scatter``)."""

    deviation: float  # standard deviation of the normal distribution, or half the width of the uniform one; 0 for none
    uniform: bool
    stream: int  # number of the sequence of deviations
    offset: float  # at the coming impact


NO_SCATTER = Scatter(0.0, False, 0, 0.0)


class FullBlock(NamedTuple):
    """Block of any slenderness. With unequal sides it has no braces."""

    restitution: float  # largest coefficient of restitution
    brace_angle: float  # infinite without braces
    brace_restitution: float
    critical_angle: float  # alpha, of the right side
    right: FullSide
    left: FullSide
    level: (
        float  # tan(alpha)/alpha: base acceleration at which it lifts off to the right, in units of g alpha
    )
    left_level: float  # base acceleration of the lift-off to the left, relative to that; infinite at a wall
    # Brace angle of the slender block that stays at its brace as long as this one.
    resting_brace: float
    law: Floats2  # (n, 2): speed before an impact, ascending, and coefficient of restitution; n = 0 for a constant
    speed_unit: float  # of Theta', in the unit of the speeds of the law
    scatter: Scatter


@kernel(inline=True)
def side_of(block, side):
    """Return a side of a full block."""
    return block.left if side < 0 else block.right


class Clock(NamedTuple):
    """Division of time into cycles of equal length: a time is an integer cycle and the time within it."""

    cycle_length: float


class Slender(NamedTuple, Generic[Base]):
    """Slender block on a moving base."""

    block: SlenderBlock
    forcing: Base
    clock: Clock


class Unsymmetric(NamedTuple, Generic[Base]):
    """Slender block with unequal sides on a moving base."""

    block: UnsymmetricBlock
    forcing: Base
    clock: Clock
    left: Slender[Base]  # a slender block that moves as this one does on its left side, in units of that side


class Full(NamedTuple, Generic[Base]):
    """Block of any slenderness on a moving base."""

    block: FullBlock
    forcing: Base
    clock: Clock
    resting: Slender[Base]  # the slender system that stays at rest, or at a brace, as long as this one


class Restrained(NamedTuple, Generic[Base]):
    """Full block with a restrainer, on a moving base. Press and level of ``block`` are those with the force of the restrainer."""

    LIKE = Full  # the block with the same bodies, where none are its own
    block: FullBlock
    forcing: Base
    clock: Clock
    resting: Slender[Base]
    restrainer: Restrainer
    balanced: Slender[
        Base
    ]  # a slender system that moves as this one does near its unstable balance, in the unit of time there


PeriodicParameters = Slender[Cosine] | Full[Cosine] | Unsymmetric[Cosine]
"""Systems whose base motion is periodic."""
AnySampledParameters = Slender[Samples] | Full[Samples] | Unsymmetric[Samples] | Restrained[Samples]
AnyPulseParameters = Slender[Pulse] | Full[Pulse] | Unsymmetric[Pulse] | Restrained[Pulse]
FiniteParameters = AnySampledParameters | AnyPulseParameters | Full[Biaxial]
"""Systems whose base motion ends."""
SystemParameters = PeriodicParameters | FiniteParameters
Block = SlenderBlock | UnsymmetricBlock | FullBlock


class Sides(NamedTuple):
    """Both sides of a full block, and its levels."""

    right: FullSide
    left: FullSide
    level: float
    left_level: float
    resting_brace: float


@kernel
def full_side(critical_angle, ratio, rate, restitution):
    """Return a side of a full block."""
    angle, stiffness = critical_angle * ratio, rate * rate
    sine = stiffness * sine_of(angle)
    cosine = stiffness * cosine_of(angle)
    return FullSide(restitution, ratio, rate, stiffness, sine, cosine, sine / critical_angle)


@entry_point
def sides_of(critical_angle: float, brace_angle: float, restitution: float, left: LeftSide) -> Sides:
    """Return the ``Sides``. At a brace the block stays while side * A < tan(alpha (brace_angle - 1))/alpha.

    Against a wall the left side, which no arc has, is equal to the right one.
    """
    wall = left.ratio == math.inf
    ratio = 1.0 if wall else left.ratio
    tangent = tangent_of(critical_angle)
    level, resting_brace = tangent / critical_angle, math.inf
    if brace_angle < math.inf:
        resting_brace = 1.0 + tangent_of(critical_angle * (brace_angle - 1.0)) / (critical_angle * level)
    return Sides(
        full_side(critical_angle, 1.0, 1.0, restitution),
        full_side(critical_angle, ratio, left.rate, left.restitution),
        level,
        math.inf if wall else tangent_of(critical_angle * ratio) / tangent,
        resting_brace,
    )


@kernel
def block_with(restitution, brace_angle, brace_restitution, critical_angle, law, left, speed_unit, scatter):
    """Return a full block, and the slender block that rests as long."""
    sides = sides_of(critical_angle, brace_angle, restitution, left)
    block = FullBlock(
        max(restitution, left.restitution),
        brace_angle,
        brace_restitution,
        critical_angle,
        sides.right,
        sides.left,
        sides.level,
        sides.left_level,
        sides.resting_brace,
        law,
        speed_unit,
        scatter,
    )
    return block, SlenderBlock(block.restitution, sides.resting_brace, brace_restitution)


@kernel(inline=True)
def left_of_row(row):
    """Return the left side of a row of a survey; a row without it has equal sides."""
    return LeftSide(row[8], row[9], row[10]) if row.shape[0] > 8 else LeftSide(1.0, 1.0, row[4])


@kernel(inline=True)
def left_of_run(run):
    """Return the left side of a row of runs or pulses; where its numbers are 0, the sides are equal."""
    if run.angle_ratio == 0.0:
        return LeftSide(1.0, 1.0, run.restitution)
    return LeftSide(run.angle_ratio, run.frequency_ratio, run.left_restitution)


@kernel
def slender_harmonic(amplitude, frequency, period, phase, restitution, brace_angle, brace_restitution):
    """Return a slender system under a cosine; a cycle of the clock is a forcing period."""
    forcing = cosine_with(amplitude, frequency, period, phase, brace_angle)
    return Slender(SlenderBlock(restitution, brace_angle, brace_restitution), forcing, Clock(period))


@kernel
def slender_of_row(row):
    """Return a slender system from a row that holds the arguments of ``slender_harmonic``."""
    return slender_harmonic(row[0], row[1], row[2], row[3], row[4], row[5], row[6])


@body(contract.with_row, Slender, Cosine)
def slender_with_row(p, row):
    """Provide ``contract.with_row``."""
    return slender_of_row(row)


@body(contract.with_row, Full, Cosine)
def full_with_row(p, row):
    """Provide ``contract.with_row``, with the law of restitution of ``p``."""
    old = p.block
    block, slender = block_with(
        row[4], row[5], row[6], row[7], old.law, left_of_row(row), old.speed_unit, old.scatter
    )
    forcing = cosine_with(row[0], row[1], row[2], row[3], block.brace_angle)
    resting = cosine_with(row[0] / block.level, row[1], row[2], row[3], slender.brace_angle)
    clock = Clock(row[2])
    return Full(block, forcing, clock, Slender(slender, resting, clock))


@kernel
def slender_at_phase(p, phase):
    """Return the slender system with a different forcing phase at time 0."""
    return Slender(p.block, with_phase(p.forcing, phase), p.clock)


@body(contract.later, Slender, Cosine)
def slender_later(p, time):
    """Provide ``contract.later``."""
    return slender_at_phase(p, phase_later(p.forcing, time))


@body(contract.later, Full, Cosine)
def full_later(p, time):
    """Provide ``contract.later``."""
    phase = phase_later(p.forcing, time)
    return Full(p.block, with_phase(p.forcing, phase), p.clock, slender_at_phase(p.resting, phase))


@body(contract.with_run, Slender)
def slender_with_run(p, run):
    """Provide ``contract.with_run``."""
    block = SlenderBlock(run.restitution, p.block.brace_angle, p.block.brace_restitution)
    return Slender(block, Samples(run.scale, p.forcing.tables), p.clock)


@body(contract.with_run, Full)
def full_with_run(p, run):
    """Provide ``contract.with_run``."""
    old, tables = p.block, p.forcing.tables
    scatter = Scatter(old.scatter.deviation, old.scatter.uniform, run.stream, 0.0)
    block, slender = block_with(
        run.restitution,
        old.brace_angle,
        old.brace_restitution,
        run.critical_angle,
        old.law,
        left_of_run(run),
        run.speed_unit,
        scatter,
    )
    resting = Slender(slender, Samples(run.scale / block.level, tables), p.clock)
    return Full(block, Samples(run.scale, tables), p.clock, resting)


@body(contract.with_pulse, Slender)
def slender_with_pulse(p, pulse):
    """Provide ``contract.with_pulse``."""
    forcing = pulse_with(pulse.amplitude, pulse.frequency, pulse.phase, pulse.duration, math.inf)
    return Slender(SlenderBlock(pulse.restitution, math.inf, 1.0), forcing, Clock(pulse.duration))


@body(contract.with_pulse, Full)
def full_with_pulse(p, pulse):
    """Provide ``contract.with_pulse``."""
    old = p.block
    block, slender = block_with(
        pulse.restitution,
        math.inf,
        1.0,
        pulse.critical_angle,
        old.law,
        left_of_run(pulse),
        old.speed_unit,
        old.scatter,
    )
    forcing = pulse_with(pulse.amplitude, pulse.frequency, pulse.phase, pulse.duration, math.inf)
    resting = pulse_with(
        pulse.amplitude / block.level, pulse.frequency, pulse.phase, pulse.duration, math.inf
    )
    clock = Clock(pulse.duration)
    return Full(block, forcing, clock, Slender(slender, resting, clock))


@kernel
def unsymmetric_block(restitution, left):
    """Return a slender block with unequal sides."""
    angle, rate = left.ratio, left.rate
    units = Units(angle, rate, angle * rate, 1.0 / angle, 1.0 / rate, 1.0 / (angle * rate))
    return UnsymmetricBlock(max(restitution, left.restitution), math.inf, 1.0, restitution, left, units)


@kernel
def unsymmetric_harmonic(block, amplitude, frequency, period, phase):
    """Return a slender system with unequal sides under a cosine."""
    ratio, rate, _ = block.left
    forcing = cosine_with(amplitude, frequency, period, phase, math.inf)
    own = cosine_with(amplitude / ratio, frequency / rate, period * rate, phase, math.inf)
    return Unsymmetric(
        block,
        forcing,
        Clock(period),
        Slender(SlenderBlock(block.left.restitution, math.inf, 1.0), own, Clock(period * rate)),
    )


@kernel
def unsymmetric_pulse(block, amplitude, frequency, phase, duration, cycle_length):
    """Return a slender system with unequal sides under a pulse."""
    ratio, rate, _ = block.left
    forcing = pulse_with(amplitude, frequency, phase, duration, math.inf)
    own = pulse_with(amplitude / ratio, frequency / rate, phase, duration * rate, math.inf)
    left = Slender(SlenderBlock(block.left.restitution, math.inf, 1.0), own, Clock(cycle_length * rate))
    return Unsymmetric(block, forcing, Clock(cycle_length), left)


@kernel
def unsymmetric_samples(block, scale, tables, left_tables, cycle_length):
    """Return a slender system with unequal sides under samples, with tables for each side."""
    own = Samples(scale / block.left.ratio, left_tables)
    left = Slender(
        SlenderBlock(block.left.restitution, math.inf, 1.0), own, Clock(cycle_length * block.left.rate)
    )
    return Unsymmetric(block, Samples(scale, tables), Clock(cycle_length), left)


@body(contract.with_row, Unsymmetric, Cosine)
def unsymmetric_with_row(p, row):
    """Provide ``contract.with_row``."""
    block = unsymmetric_block(row[4], left_of_row(row))
    return unsymmetric_harmonic(block, row[0], row[1], row[2], row[3])


@body(contract.later, Unsymmetric, Cosine)
def unsymmetric_later(p, time):
    """Provide ``contract.later``."""
    phase = phase_later(p.forcing, time)
    return Unsymmetric(p.block, with_phase(p.forcing, phase), p.clock, slender_at_phase(p.left, phase))


@body(contract.with_run, Unsymmetric)
def unsymmetric_with_run(p, run):
    """Provide ``contract.with_run``; the ratio of the frequency parameters is that of the tables of ``p``."""
    ratio, _, restitution = left_of_run(run)
    block = unsymmetric_block(run.restitution, LeftSide(ratio, p.block.left.rate, restitution))
    tables, left_tables = p.forcing.tables, p.left.forcing.tables
    return unsymmetric_samples(block, run.scale, tables, left_tables, p.clock.cycle_length)


@body(contract.with_pulse, Unsymmetric)
def unsymmetric_with_pulse(p, pulse):
    """Provide ``contract.with_pulse``."""
    block, duration = unsymmetric_block(pulse.restitution, left_of_run(pulse)), pulse.duration
    return unsymmetric_pulse(block, pulse.amplitude, pulse.frequency, pulse.phase, duration, duration)


def slender_block(
    restitution: float,
    brace_angle: float = math.inf,
    brace_restitution: float = 1.0,
    left: LeftSide | None = None,
) -> SlenderBlock | UnsymmetricBlock:
    """Return a slender block; with a ``left`` side of its own it has no braces."""
    if left is None:
        return SlenderBlock(float(restitution), float(brace_angle), float(brace_restitution))
    _check_free(brace_angle)
    return unsymmetric_block.py_func(float(restitution), LeftSide(*map(float, left)))


def full_block(
    restitution: float,
    critical_angle: float,
    brace_angle: float = math.inf,
    brace_restitution: float = 1.0,
    law: np.ndarray = NO_LAW,
    left: LeftSide | None = None,
    scatter: Scatter = NO_SCATTER,
) -> FullBlock:
    """Return a block of any slenderness; with a ``law``, restitution is the largest of its coefficients.

    With a ``left`` side of its own it has no braces. A law holds for both directions of impact.
    """
    own = LeftSide(1.0, 1.0, float(restitution)) if left is None else LeftSide(*map(float, left))
    if left is not None:
        _check_free(brace_angle)
    sides = sides_of(critical_angle, brace_angle, restitution, own)
    largest = max(float(restitution), own.restitution)
    return FullBlock(largest, brace_angle, brace_restitution, critical_angle, *sides, law, 1.0, scatter)


def _check_free(brace_angle: float) -> None:
    """Raise ValueError for braces of a block with unequal sides."""
    if brace_angle < math.inf:
        raise ValueError(f"brace_angle must be infinite for a block with unequal sides; got {brace_angle}")


def _resting(block: FullBlock) -> SlenderBlock:
    """Return the slender block that rests as long."""
    return SlenderBlock(block.restitution, block.resting_brace, block.brace_restitution)


def harmonic_system(
    block: Block, amplitude: float, frequency: float, period: float, phase: float
) -> PeriodicParameters:
    """Return the system of a block under a cosine."""
    wave, clock = (float(frequency), float(period), within_a_turn(float(phase))), Clock(float(period))
    if isinstance(block, UnsymmetricBlock):
        return unsymmetric_harmonic.py_func(block, float(amplitude), *wave)
    forcing = cosine_with(float(amplitude), *wave, block.brace_angle)
    if isinstance(block, SlenderBlock):
        return Slender(block, forcing, clock)
    slender = _resting(block)
    resting = Slender(slender, cosine_with(amplitude / block.level, *wave, slender.brace_angle), clock)
    return Full(block, forcing, clock, resting)


def harmonic_parameters(
    amplitude: float,
    frequency: float,
    period: float,
    phase: float,
    restitution: float,
    brace_angle: float = math.inf,
    brace_restitution: float = 1.0,
) -> Slender[Cosine]:
    """Return the system of a slender block under a cosine."""
    block = slender_block(restitution, brace_angle, brace_restitution)
    return harmonic_system(block, amplitude, frequency, period, phase)


def sampled_system(
    block: Block, tables: Tables, scale: float, cycle_length: float, left_tables: Tables | None = None
) -> AnySampledParameters:
    """Return the system of a block under samples. ``left_tables`` are those of a slender block with unequal sides, else made here."""
    forcing, clock = Samples(float(scale), tables), Clock(float(cycle_length))
    if isinstance(block, UnsymmetricBlock):
        same = tables if block.left.rate == 1.0 else None
        own = left_tables or same or tables_of(tables.samples, tables.step * block.left.rate)
        return unsymmetric_samples.py_func(block, float(scale), tables, own, float(cycle_length))
    if isinstance(block, SlenderBlock):
        return Slender(block, forcing, clock)
    resting = Samples(scale / block.level, tables)
    return Full(block, forcing, clock, Slender(_resting(block), resting, clock))


def biaxial_system(
    block: FullBlock, tables: Tables, scale: float, vertical: np.ndarray, cycle_length: float
) -> Full[Biaxial]:
    """Return the system of a full block without braces under samples in two directions; ``vertical`` (n,) is in units of g, upwards."""
    weights = np.append(1.0 + vertical, 1.0)
    lightest = np.ascontiguousarray(np.minimum.accumulate(weights[::-1])[:0:-1])
    heaviest = np.ascontiguousarray(np.maximum.accumulate(np.abs(weights[::-1]))[:0:-1])
    own = tables, np.ascontiguousarray(weights[:-1]), lightest, heaviest
    clock = Clock(float(cycle_length))
    resting = Slender(_resting(block), Biaxial(scale / block.level, *own), clock)
    return Full(block, Biaxial(float(scale), *own), clock, resting)


def pulse_system(
    block: Block,
    amplitude: float,
    frequency: float,
    phase: float,
    duration: float,
    cycle_length: float,
) -> AnyPulseParameters:
    """Return the system of a block under a pulse."""
    form, clock = (float(frequency), within_a_turn(float(phase)), float(duration)), Clock(float(cycle_length))
    if isinstance(block, UnsymmetricBlock):
        return unsymmetric_pulse.py_func(block, float(amplitude), *form, float(cycle_length))
    forcing = pulse_with(float(amplitude), *form, block.brace_angle)
    if isinstance(block, SlenderBlock):
        return Slender(block, forcing, clock)
    slender = _resting(block)
    resting = pulse_with(amplitude / block.level, *form, slender.brace_angle)
    return Full(block, forcing, clock, Slender(slender, resting, clock))


def parameters_of_row(row: Sequence[float], law: np.ndarray = NO_LAW) -> PeriodicParameters:
    """Return a system under a cosine from a row of a survey.

    It holds amplitude, frequency, period, phase, restitution, angle and restitution of the braces, the critical angle in rad, and
    the three numbers of the ``LeftSide``. A slender block has the critical angle 0. For equal sides the last are 1, 1 and the
    restitution, or absent.
    With a ``law`` the restitution is the largest of its coefficients.
    """
    *wave, restitution, brace_angle, brace_restitution, critical_angle = row[:8]
    braces, side = (
        (brace_angle, brace_restitution),
        LeftSide(*row[8:] if len(row) > 8 else (1.0, 1.0, restitution)),
    )
    left = None if side == (1.0, 1.0, restitution) else side
    if critical_angle == 0.0:
        return harmonic_system(slender_block(restitution, *braces, left), *wave)
    return harmonic_system(full_block(restitution, critical_angle, *braces, law, left), *wave)


def row_of(p: PeriodicParameters) -> tuple[float, ...]:
    """Return the row from which ``parameters_of_row`` makes the same system."""
    forcing, block = p.forcing, p.block
    wave = forcing.amplitude, forcing.frequency, forcing.period, forcing.phase
    angle, restitution, left = 0.0, block.restitution, (1.0, 1.0, block.restitution)
    if isinstance(block, UnsymmetricBlock):
        restitution, left = block.right_restitution, block.left
    if isinstance(block, FullBlock):
        angle, restitution = block.critical_angle, block.right.restitution
        left = block.left.ratio, block.left.rate, block.left.restitution
    return *wave, restitution, block.brace_angle, block.brace_restitution, angle, *left


def unequal_sides(systems: np.ndarray) -> np.ndarray:
    """Return which rows (n, 8 or 11) are of blocks with unequal sides."""
    if systems.shape[1] == 8:
        return np.zeros(len(systems), bool)
    return (systems[:, 8] != 1.0) | (systems[:, 9] != 1.0) | (systems[:, 10] != systems[:, 4])


def kind_of_rows(systems: np.ndarray, law: np.ndarray = NO_LAW) -> PeriodicParameters:
    """Return a system whose type serves all rows (n, 8 or 11): with unequal sides if any row has them."""
    return parameters_of_row(systems[int(np.argmax(unequal_sides(systems)))], law)


__all__ = [
    "CYCLE",
    "AnyPulseParameters",
    "AnySampledParameters",
    "Biaxial",
    "Cosine",
    "FiniteParameters",
    "Full",
    "FullBlock",
    "FullSide",
    "LeftSide",
    "PeriodicParameters",
    "Pulse",
    "Restrained",
    "Samples",
    "Scatter",
    "Slender",
    "SlenderBlock",
    "SystemParameters",
    "Tables",
    "Unsymmetric",
    "UnsymmetricBlock",
    "biaxial_system",
    "full_block",
    "harmonic_parameters",
    "harmonic_system",
    "kind_of_rows",
    "parameters_of_row",
    "pulse_system",
    "row_of",
    "sampled_system",
    "slender_block",
    "tables_of",
    "unequal_sides",
    "within_a_turn",
]
