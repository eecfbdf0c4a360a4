"""Slender block with unequal sides, for every motion of the base: on the left, u'' = rate^2 (u - ratio + a); on the right, u'' = u - 1 - a.

In ``Units`` of its own each side is a slender block: its base acceleration is smaller by the ratio, and its times are longer by
the rate. So all arcs are those of slender blocks. ``half`` is the block of a side, and the bodies below change the units. The
constants of an arc are in the units of its side; so is what ``contract`` says to be. The common units are those of the right side. A
block against a wall has no arcs on the left, whose ratio is infinite.
"""

import math
from typing import Any, NamedTuple

from rocking.kernels import contract
from rocking.kernels.arc.arc import NO_EXTREMES, UNIT_RATE, Arc, Instant, Next, Transfer, with_reached
from rocking.kernels.base.cosine import Cosine, Pulse, PulseDrive
from rocking.kernels.base.samples import SampledDrive, Samples, Tables, last_index
from rocking.kernels.event_kinds import FLIGHT
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.system import Full, Slender, SlenderBlock, Units, Unsymmetric

ONES = Units(1.0, 1.0, 1.0, 1.0, 1.0, 1.0)
with_forcing, with_tables = replacing(Slender, "forcing"), replacing(Samples, "tables")
with_common = replacing(Tables, "largest", "samples", "blocks", "variation")


class SidedGuess(NamedTuple):
    """Guess of the next event, with the side for which the ``slender`` guess was made; side 0 if only the time is known."""

    time: float
    side: int
    slender: Any


@kernel(inline=True)
def right_half(p):
    """Return the slender system of the right side."""
    return Slender(SlenderBlock(p.block.right_restitution, math.inf, 1.0), p.forcing, p.clock)


@kernel(inline=True)
def half(p, side):
    """Return the slender system of a side."""
    return contract.left_half(p) if side < 0 else right_half(p)


@body(contract.left_half, Unsymmetric, inline=True)
def left_half(p):
    """Provide ``contract.left_half``."""
    return p.left


@body(contract.left_half, Unsymmetric, Samples, inline=True)
def left_half_under_samples(p):
    """Provide ``contract.left_half``.

    What does not depend on the step is that of the right side, so that the compiler chooses fewer fields by the side.
    """
    left, right = p.left.forcing.tables, p.forcing.tables
    tables = with_common(left, right.largest, right.samples, right.blocks, right.variation)
    return with_forcing(p.left, with_tables(p.left.forcing, tables))


@body(contract.units_of, Unsymmetric, inline=True)
def units_of(p, side):
    """Provide ``contract.units_of``."""
    return p.block.units if side < 0 else ONES


@body(contract.units_of, Full, inline=True)
@body(contract.units_of, Slender, inline=True)
def same_units(p, side):
    """Provide ``contract.units_of`` for blocks whose arcs have the common units."""
    return ONES


@body(contract.drive_in, Slender, Cosine, inline=True)
def same_drive(source, target, drive, factor):
    """Provide ``contract.drive_in``: a phase has no units."""
    return drive


@body(contract.drive_in, Slender, Pulse, inline=True)
def scaled_drive(source, target, drive, factor):
    """Provide ``contract.drive_in``: what is after the end of one pulse is after the end of the other."""
    time = factor * drive.time
    if drive.time >= source.forcing.duration:
        time = max(time, target.forcing.duration)
    return PulseDrive(time, drive.cosine, drive.sine)


@body(contract.drive_in, Slender, Samples, inline=True)
def scaled_place(source, target, drive, factor):
    """Provide ``contract.drive_in``: a place between two samples stays between them."""
    offset = factor * drive.offset
    if drive.index < last_index(source):
        offset = min(offset, target.forcing.tables.step)
    return SampledDrive(drive.index, offset)


@kernel(inline=True)
def own_drive(p, side, drive):
    """Return a drive in the units of a side."""
    if side > 0:
        return drive
    return contract.drive_in(right_half(p), half(p, side), drive, p.block.units.rate)


