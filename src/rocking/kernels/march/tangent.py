"""How small differences travel: along arcs, through impacts, brace impacts, rest and leaning.

``Tangent`` holds the differences with respect to the start alone, in registers. ``columns`` holds those with
respect to the start (rows 0, 1) and to the parameters (in the order of ``Row``, at a fixed time after the start
of the march), one (delta Theta, delta Theta') a row.
"""

import math
from enum import IntEnum
from typing import NamedTuple

from numba import njit

from rocking.kernels.compile_options import INTERNAL, KERNEL_INLINE
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, LEAVE, NONE
from rocking.kernels.forcing.harmonic import forcing_term, sensitivities
from rocking.kernels.numerics.elementary import hyperbolic

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


@njit(**INTERNAL)
def log_strain(tangent):
    """Logarithm of what a difference in velocity has grown to; a release fixes the angle."""
    return math.log(max(abs(tangent.c), abs(tangent.d)))


@njit(**KERNEL_INLINE)
def out_of_scale(tangent):
    """Whether the first difference must be brought back to size 1; one that is forgotten stays forgotten."""
    size = max(abs(tangent.a), abs(tangent.b))
    return size > LARGE or 0.0 < size < SMALL


@njit(**INTERNAL)
def normalised(tangent, growth):
    """The tangent with its first difference at size 1; the logarithm of what that takes out is added to ``growth`` (1,)."""
    size = math.hypot(tangent.a, tangent.b)
    growth[0] += math.log(size)
    if size == 0.0:
        return tangent
    return Tangent(tangent.a / size, tangent.b / size, tangent.c / size, tangent.d / size)


@njit(**KERNEL_INLINE)
def mapped(tangent, aa, ab, ba, bb):
    """Both differences by one matrix."""
    a, b, c, d = tangent
    return Tangent(aa * a + ab * b, ba * a + bb * b, aa * c + ab * d, ba * c + bb * d)


@njit(**KERNEL_INLINE)
def along(tangent, sinh, versinh):
    """Along an arc: [[cosh t, sinh t], [sinh t, cosh t]]."""
    return mapped(tangent, 1.0 + versinh, sinh, sinh, 1.0 + versinh)


@njit(**KERNEL_INLINE)
def through(tangent, event):
    """Through an event: [[factor, 0], [shear, factor]], as ``event_map`` gives them."""
    factor, shear = event
    return mapped(tangent, factor, 0.0, shear, factor)


@njit(**KERNEL_INLINE)
def event_map(p, arc, coming, mode_after, side_after):
    """(factor, shear) of an event: e and (Theta''+ - e Theta''-)/Theta'- of an impact, e replaced by -r at a brace.

    Rest, leaning, lift-off and leaving forget: (0, 0).
    """
    if mode_after != FLIGHT:
        return 0.0, 0.0
    if coming.event == IMPACT:
        acceleration = arc.side * (1.0 + forcing_term(p, coming.cosine))
        gained = (acceleration - side_after) - p.restitution * (acceleration - arc.side)
        return p.restitution, shear_of(gained, arc.side * coming.velocity)
    if coming.event == BRACE:
        r = p.brace_restitution
        gained = (1.0 + r) * (p.brace_angle + forcing_term(p, coming.cosine))
        return -r, shear_of(gained, coming.velocity)
    return (1.0 if coming.event == NONE else 0.0), 0.0


@njit(**KERNEL_INLINE)
def shear_of(gained, velocity):
    """What an event adds to delta Theta' for each delta Theta: it comes so much later; none where it only touches."""
    return gained / velocity if velocity != 0.0 else 0.0


@njit(**KERNEL_INLINE)
def carried(p, tangent, mode, arc, coming, mode_after, side_after):
    """The tangent along an arc (at rest and leaning it stays) and through the event that ends it."""
    if mode == FLIGHT:
        tangent = along(tangent, coming.sinh, coming.versinh)
    return through(tangent, event_map(p, arc, coming, mode_after, side_after))


@njit(**KERNEL_INLINE)
def map_rows(columns, aa, ab, ba, bb):
    """Every row by one matrix."""
    for k in range(columns.shape[0]):
        a, b = columns[k, 0], columns[k, 1]
        columns[k, 0] = aa * a + ab * b
        columns[k, 1] = ba * a + bb * b


@njit(**INTERNAL)
def carry_arc(p, arc, columns, growth, t, elapsed):
    """All rows along an arc of length t that began ``elapsed`` after the start of the march.

    With two ``growth`` in steps of at most 1, re-orthonormalised after each: the shrinking direction is never lost to
    rounding.
    """
    steps = math.ceil(t) if growth.shape[0] == TANGENT and t > 1.0 else 1
    sinh, versinh, _, _ = hyperbolic(t / steps)
    for _ in range(steps):
        map_rows(columns, 1.0 + versinh, sinh, sinh, 1.0 + versinh)
        if growth.shape[0] == TANGENT:
            orthonormalise(columns, growth)
    if columns.shape[0] == SENSITIVITIES:
        carry_forcing(p, arc, columns, t, elapsed)


@njit(**INTERNAL)
def carry_rows(p, columns, growth, mode, arc, coming, mode_after, side_after, elapsed):
    """All rows along an arc and through its event, with what the restitutions and the place of the brace add."""
    if mode == FLIGHT:
        carry_arc(p, arc, columns, growth, coming.wait, elapsed)
    factor, shear = event_map(p, arc, coming, mode_after, side_after)
    side, velocity = arc.side, arc.side * coming.velocity
    extra = columns.shape[0] == SENSITIVITIES
    if extra and coming.event == BRACE:
        columns[Row.BRACE_ANGLE, 0] -= side
    map_rows(columns, factor, 0.0, shear, factor)
    if extra and coming.event == IMPACT and mode_after == FLIGHT:
        columns[Row.RESTITUTION, 1] += velocity
    if extra and coming.event == BRACE:
        columns[Row.BRACE_ANGLE, 0] += side
        columns[Row.BRACE_RESTITUTION, 1] -= velocity if mode_after == FLIGHT else 0.0
    if extra and coming.event == LEAVE:
        columns[Row.BRACE_ANGLE, 0] = side
    if growth.shape[0] == TANGENT:
        orthonormalise(columns, growth)


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
