"""Tangent vectors of a motion, for Lyapunov exponents and multipliers: along arcs, and through events by saltation matrices.

``Tangent`` holds the derivatives by the initial state alone, in registers. The rows of ``TangentState`` hold
those by the initial state (0, 1) and by the parameters (``Row``, at a fixed time after the start of the
march).
"""

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from rocking.kernels.contract import (
    acceleration,
    change_of_side,
    forcing_term,
    has_wall,
    restitution_at,
    restoring_acceleration,
    sensitivities,
    transfer,
    transfer_to_event,
    weight_of,
)
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, LEAVE, NONE
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats1, Floats2
from rocking.kernels.numerics.elementary import fma, hyperbolic, hypotenuse, logarithm

TANGENT = 2
SENSITIVITIES = 8
# Range of sizes of the tangent vectors before they are normalised again: far from overflow and underflow.
LARGE, SMALL = 1e100, 1e-100


class Row(IntEnum):
    """Row of ``columns`` of each parameter."""

    AMPLITUDE = 2
    FREQUENCY = 3
    PHASE = 4
    RESTITUTION = 5
    BRACE_ANGLE = 6
    BRACE_RESTITUTION = 7


class TangentState(NamedTuple):
    """Tangent vectors that a march propagates."""

    columns: Floats2  # (0 | 2 | 8, 2), one (delta Theta, delta Theta') per row
    # (2,): the rows are re-orthonormalised at every event. (1,): the first is normalised if necessary, and at
    # the end. In both cases the logarithms of the factors removed are added here. (0,): neither.
    growth: Floats1


NO_TANGENT = TangentState(np.empty((0, 2)), np.empty(0))


class Tangent(NamedTuple):
    """Two tangent vectors, (a, b) and (c, d)."""

    a: float
    b: float
    c: float
    d: float


@kernel
def read_tangent(columns):
    """Return the first two rows."""
    return Tangent(columns[0, 0], columns[0, 1], columns[1, 0], columns[1, 1])


@kernel
def write_tangent(columns, tangent):
    """Write a tangent into the first two rows."""
    columns[0, 0], columns[0, 1] = tangent.a, tangent.b
    columns[1, 0], columns[1, 1] = tangent.c, tangent.d


@kernel(inline=True)
def in_registers(state):
    """Return whether the march carries the tangent vectors as a ``Tangent``."""
    return state.columns.shape[0] == TANGENT and state.growth.shape[0] < TANGENT


@kernel(inline=True)
def is_measured(state):
    """Return whether the growth of the first tangent vector alone is measured."""
    return state.growth.shape[0] == 1


@kernel(inline=True)
def read_registers(state):
    """Return the tangent vectors that are carried in registers; zeros if there are none."""
    return read_tangent(state.columns) if in_registers(state) else Tangent(0.0, 0.0, 0.0, 0.0)


@kernel(inline=True)
def write_registers(tangent, state):
    """Write the tangent vectors that were carried in registers."""
    write_tangent(state.columns, normalised(tangent, state.growth) if is_measured(state) else tangent)


@kernel
def finish_tangent(state):
    """Normalise the first tangent vector at the end of a march, if its growth is measured."""
    if is_measured(state):
        write_tangent(state.columns, normalised(read_tangent(state.columns), state.growth))


@kernel(inline=True)
def strain_of(tangent, state):
    """Return the tangent and the logarithm of its growth at the start of rest or of contact with a brace."""
    growth = state.growth
    if is_measured(state):
        tangent = normalised(tangent, growth)
    if growth.shape[0] > 0:
        return tangent, growth[0]
    return tangent, log_strain(tangent) if in_registers(state) else math.inf


@kernel
def log_strain(tangent):
    """Return the logarithm of the growth of a perturbation of the velocity; a release fixes the angle."""
    return logarithm(max(abs(tangent.c), abs(tangent.d)))


@kernel(inline=True)
def out_of_scale(tangent):
    """Return whether the first tangent vector must be normalised; never if it is zero."""
    size = max(abs(tangent.a), abs(tangent.b))
    return size > LARGE or 0.0 < size < SMALL