@kernel(inline=True)
def common_drive(p, side, drive):
    """Return a drive of a side in the common units."""
    if side > 0:
        return drive
    return contract.drive_in(half(p, side), right_half(p), drive, p.block.units.per_rate)


@kernel(inline=True)
def own_arc(p, arc):
    """Return an arc in the units of its side."""
    by, drive = units_of(p, arc.side), own_drive(p, arc.side, arc.drive)
    angle, velocity = arc.angle * by.per_angle, arc.velocity * by.per_speed
    return Arc(arc.side, arc.start * by.rate, angle, velocity, drive, arc.constants)


@kernel(inline=True)
def common_arc(p, start, angle, velocity, arc):
    """Return an arc of a side in the common units, in which its start is known."""
    return Arc(arc.side, start, angle, velocity, common_drive(p, arc.side, arc.drive), arc.constants)


@kernel(inline=True)
def event_in(angle, time, speed, drive, coming):
    """Return an event with its angle, time and velocity multiplied by units, and a drive; the hyperbolic functions stay."""
    return Next(
        coming.wait * time,
        coming.event,
        coming.side,
        coming.angle * angle,
        coming.velocity * speed,
        drive,
        coming.sinh,
        coming.versinh,
    )


@kernel(inline=True)
def own_event(p, side, coming):
    """Return an event in the units of a side."""
    by, drive = units_of(p, side), own_drive(p, side, coming.drive)
    return event_in(by.per_angle, by.rate, by.per_speed, drive, coming)


@kernel(inline=True)
def common_event(p, side, coming):
    """Return an event of a side in the common units."""
    by, drive = units_of(p, side), common_drive(p, side, coming.drive)
    return event_in(by.angle, by.per_rate, by.speed, drive, coming)


@kernel(inline=True)
def common_instant(p, side, now):
    """Return an instant of a side in the common units; the hyperbolic functions stay those of the side."""
    by, drive = units_of(p, side), common_drive(p, side, now.drive)
    angle, risen, velocity = now.angle * by.angle, now.risen * by.angle, now.velocity * by.speed
    return Instant(angle, risen, velocity, drive, now.sinh, now.versinh)


@kernel(inline=True)
def common_transfer(p, side, moved):
    """Return a ``Transfer`` of a side in the common units."""
    by = units_of(p, side)
    return Transfer(
        moved.angle_by_angle,
        moved.angle_by_velocity * by.per_rate,
        moved.velocity_by_angle * by.rate,
        moved.velocity_by_velocity,
    )


@kernel(inline=True)
def common_peak(p, side, peak, found):
    """Return the largest of ``peak`` and an angle of a side, which is no less than it in the units of the side."""
    by = units_of(p, side)
    return peak if found == peak * by.per_angle else max(peak, found * by.angle)


@body(contract.arc_at, Unsymmetric)
def arc_at(p, side, cycle, start, angle, velocity):
    """Provide ``contract.arc_at``."""
    by = units_of(p, side)
    own_angle, own_velocity = angle * by.per_angle, velocity * by.per_speed
    arc = contract.arc_at(half(p, side), side, cycle, start * by.rate, own_angle, own_velocity)
    return common_arc(p, start, angle, velocity, arc)


