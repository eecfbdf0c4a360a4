"""How small differences travel: along arcs, through impacts, brace impacts, rest and leaning.

``Tangent`` holds the differences with respect to the start alone, in registers. ``TangentState`` holds in its rows those
with respect to the start (0, 1) and to the parameters (``Row``, at a fixed time after the start of the march).
"""

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE, KERNEL_INLINE, SIMD_INLINE
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, LEAVE, NONE
from rocking.kernels.forcing.harmonic import forcing_term, sensitivities
from rocking.kernels.numerics.elementary import fma, hyperbolic

TANGENT = 2
SENSITIVITIES = 8
# How large and how small differences may grow before they are brought back to size 1: far from any end of the numbers.
LARGE, SMALL = 1e100, 1e-100


class Row(IntEnum):
    """Which row of ``columns`` belongs to which parameter."""

    AMPLITUDE = 2
    FREQUENCY = 3
    PHASE = 4
    RESTITUTION = 5
    BRACE_ANGLE = 6
    BRACE_RESTITUTION = 7


class TangentState(NamedTuple):
    """Differences that a march carries."""

    columns: np.ndarray  # (0 | 2 | 8, 2), one (delta Theta, delta Theta') a row
    # (2,): the rows are re-orthonormalised at every event, (1,): the first is normalised where need be and at the end, and
    # the logarithms of what that takes out are added; (0,): neither
    growth: np.ndarray


NO_TANGENT = TangentState(np.empty((0, 2)), np.empty(0))


class Tangent(NamedTuple):
    """Two differences, (a, b) and (c, d)."""

    a: float
    b: float
    c: float
    d: float


@njit(**INTERNAL)
def read_tangent(columns):
    """The first two rows."""
    return Tangent(columns[0, 0], columns[0, 1], columns[1, 0], columns[1, 1])


@njit(**INTERNAL)
def write_tangent(columns, tangent):
    """Back into the first two rows."""
    columns[0, 0], columns[0, 1] = tangent.a, tangent.b
    columns[1, 0], columns[1, 1] = tangent.c, tangent.d


@njit(**INTERNAL_INLINE)
def in_registers(state):
    """Whether the march carries the differences as a ``Tangent``."""
    return state.columns.shape[0] == TANGENT and state.growth.shape[0] < TANGENT


@njit(**INTERNAL_INLINE)
def is_measured(state):
    """Whether the growth of the first difference alone is measured."""
    return state.growth.shape[0] == 1


@njit(**INTERNAL_INLINE)
def read_registers(state):
    """Return the differences that are carried in registers; zeros where none are."""
    return read_tangent(state.columns) if in_registers(state) else Tangent(0.0, 0.0, 0.0, 0.0)


@njit(**INTERNAL_INLINE)
def write_registers(tangent, state):
    """Write the differences that were carried in registers."""
    write_tangent(state.columns, normalised(tangent, state.growth) if is_measured(state) else tangent)


@njit(**INTERNAL)
def finish_tangent(state):
    """Bring the first difference to size 1 at the end of a march, where its growth is measured."""
    if is_measured(state):
        write_tangent(state.columns, normalised(read_tangent(state.columns), state.growth))


@njit(**INTERNAL_INLINE)
def strain_of(tangent, state):
    """Return (tangent, strain) where the block comes to rest or leans: the logarithm of what differences have grown to."""
    growth = state.growth
    if is_measured(state):
        tangent = normalised(tangent, growth)
    if growth.shape[0] > 0:
        return tangent, growth[0]
    return tangent, log_strain(tangent) if in_registers(state) else math.inf


@njit(**INTERNAL)
def log_strain(tangent):
    """Logarithm of what a difference in velocity has grown to; a release fixes the angle."""
    return math.log(max(abs(tangent.c), abs(tangent.d)))


@njit(**KERNEL_INLINE)
def out_of_scale(tangent):
    """Whether the first difference must be brought back to size 1; never where it is zero."""
    size = max(abs(tangent.a), abs(tangent.b))
    return size > LARGE or 0.0 < size < SMALL