@kernel
def normalised(tangent, growth):
    """Return the tangent with its first vector at size 1; add the logarithm of the factor to ``growth`` (1,)."""
    size = hypotenuse(tangent.a, tangent.b)
    growth[0] += logarithm(size)
    if size == 0.0:
        return tangent
    return Tangent(tangent.a / size, tangent.b / size, tangent.c / size, tangent.d / size)


@kernel(inline=True)
def carry_along(difference, moved):
    """Propagate (delta u, delta u') along an arc with a ``Transfer``."""
    a, b = difference
    angle = fma(moved.angle_by_angle, a, moved.angle_by_velocity * b)
    return angle, fma(moved.velocity_by_angle, a, moved.velocity_by_velocity * b)


@kernel(inline=True)
def carry_through(difference, factor, shear, gain):
    """Propagate (delta u, delta u') through an event by its saltation matrix [[factor, 0], [shear, gain]]."""
    a, b = difference
    return factor * a, fma(shear, a, gain * b)


@kernel(inline=True)
def impact_gain(gain, restoring, f, turned, restores=1.0, pushes=1.0):
    """Return the shear of an impact times the speed: the change of Theta'' beyond that by the ``gain`` of the velocity.

    f is u'' before it, and ``restoring`` is -f without base motion; ``turned`` is -1 if the block continues on the other
    side, else 1. The last two are ``contract.change_of_side``.
    """
    return fma(gain - pushes, restoring + f, restoring * (turned * restores - gain))


@kernel(inline=True)
def brace_gain(brace_restitution, bend):
    """Return the shear of a brace impact times the speed; ``bend`` is u'' there."""
    return (1.0 + brace_restitution) * bend


@kernel(inline=True)
def along(tangent, moved):
    """Propagate both tangent vectors along an arc."""
    a, b, c, d = tangent
    return Tangent(*carry_along((a, b), moved), *carry_along((c, d), moved))


@kernel(inline=True)
def through(tangent, event):
    """Propagate both tangent vectors through an event, with the saltation matrix of ``event_map``."""
    a, b, c, d = tangent
    factor, shear, gain = event
    return Tangent(*carry_through((a, b), factor, shear, gain), *carry_through((c, d), factor, shear, gain))


@kernel(inline=True)
def event_map(p, arc, coming, mode_after, side_after):
    """Return the saltation matrix [[factor, 0], [shear, gain]] of an event.

    For an impact with the speed v before it, factor = e, gain = d(e v)/dv and shear = (Theta''+ - gain Theta''-)/Theta'-. At a
    brace e is replaced by -r, and at a wall by -e. Rest, sustained contact, lift-off and departure erase all perturbations: zeros.

    Returns
    -------
    tuple of (float, float, float)
        Factor, shear and gain.
    """
    if mode_after != FLIGHT:
        return 0.0, 0.0, 0.0
    if coming.event == IMPACT:
        f, turned = forcing_term(p, arc.side, coming.drive), float(side_after * arc.side)
        e, gain = restitution_at(p, arc.side, -coming.velocity)
        if has_wall(p):
            return -e, shear_of(brace_gain(gain, f), coming.velocity), -gain
        restores, pushes = change_of_side(p, arc.side, side_after)
        restoring = weight_of(p, coming.drive) * restoring_acceleration(p, arc.side)
        gained = impact_gain(gain, restoring, f, turned, restores, pushes)
        return e, shear_of(gained, -coming.velocity), gain
    if coming.event == BRACE:
        r = p.block.brace_restitution
        bend = acceleration(p, arc.side, p.block.brace_angle, coming.drive)
        return -r, shear_of(brace_gain(r, bend), coming.velocity), -r
    kept = 1.0 if coming.event == NONE else 0.0
    return kept, 0.0, kept


@kernel(inline=True)
def shear_of(gained, speed):
    """Return the shear of an event at a speed; 0 if the block only touches."""
    return gained / speed if speed != 0.0 else 0.0


@kernel(inline=True)
def carry(p, tangent, state, before, coming, after):
    """Propagate the tangent vectors along an arc and through its final event.

    At rest and in contact with a brace the vectors stay unchanged. ``before`` and ``after`` are the progress
    on both sides of the event. Returns the tangent; rows are changed in place.
    """
    if in_registers(state):
        if before.mode == FLIGHT:
            tangent = along(tangent, transfer_to_event(p, before.arc, coming))
        tangent = through(tangent, event_map(p, before.arc, coming, after.mode, after.arc.side))
        return normalised(tangent, state.growth) if is_measured(state) and out_of_scale(tangent) else tangent
    if state.columns.shape[0] > 0:
        carry_rows(p, state, before, coming, after)
    return tangent