@body(contract.arc_renewed, Unsymmetric)
def arc_renewed(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_renewed``."""
    by, own = units_of(p, side), own_event(p, side, coming)
    own_angle, own_velocity = angle * by.per_angle, velocity * by.per_speed
    arc = contract.arc_renewed(half(p, side), side, start * by.rate, own_angle, own_velocity, own)
    return common_arc(p, start, angle, velocity, arc)


@body(contract.arc_after, Unsymmetric, inline=True)
def arc_after(p, side, start, angle, velocity, coming):
    """Provide ``contract.arc_after``."""
    by, own = units_of(p, side), own_event(p, side, coming)
    own_angle, own_velocity = angle * by.per_angle, velocity * by.per_speed
    arc = contract.arc_after(half(p, side), side, start * by.rate, own_angle, own_velocity, own)
    return common_arc(p, start, angle, velocity, arc)


@body(contract.resynchronise, Unsymmetric)
def resynchronise(p, arc):
    """Provide ``contract.resynchronise``."""
    renewed = contract.resynchronise(half(p, arc.side), own_arc(p, arc))
    return common_arc(p, arc.start, arc.angle, arc.velocity, renewed)


@body(contract.evaluate, Unsymmetric)
def evaluate(p, arc, t):
    """Provide ``contract.evaluate``."""
    now = contract.evaluate(half(p, arc.side), own_arc(p, arc), t * units_of(p, arc.side).rate)
    return common_instant(p, arc.side, now)


@body(contract.acceleration, Unsymmetric, inline=True)
def acceleration(p, side, angle, drive):
    """Provide ``contract.acceleration``."""
    by, own = units_of(p, side), own_drive(p, side, drive)
    return contract.acceleration(half(p, side), side, angle * by.per_angle, own) * (by.speed * by.rate)


@body(contract.forcing_term, Unsymmetric, inline=True)
def forcing_term(p, side, drive):
    """Provide ``contract.forcing_term``: u'' at the base."""
    return acceleration(p, side, 0.0, drive)


@body(contract.restoring_acceleration, Unsymmetric, inline=True)
def restoring_acceleration(p, side):
    """Provide ``contract.restoring_acceleration``."""
    by = units_of(p, side)
    return by.speed * by.rate


@body(contract.change_of_side, Unsymmetric, inline=True)
def change_of_side(p, side, after):
    """Provide ``contract.change_of_side``."""
    old, new = units_of(p, side), units_of(p, after)
    faster = new.rate * old.per_rate
    return faster * faster * (new.angle * old.per_angle), faster * faster


@body(contract.is_symmetric, Unsymmetric, inline=True)
def never_symmetric(p):
    """Provide ``contract.is_symmetric``."""
    return False


@body(contract.has_wall, Unsymmetric, inline=True)
def has_wall(p):
    """Provide ``contract.has_wall``: no base acceleration lifts the block to the left."""
    return p.block.left.ratio == math.inf


@body(contract.restitution_at, Unsymmetric, inline=True)
def restitution_at(p, side, speed):
    """Provide ``contract.restitution_at``: a constant of each side."""
    e = p.block.left.restitution if side < 0 else p.block.right_restitution
    return e, e


@body(contract.transfer, Unsymmetric)
def transfer(p, arc, start, time):
    """Provide ``contract.transfer``."""
    rate = units_of(p, arc.side).rate
    moved = contract.transfer(half(p, arc.side), own_arc(p, arc), start * rate, time * rate)
    return common_transfer(p, arc.side, moved)


@body(contract.transfer_to_event, Unsymmetric, inline=True)
def transfer_to_event(p, arc, coming):
    """Provide ``contract.transfer_to_event``."""
    own = own_event(p, arc.side, coming)
    return common_transfer(p, arc.side, contract.transfer_to_event(half(p, arc.side), own_arc(p, arc), own))


@body(contract.guess_from, Unsymmetric, inline=True)
def guess_from(p, wait):
    """Provide ``contract.guess_from``: the side is not known yet."""
    return SidedGuess(wait, 0, contract.guess_from(right_half(p), 0.0))


@body(contract.next_event, Unsymmetric, inline=True)
def next_event(p, mode, arc, guess):
    """Provide ``contract.next_event``."""
    if mode != FLIGHT:
        return contract.held_event(p, mode, arc), guess
    q, by, guessed = half(p, arc.side), units_of(p, arc.side), guess.slender
    if guess.side != arc.side:
        guessed = contract.guess_from(q, guess.time * by.rate)
    coming, found = contract.next_event(q, mode, own_arc(p, arc), guessed)
    return common_event(p, arc.side, coming), SidedGuess(found.time * by.per_rate, arc.side, found)


@body(contract.held_event, Unsymmetric)
def held_event(p, mode, arc):
    """Provide ``contract.held_event``: there are no braces."""
    return contract.lift_off(right_half(p), arc, p.block.left.ratio)


@body(contract.resting, Unsymmetric, inline=True)
def resting(p):
    """Provide ``contract.resting``: the units are those of the right side."""
    return right_half(p), p.block.left.ratio


@body(contract.stays_leaning, Unsymmetric, inline=True)
def stays_leaning(p, arc):
    """Provide ``contract.stays_leaning``: there are no braces."""
    return False


@body(contract.brace_settling_time, Unsymmetric, inline=True)
def brace_settling_time(p, side, drive, speed):
    """Provide ``contract.brace_settling_time``: there are no braces."""
    return math.inf


@body(contract.no_return_time, Unsymmetric)
def no_return_time(p, arc):
    """Provide ``contract.no_return_time``."""
    return contract.no_return_time(half(p, arc.side), own_arc(p, arc)) * units_of(p, arc.side).per_rate


@body(contract.peak_with, Unsymmetric, inline=True)
def peak_with(p, arc, coming, peak):
    """Provide ``contract.peak_with``."""
    own, by = own_event(p, arc.side, coming), units_of(p, arc.side)
    found = contract.peak_with(half(p, arc.side), own_arc(p, arc), own, peak * by.per_angle)
    return common_peak(p, arc.side, peak, found)


@body(contract.largest_on, Unsymmetric)
def largest_on(p, arc, until, peak):
    """Provide ``contract.largest_on``."""
    by = units_of(p, arc.side)
    found = contract.largest_on(half(p, arc.side), own_arc(p, arc), until * by.rate, peak * by.per_angle)
    return common_peak(p, arc.side, peak, found)


@body(contract.turn_from, Unsymmetric)
def turn_from(p, arc, sign, start, until):
    """Provide ``contract.turn_from``."""
    q, by = half(p, arc.side), units_of(p, arc.side)
    found, at, now = contract.turn_from(q, own_arc(p, arc), sign, start * by.rate, until * by.rate)
    return found, at * by.per_rate, common_instant(p, arc.side, now)


@body(contract.escape_speed, Unsymmetric, inline=True)
def escape_speed(p):
    """Provide ``contract.escape_speed``: the lower one of both sides."""
    return min(1.0, units_of(p, -1).speed)


@body(contract.growth_constant, Unsymmetric)
def growth_constant(p, arc):
    """Provide ``contract.growth_constant``."""
    return contract.growth_constant(half(p, arc.side), own_arc(p, arc))


@body(contract.rounding_error, Unsymmetric, inline=True)
def rounding_error(p, arc, wait, growth, steps):
    """Provide ``contract.rounding_error``."""
    return contract.rounding_error(half(p, arc.side), own_arc(p, arc), wait, growth, steps)


@body(contract.elapsed_until, Unsymmetric, inline=True)
def elapsed_until(p, arc, drive):
    """Provide ``contract.elapsed_until``."""
    return contract.elapsed_until(half(p, arc.side), own_arc(p, arc), own_drive(p, arc.side, drive))


@body(contract.next_event_and_extremes, Unsymmetric)
def next_event_and_extremes(p, mode, arc, peak):
    """Provide ``contract.next_event_and_extremes``."""
    if mode != FLIGHT:
        return held_event(p, mode, arc), NO_EXTREMES, UNIT_RATE
    q, by = half(p, arc.side), units_of(p, arc.side)
    coming, found, stretch = contract.next_event_and_extremes(q, mode, own_arc(p, arc), peak * by.per_angle)
    extremes = with_reached(found, found.reached * by.angle)
    return common_event(p, arc.side, coming), extremes, stretch


@body(contract.largest_before, Unsymmetric, inline=True)
def largest_before(p, arc, coming, reached):
    """Provide ``contract.largest_before``."""
    q, own, by = half(p, arc.side), own_event(p, arc.side, coming), units_of(p, arc.side)
    return contract.largest_before(q, own_arc(p, arc), own, reached * by.per_angle) * by.angle
