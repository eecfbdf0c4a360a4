"""Entry points for Python on a closed event chain: its equations at a point, its states at a phase."""

import math

from rocking.kernels.compile_options import KERNEL
from rocking.kernels.entry_point import entry_point
from rocking.kernels.forcing.arc import within_reach
from rocking.kernels.forcing.harmonic.parameters import HarmonicParameters
from rocking.kernels.forcing.harmonic.solution import evaluate
from rocking.kernels.orbits.event_chain import (
    Chain,
    Equations,
    arc_at,
    assemble,
    duration,
    event_after,
    link,
    monodromy,
    place_of,
    side_after,
    with_value,
)
from rocking.kernels.signature import Floats1, Floats2, Floats3


@entry_point(**KERNEL)
def states_at(
    p: HarmonicParameters, which: int, chain: Chain, rows: Floats2, psi: float, out: Floats3
) -> None:
    """Write (Theta, Theta') of each of the orbits ``rows`` (n, k + 1) at a forcing phase into ``out`` (n, m, 2).

    The states are those at the phases ``psi`` + 2 pi m of the chain, which begin at its first event. A
    mirrored chain repeats with the sides exchanged. Cycles are counted from the first event of the first
    orbit. So the states of one cycle form a curve even if that event passes ``psi``.
    """
    k = chain.kinds.shape[0]
    first = math.ceil((rows[0, 0] - psi) / (2.0 * math.pi)) if rows.shape[0] else 0
    for i in range(rows.shape[0]):
        y, q = rows[i], with_value(p, which, rows[i, k])
        for m in range(out.shape[1]):
            wanted = psi + 2.0 * math.pi * (m + first)
            rounds = math.floor((wanted - y[0]) / chain.turn)
            wanted -= rounds * chain.turn
            mirror = -1 if chain.mirrored and rounds % 2 == 1 else 1
            side, j = chain.side, 0
            while j + 1 < k and y[j + 1] <= wanted:
                j += 1
                side = side_after(side, chain.kinds[j])
            last = chain.kinds[event_after(chain, j)]
            one = link(q, side, chain.kinds[j], last, y[j], duration(q, chain, y, j))
            arc = arc_at(q, side, y[j], place_of(q, chain.kinds[j]), one.leaves)
            now = evaluate(q, arc, max((wanted - y[j]) * q.forcing.per_frequency, 0.0))
            out[i, m, 0] = mirror * side * within_reach(q, now.angle)
            out[i, m, 1] = mirror * side * now.velocity


@entry_point(**KERNEL)
def equations_at(
    p: HarmonicParameters, which: int, chain: Chain, y: Floats1, equations: Equations
) -> tuple[float, float]:
    """Assemble the ``equations`` of a chain at a point; the parameter is the last entry of ``y``.

    Returns
    -------
    tuple of (float, float)
        Trace and determinant of the monodromy matrix, NaN if events change their order.
    """
    q = with_value(p, which, y[-1])
    if not assemble(q, which, chain, y, equations):
        return math.nan, math.nan
    return monodromy(q, chain, equations.links)
