"""A closed chain of arcs as Python asks for it: its equations at a point, its states at a phase."""

import math

from numba import njit

from rocking.kernels.arc.solution import evaluate, within_reach
from rocking.kernels.compile_options import ENTRY_POINT, INTERNAL
from rocking.kernels.event_kinds import IMPACT
from rocking.kernels.orbits.event_chain import Chain, arc_at, assemble, link, monodromy, place_of, with_value


@njit(**ENTRY_POINT)
def states_at(p, which, kinds, side, turn, rows, psi, out):
    """Write (Theta, Theta') of each of the orbits ``rows`` (n, k + 1) at every phase ``psi`` + 2 pi m of its chain into ``out`` (n, m, 2).

    The phases of a chain begin at its first event; a mirrored chain repeats itself with the sides exchanged. Cycles are
    counted from the first event of the first orbit, so that one cycle's states are a curve though that event passes ``psi``.
    """
    k = kinds.shape[0]
    first = math.ceil((rows[0, 0] - psi) / (2.0 * math.pi)) if rows.shape[0] else 0
    for i in range(rows.shape[0]):
        p_here = with_value(p, which, rows[i, k])
        for m in range(out.shape[1]):
            start = rows[i, 0]
            wanted = psi + 2.0 * math.pi * (m + first)
            rounds = math.floor((wanted - start) / turn)
            wanted -= rounds * turn
            mirror = -1 if turned_over(kinds) and rounds % 2 == 1 else 1
            arc_side = side
            j = 0
            while j + 1 < k and rows[i, j + 1] <= wanted:
                j += 1
                if kinds[j] == IMPACT:
                    arc_side = -arc_side
            after = j + 1 if j + 1 < k else 0
            end = rows[i, after] + (turn if after == 0 else 0.0)
            one = link(
                p_here,
                arc_side,
                kinds[j],
                kinds[after],
                rows[i, j],
                (end - rows[i, j]) * p_here.per_frequency,
            )
            arc = arc_at(p_here, arc_side, rows[i, j], place_of(p_here, kinds[j]), one.leaves)
            now = evaluate(p_here, arc, max((wanted - rows[i, j]) * p_here.per_frequency, 0.0))
            out[i, m, 0] = mirror * arc_side * within_reach(p_here, now.angle)
            out[i, m, 1] = mirror * arc_side * now.velocity


@njit(**INTERNAL)
def turned_over(kinds):
    """Whether a chain ends on the side opposite to where it began."""
    impacts = 0
    for j in range(kinds.shape[0]):
        impacts += kinds[j] == IMPACT
    return impacts % 2 == 1


@njit(**ENTRY_POINT)
def equations(p, which, kinds, side, turn, y, jacobian, misses, links):
    """(trace, determinant) once round the chain with ``assemble``; the parameter is the last of ``y``."""
    q, chain = with_value(p, which, y[-1]), Chain(kinds, side, turn)
    if not assemble(q, which, chain, y, jacobian, misses, links):
        return math.nan, math.nan
    return monodromy(q, chain, links)
