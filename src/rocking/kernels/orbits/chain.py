"""Periodic orbit as a closed chain of arcs; the only unknowns are the forcing phases of its events.

Between two events at known phases an arc is known in closed form, eq. (5) of Yim & Lin (1991): its initial
speed is linear in its end angle. The equations of the chain are the impact law, eq. (2), at every event. They
need no search for a zero and no case distinction, so they are smooth through a grazing, where the return map
is not. ``verify_chain`` checks afterwards whether an arc of the solution reaches base or brace on its way.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from rocking.kernels.arc.arc import within_reach
from rocking.kernels.arc.slender_cosine import arc_from, evaluate
from rocking.kernels.base.cosine import harmonic_term, response_sensitivities
from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats1, Floats2, Floats3, Integers1
from rocking.kernels.system import Cosine, Slender, slender_harmonic

AMPLITUDE, FREQUENCY, PERIOD, RESTITUTION, BRACE_ANGLE, BRACE_RESTITUTION = range(6)
# Fields stored for each arc of a chain, as in ``Link``.
LINK = np.dtype(
    [(name, float) for name in ("leaves", "arrives", "sinh", "cosh", "acceleration", "push", "time")]
)

Links = Annotated[np.ndarray, LINK, 1]


class Chain(NamedTuple):
    """Constant data along a branch: the events in their order, and the closure of the chain."""

    kinds: Integers1  # IMPACT or BRACE: event j, at which arc j begins
    side: int  # of arc 0
    turn: float  # forcing phase between event 0 and its repetition
    mirrored: bool  # whether that repetition is a mirror image, half a period later


class Equations(NamedTuple):
    """Equations of a chain of k events at a point, and its arcs, as ``assemble`` writes them."""

    jacobian: Floats2  # (k, k + 1): derivatives by the phases and by one parameter
    residuals: Floats1  # (k,): the residual of each equation
    links: Links  # (k,) of LINK


class Link(NamedTuple):
    """Arc between two events: the speeds at its ends, and their derivatives."""

    leaves: float
    arrives: float
    by_place: tuple  # of both speeds, by the phase at its start with the phase at its end fixed
    by_end: tuple  # by the phase at its end
    by_parameter: tuple  # by each of the parameters, with the phases fixed
    sinh: float
    cosh: float
    acceleration: float  # u'' at its start
    push: float  # u'' at its end
    time: float


def make_equations(n):
    """Return arrays for n unknowns: phases and parameters."""
    return Equations(np.zeros((n, n)), np.zeros(n), np.zeros(n, LINK))


@kernel
def with_value(p, which, value):
    """Return the system with one parameter changed and its clock starting at the phase 0."""
    frequency, period = p.forcing.frequency, p.forcing.period
    if which == FREQUENCY:
        frequency, period = value, 2.0 * math.pi / value
    elif which == PERIOD:
        frequency, period = 2.0 * math.pi / value, value
    return slender_harmonic(
        value if which == AMPLITUDE else p.forcing.amplitude,
        frequency,
        period,
        0.0,
        value if which == RESTITUTION else p.block.restitution,
        value if which == BRACE_ANGLE else p.block.brace_angle,
        value if which == BRACE_RESTITUTION else p.block.brace_restitution,
    )


@kernel(inline=True)
def place_of(p, kind):
    """Return the angle at which an event happens."""
    return p.block.brace_angle if kind == BRACE else 0.0


@kernel(inline=True)
def law(p, kind):
    """Return the coefficient of restitution of an event."""
    return p.block.brace_restitution if kind == BRACE else p.block.restitution


@kernel(inline=True)
def event_after(chain, j):
    """Return the event at which arc j ends."""
    return j + 1 if j + 1 < chain.kinds.shape[0] else 0


@kernel(inline=True)
def side_after(side, kind):
    """Return the side of the arc after an event."""
    return -side if kind == IMPACT else side


@kernel(inline=True)
def duration(p, chain, y, j):
    """Return the time from event j to the next one, at the phases ``y``."""
    after = event_after(chain, j)
    return (y[after] + (chain.turn if after == 0 else 0.0) - y[j]) * p.forcing.per_frequency


@kernel(inline=True)
def arc_at(p, side, psi, place, velocity):
    """Return the arc that starts at a forcing phase; whole turns are removed from the phase first."""
    psi -= 2.0 * math.pi * round(psi / (2.0 * math.pi))
    return arc_from(p, side, psi * p.forcing.per_frequency, place, velocity)


@kernel
def link(p, side, first, last, psi, t):
    """Return the arc of length t > 0 between events of two kinds: eq. (5) solved for its initial speed.

    It starts at the forcing phase ``psi``.
    """
    start, end = place_of(p, first), place_of(p, last)
    arc = arc_at(p, side, psi, start, 0.0)
    free = evaluate(p, arc, t)
    sinh, cosh = free.sinh, 1.0 + free.versinh
    leaves = (end - start - free.risen) / sinh
    arrives = free.velocity + leaves * cosh
    push = end + harmonic_term(p, free.drive.cosine)
    place_a, rate_a, place_psi, rate_psi, place_f, rate_f = response_sensitivities(
        p, arc.drive.cosine, arc.drive.sine, t, sinh, free.versinh, sinh - t if t > 1.0 else excess_of(t)
    )
    # The angle reached must not change, so the initial speed compensates all other changes of it.
    by_time = -arrives / sinh, push - arrives * cosh / sinh
    by_psi = place_psi / sinh, place_psi * cosh / sinh - rate_psi
    by_amplitude = place_a / sinh, place_a * cosh / sinh - rate_a
    by_f = place_f / sinh, place_f * cosh / sinh - rate_f
    held, met = 1.0 if first == BRACE else 0.0, 1.0 if last == BRACE else 0.0
    brace = (met - held * cosh) / sinh
    by_brace, none = (brace, held * sinh + brace * cosh), (0.0, 0.0)
    k, frequency_by_period = p.forcing.per_frequency, -p.forcing.frequency / p.forcing.period
    by_frequency = by_f[0] - k * t * by_time[0], by_f[1] - k * t * by_time[1]
    by_period = frequency_by_period * by_frequency[0], frequency_by_period * by_frequency[1]
    return Link(
        leaves,
        arrives,
        (by_psi[0] - k * by_time[0], by_psi[1] - k * by_time[1]),
        (k * by_time[0], k * by_time[1]),
        (by_amplitude, by_frequency, by_period, none, by_brace, none),
        sinh,
        cosh,
        arc.constants.acceleration,
        push,
        t,
    )


@kernel(inline=True)
def excess_of(t):
    """Return sinh t - t for t up to 1."""
    q = t * t
    total = 1.0
    for k in range(19, 3, -2):
        total = 1.0 + total * q / (k * (k - 1.0))
    return q * t / 6.0 * total


@kernel(inline=True)
def derivatives_by(one, which):
    """Return the derivatives of both speeds of an arc by a parameter: no index of a tuple can be out of range."""
    by_amplitude, by_frequency, by_period, by_restitution, by_brace, by_brace_restitution = one.by_parameter
    if which == AMPLITUDE:
        return by_amplitude
    if which == FREQUENCY:
        return by_frequency
    if which == PERIOD:
        return by_period
    if which == BRACE_ANGLE:
        return by_brace
    return by_restitution if which == RESTITUTION else by_brace_restitution


@kernel
def assemble(p, which, chain, y, equations):
    """Write the equations of a chain at the phases ``y``, and their derivatives.

    Row j is the speed after event j, by the impact law from arc j - 1, less the initial speed of arc j.
    Column k holds the derivatives by the parameter ``which``. Returns False if events change their order.
    """
    jacobian, residuals, links = equations
    k = chain.kinds.shape[0]
    jacobian[:k, : k + 1] = 0.0
    residuals[:k] = 0.0
    side = chain.side
    for j in range(k):
        after, t = event_after(chain, j), duration(p, chain, y, j)
        if not t > 0.0:
            return False
        one = link(p, side, chain.kinds[j], chain.kinds[after], y[j], t)
        store_link(links[j], one)
        kept = -law(p, chain.kinds[after])
        residuals[j] -= one.leaves
        residuals[after] += kept * one.arrives
        jacobian[j, j] -= one.by_place[0]
        jacobian[j, after] -= one.by_end[0]
        jacobian[after, j] += kept * one.by_place[1]
        jacobian[after, after] += kept * one.by_end[1]
        by = derivatives_by(one, which)
        jacobian[j, k] -= by[0]
        jacobian[after, k] += kept * by[1]
        if which == (RESTITUTION if chain.kinds[after] == IMPACT else BRACE_RESTITUTION):
            jacobian[after, k] -= one.arrives
        side = side_after(side, chain.kinds[after])
    return True


@kernel(inline=True)
def store_link(row, one):
    """Store an arc in a row of LINK."""
    row.leaves, row.arrives, row.sinh, row.cosh = one.leaves, one.arrives, one.sinh, one.cosh
    row.acceleration, row.push, row.time = one.acceleration, one.push, one.time


@kernel
def monodromy(p, chain, links):
    """Return trace and determinant of the monodromy matrix of the chain, mirrored if the chain is half an orbit.

    In (u, u') of the present side the saltation matrix of an event is [[-e, 0], [(u''+ + e u''-)/u'-, -e]].
    """
    aa, ab, ba, bb, determinant = 1.0, 0.0, 0.0, 1.0, 1.0
    for j in range(chain.kinds.shape[0]):
        after, arc = event_after(chain, j), links[j]
        sinh, cosh = arc.sinh, arc.cosh
        aa, ba = cosh * aa + sinh * ba, sinh * aa + cosh * ba
        ab, bb = cosh * ab + sinh * bb, sinh * ab + cosh * bb
        kept = law(p, chain.kinds[after])
        shear = (links[after].acceleration + kept * arc.push) / arc.arrives
        aa, ba = -kept * aa, shear * aa - kept * ba
        ab, bb = -kept * ab, shear * ab - kept * bb
        determinant *= kept * kept
    return aa + bb, determinant


@entry_point
def states_at(p: Slender[Cosine], which: int, chain: Chain, rows: Floats2, psi: float, out: Floats3) -> None:
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


@entry_point
def equations_at(
    p: Slender[Cosine], which: int, chain: Chain, y: Floats1, equations: Equations
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