@njit(**INTERNAL)
def normalised(tangent, growth):
    """Return the tangent with its first difference at size 1; the logarithm of what that takes out is added to ``growth`` (1,)."""
    size = math.hypot(tangent.a, tangent.b)
    growth[0] += math.log(size)
    if size == 0.0:
        return tangent
    return Tangent(tangent.a / size, tangent.b / size, tangent.c / size, tangent.d / size)


@njit(**SIMD_INLINE)
def carry_along(difference, sinh, versinh):
    """Carry (delta u, delta u') along an arc: [[cosh t, sinh t], [sinh t, cosh t]]."""
    a, b = difference
    cosh = 1.0 + versinh
    return fma(cosh, a, sinh * b), fma(sinh, a, cosh * b)


@njit(**SIMD_INLINE)
def carry_through(difference, factor, shear):
    """Carry (delta u, delta u') through an event: [[factor, 0], [shear, factor]]."""
    a, b = difference
    return factor * a, fma(shear, a, factor * b)


@njit(**SIMD_INLINE)
def impact_gain(restitution, f, turned):
    """Return the shear of an impact times the speed: by so much Theta'' changes beyond the factor e.

    f is the forcing term there; ``turned`` is -1 where the block goes on on the other side, else 1.
    """
    return fma(restitution - 1.0, 1.0 + f, turned - restitution)


@njit(**SIMD_INLINE)
def brace_gain(brace_restitution, brace_angle, f):
    """Return the shear of a hit on a brace times the speed."""
    return (1.0 + brace_restitution) * (brace_angle + f)


@njit(**KERNEL_INLINE)
def along(tangent, sinh, versinh):
    """Carry both differences along an arc."""
    a, b, c, d = tangent
    return Tangent(*carry_along((a, b), sinh, versinh), *carry_along((c, d), sinh, versinh))


@njit(**KERNEL_INLINE)
def through(tangent, event):
    """Carry both differences through an event, as ``event_map`` gives it."""
    a, b, c, d = tangent
    return Tangent(*carry_through((a, b), event[0], event[1]), *carry_through((c, d), event[0], event[1]))


@njit(**KERNEL_INLINE)
def event_map(p, arc, coming, mode_after, side_after):
    """(factor, shear) of an event: e and (Theta''+ - e Theta''-)/Theta'- of an impact, e replaced by -r at a brace.

    Rest, leaning, lift-off and leaving forget: (0, 0).
    """
    if mode_after != FLIGHT:
        return 0.0, 0.0
    f = forcing_term(p, coming.cosine)
    if coming.event == IMPACT:
        gained = impact_gain(p.restitution, f, float(side_after * arc.side))
        return p.restitution, shear_of(gained, -coming.velocity)
    if coming.event == BRACE:
        r = p.brace_restitution
        return -r, shear_of(brace_gain(r, p.brace_angle, f), coming.velocity)
    return (1.0 if coming.event == NONE else 0.0), 0.0


@njit(**KERNEL_INLINE)
def shear_of(gained, speed):
    """Return the shear of an event at a speed; none where it only touches."""
    return gained / speed if speed != 0.0 else 0.0


@njit(**INTERNAL_INLINE)
def carry(p, tangent, state, before, coming, after):
    """Carry the differences along an arc, which they pass unchanged at rest and leaning, and through the event that ends it.

    ``before`` and ``after`` are the progress on both sides of the event. Returns the tangent; rows are changed in place.
    """
    if in_registers(state):
        if before.mode == FLIGHT:
            tangent = along(tangent, coming.sinh, coming.versinh)
        tangent = through(tangent, event_map(p, before.arc, coming, after.mode, after.arc.side))
        return normalised(tangent, state.growth) if is_measured(state) and out_of_scale(tangent) else tangent
    if state.columns.shape[0] > 0:
        carry_rows(p, state, before, coming, after)
    return tangent