@kernel
def carry_arc(p, arc, state, t, elapsed):
    """Propagate all rows along an arc of length t that started ``elapsed`` after the start of the march.

    With two entries in ``growth`` the steps are at most 1, and the rows are re-orthonormalised after each. So
    rounding never destroys the contracting direction.
    """
    columns, growth = state
    steps = math.ceil(t) if growth.shape[0] == TANGENT and t > 1.0 else 1
    for step in range(steps):
        moved = transfer(p, arc, step * (t / steps), t / steps)
        for k in range(columns.shape[0]):
            columns[k, 0], columns[k, 1] = carry_along((columns[k, 0], columns[k, 1]), moved)
        if growth.shape[0] == TANGENT:
            orthonormalise(columns, growth)
    if columns.shape[0] == SENSITIVITIES:
        carry_forcing(p, arc, columns, t, elapsed)


@kernel
def carry_rows(p, state, before, coming, after):
    """Propagate all rows along an arc and its event, with the derivatives by restitutions and brace angle."""
    columns, arc, flies_on = state.columns, before.arc, after.mode == FLIGHT
    if before.mode == FLIGHT:
        carry_arc(p, arc, state, coming.wait, before.cycle * p.clock.cycle_length + arc.start)
    factor, shear, gain = event_map(p, arc, coming, after.mode, after.arc.side)
    side, velocity = arc.side, arc.side * coming.velocity
    extra = columns.shape[0] == SENSITIVITIES
    if extra and coming.event == BRACE:
        columns[Row.BRACE_ANGLE, 0] -= side
    for k in range(columns.shape[0]):
        columns[k, 0], columns[k, 1] = carry_through((columns[k, 0], columns[k, 1]), factor, shear, gain)
    if extra and coming.event == IMPACT and flies_on:
        columns[Row.RESTITUTION, 1] += velocity
    if extra and coming.event == BRACE:
        columns[Row.BRACE_ANGLE, 0] += side
        columns[Row.BRACE_RESTITUTION, 1] -= velocity if flies_on else 0.0
    if extra and coming.event == LEAVE:
        columns[Row.BRACE_ANGLE, 0] = side
    if state.growth.shape[0] == TANGENT:
        orthonormalise(columns, state.growth)


@kernel
def carry_forcing(p, arc, columns, t, elapsed):
    """Add the derivatives of the forcing to the parameter rows.

    The arc started ``elapsed`` after the start of the march.
    """
    sinh, versinh, excess, _ = hyperbolic(t)
    place_a, rate_a, place_psi, rate_psi, place_f, rate_f = sensitivities(p, arc, t, sinh, versinh, excess)
    side = arc.side
    columns[Row.AMPLITUDE, 0] -= side * place_a
    columns[Row.AMPLITUDE, 1] -= side * rate_a
    columns[Row.PHASE, 0] -= side * place_psi
    columns[Row.PHASE, 1] -= side * rate_psi
    columns[Row.FREQUENCY, 0] -= side * (place_f + elapsed * place_psi)
    columns[Row.FREQUENCY, 1] -= side * (rate_f + elapsed * rate_psi)


@kernel
def orthonormalise(columns, growth):
    """Apply Gram-Schmidt to the two tangent rows; the logarithms of the factors removed are added to ``growth``."""
    a, b = columns[0, 0], columns[0, 1]
    c, d = columns[1, 0], columns[1, 1]
    first = math.sqrt(a * a + b * b)
    if first == 0.0:
        growth[0] = growth[1] = -math.inf
        return
    a, b = a / first, b / first
    # The second row without its part along the first is its projection onto the normal (-b, a), which in the
    # plane is all of Gram-Schmidt. It loses least to rounding after a strong shear. Subtracting the part
    # along the first row would cancel.
    second = a * d - b * c
    growth[0] += logarithm(first)
    growth[1] += logarithm(abs(second)) if second != 0.0 else -math.inf
    turn = 1.0 if second >= 0.0 else -1.0
    columns[0, 0], columns[0, 1] = a, b
    columns[1, 0], columns[1, 1] = -turn * b, turn * a
