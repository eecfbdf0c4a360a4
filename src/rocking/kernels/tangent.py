"""How small differences travel: along arcs, through impacts, brace impacts, rest and leaning.

Differences are with respect to the start and to every parameter: ``columns`` holds one difference (delta
Theta, delta Theta') a row: rows 0 and 1 the tangent of the start, then one row a parameter in the order of
``Row``, at a fixed time after the start of the march.
"""

import math
from enum import IntEnum

from numba import njit

from .elementary import COMPILED, INLINED, hyperbolic
from .harmonic import forcing_term, sensitivities

TANGENT = 2
SENSITIVITIES = 8


class Row(IntEnum):
    """Which row of ``columns`` belongs to which parameter."""

    AMPLITUDE = 2
    FREQUENCY = 3
    PHASE = 4
    RESTITUTION = 5
    BRACE_ANGLE = 6
    BRACE_RESTITUTION = 7


@njit(**INLINED)
def carry_map(columns, aa, ab, ba, bb):
    """Every row by one matrix."""
    for k in range(0, columns.shape[0], 2):
        a, b, c, d = columns[k, 0], columns[k, 1], columns[k + 1, 0], columns[k + 1, 1]
        columns[k, 0] = aa * a + ab * b
        columns[k, 1] = ba * a + bb * b
        columns[k + 1, 0] = aa * c + ab * d
        columns[k + 1, 1] = ba * c + bb * d


@njit(**INLINED)
def carry_free(columns, sinh, versinh):
    """Along an arc: [[cosh t, sinh t], [sinh t, cosh t]]."""
    carry_map(columns, 1.0 + versinh, sinh, sinh, 1.0 + versinh)


@njit(**COMPILED)
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


@njit(**INLINED)
def carry_hit(columns, restitution, shear):
    """Through an event: [[e, 0], [shear, e]]."""
    carry_map(columns, restitution, 0.0, shear, restitution)


@njit(**INLINED)
def carry_impact(p, columns, cosine, side, velocity, side_after):
    """Through an impact that comes in on ``side`` with Theta' = ``velocity`` and leaves on ``side_after``; ``cosine`` on ``side``."""
    pull = -p.amplitude * side * cosine
    carry_hit(columns, p.restitution, ((pull - side_after) - p.restitution * (pull - side)) / velocity)
    if columns.shape[0] == SENSITIVITIES:
        columns[Row.RESTITUTION, 1] += velocity


@njit(**INLINED)
def carry_brace(p, columns, cosine, side, velocity):
    """Through a hit on the brace of ``side`` with Theta' = ``velocity``: the impact's matrix with e replaced by -r."""
    r = p.brace_restitution
    acceleration = side * (p.brace_angle + forcing_term(p, cosine))
    moving = columns.shape[0] == SENSITIVITIES
    if moving:
        columns[Row.BRACE_ANGLE, 0] -= side
    carry_hit(columns, -r, (1.0 + r) * acceleration / velocity)
    if moving:
        columns[Row.BRACE_ANGLE, 0] += side
        columns[Row.BRACE_RESTITUTION, 1] -= velocity


@njit(**INLINED)
def forget(columns):
    """Rest forgets everything."""
    columns[:, :] = 0.0


@njit(**INLINED)
def forget_leaning(columns, side):
    """Leaning forgets all but where the brace stands."""
    columns[:, :] = 0.0
    if columns.shape[0] == SENSITIVITIES:
        columns[Row.BRACE_ANGLE, 0] = side


@njit(**COMPILED)
def orthonormalise(columns, growth):
    """Gram-Schmidt on the two tangent rows; the logarithms of what it takes out are added to ``growth``."""
    a, b = columns[0, 0], columns[0, 1]
    c, d = columns[1, 0], columns[1, 1]
    first = math.sqrt(a * a + b * b)
    if first == 0.0:
        growth[0] = growth[1] = -math.inf
        return
    a, b = a / first, b / first
    # In the plane the second direction is the first one turned by a right angle; its length is the
    # projection onto it.
    second = a * d - b * c
    growth[0] += math.log(first)
    growth[1] += math.log(abs(second)) if second != 0.0 else -math.inf
    turn = 1.0 if second >= 0.0 else -1.0
    columns[0, 0], columns[0, 1] = a, b
    columns[1, 0], columns[1, 1] = -turn * b, turn * a


@njit(**COMPILED)
def carry_free_orthonormal(columns, growth, t):
    """Along an arc in steps of at most 1, re-orthonormalised after each: the shrinking direction is never lost to rounding."""
    steps = math.ceil(t) if t > 1.0 else 1
    sinh, versinh, _, _ = hyperbolic(t / steps)
    for _ in range(steps):
        carry_free(columns, sinh, versinh)
        orthonormalise(columns, growth)