@njit(**INTERNAL)
def carry_arc(p, arc, state, t, elapsed):
    """Carry all rows along an arc of length t that began ``elapsed`` after the start of the march.

    With two ``growth`` in steps of at most 1, re-orthonormalised after each: the shrinking direction is never lost to
    rounding.
    """
    columns, growth = state
    steps = math.ceil(t) if growth.shape[0] == TANGENT and t > 1.0 else 1
    sinh, versinh, _, _ = hyperbolic(t / steps)
    for _ in range(steps):
        for k in range(columns.shape[0]):
            columns[k, 0], columns[k, 1] = carry_along((columns[k, 0], columns[k, 1]), sinh, versinh)
        if growth.shape[0] == TANGENT:
            orthonormalise(columns, growth)
    if columns.shape[0] == SENSITIVITIES:
        carry_forcing(p, arc, columns, t, elapsed)


@njit(**INTERNAL)
def carry_rows(p, state, before, coming, after):
    """Carry all rows along an arc and through its event, with what the restitutions and the place of the brace add."""
    columns, arc, flies_on = state.columns, before.arc, after.mode == FLIGHT
    if before.mode == FLIGHT:
        carry_arc(p, arc, state, coming.wait, before.cycle * p.period + arc.start)
    factor, shear = event_map(p, arc, coming, after.mode, after.arc.side)
    side, velocity = arc.side, arc.side * coming.velocity
    extra = columns.shape[0] == SENSITIVITIES
    if extra and coming.event == BRACE:
        columns[Row.BRACE_ANGLE, 0] -= side
    for k in range(columns.shape[0]):
        columns[k, 0], columns[k, 1] = carry_through((columns[k, 0], columns[k, 1]), factor, shear)
    if extra and coming.event == IMPACT and flies_on:
        columns[Row.RESTITUTION, 1] += velocity
    if extra and coming.event == BRACE:
        columns[Row.BRACE_ANGLE, 0] += side
        columns[Row.BRACE_RESTITUTION, 1] -= velocity if flies_on else 0.0
    if extra and coming.event == LEAVE:
        columns[Row.BRACE_ANGLE, 0] = side
    if state.growth.shape[0] == TANGENT:
        orthonormalise(columns, state.growth)


@njit(**INTERNAL)
def carry_forcing(p, arc, columns, t, elapsed):
    """The forcing's own share in the parameter rows of an arc that began ``elapsed`` after the start of the march."""
    sinh, versinh, excess, _ = hyperbolic(t)
    place_a, rate_a, place_psi, rate_psi, place_f, rate_f = sensitivities(
        p, arc.cosine, arc.sine, t, sinh, versinh, excess
    )
    side = arc.side
    columns[Row.AMPLITUDE, 0] -= side * place_a
    columns[Row.AMPLITUDE, 1] -= side * rate_a
    columns[Row.PHASE, 0] -= side * place_psi
    columns[Row.PHASE, 1] -= side * rate_psi
    columns[Row.FREQUENCY, 0] -= side * (place_f + elapsed * place_psi)
    columns[Row.FREQUENCY, 1] -= side * (rate_f + elapsed * rate_psi)


@njit(**INTERNAL)
def orthonormalise(columns, growth):
    """Gram-Schmidt on the two tangent rows; the logarithms of what it takes out are added to ``growth``."""
    a, b = columns[0, 0], columns[0, 1]
    c, d = columns[1, 0], columns[1, 1]
    first = math.sqrt(a * a + b * b)
    if first == 0.0:
        growth[0] = growth[1] = -math.inf
        return
    a, b = a / first, b / first
    # What is left of the second row without its part along the first is its projection onto the normal
    # (-b, a): in the plane that is the whole of Gram-Schmidt, and it loses least to rounding after a strong
    # shear, where subtracting the part along the first row would cancel.
    second = a * d - b * c
    growth[0] += math.log(first)
    growth[1] += math.log(abs(second)) if second != 0.0 else -math.inf
    turn = 1.0 if second >= 0.0 else -1.0
    columns[0, 0], columns[0, 1] = a, b
    columns[1, 0], columns[1, 1] = -turn * b, turn * a
