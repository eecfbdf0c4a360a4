"""A periodic orbit as a closed chain of arcs: its unknowns are the forcing phases of its events alone.

Between two events at known phases an arc is known outright, eq. (5) of Yim & Lin (1991): the speed it must leave with
is linear in what it must reach. What is left to satisfy is the impact law, eq. (2), at every event. These equations
have no crossing to be found and no case to be told apart, so they are smooth through a grazing, where the return map
itself is not; whether an arc of their solution meets anything on its way is asked afterwards (``certify``).
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.arc.solution import arc_from, evaluate
from rocking.kernels.compile_options import INTERNAL, KERNEL_INLINE
from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.kernels.forcing.harmonic import forcing_term, sensitivities
from rocking.kernels.parameters import make

AMPLITUDE, FREQUENCY, PERIOD, RESTITUTION, BRACE_ANGLE, BRACE_RESTITUTION = range(6)


class Chain(NamedTuple):
    """What does not change along a branch: the events in their order, and how the chain closes."""

    kinds: np.ndarray  # IMPACT or BRACE: event j, at which arc j begins
    side: int  # of arc 0
    turn: (
        float  # forcing phase between event 0 and its repetition, half a period where that is a mirror image
    )


class Link(NamedTuple):
    """An arc between two events: the speeds at its ends, and their derivatives."""

    leaves: float
    arrives: float
    by_place: tuple  # of both, by the phase at its start with the phase at its end kept
    by_end: tuple  # by the phase at its end
    by_amplitude: tuple
    by_frequency: tuple
    by_brace: tuple
    sinh: float
    cosh: float
    acceleration: float  # u'' at its start
    push: float  # u'' at its end
    time: float


@njit(**INTERNAL)
def with_value(p, which, value):
    """The same system with one parameter changed; its clock starts at the phase 0."""
    amplitude, frequency, period = p.amplitude, p.frequency, p.period
    restitution, brace_angle, brace_restitution = p.restitution, p.brace_angle, p.brace_restitution
    if which == AMPLITUDE:
        amplitude = value
    elif which == FREQUENCY:
        frequency, period = value, 2.0 * math.pi / value
    elif which == PERIOD:
        frequency, period = 2.0 * math.pi / value, value
    elif which == RESTITUTION:
        restitution = value
    elif which == BRACE_ANGLE:
        brace_angle = value
    elif which == BRACE_RESTITUTION:
        brace_restitution = value
    return make(amplitude, frequency, period, 0.0, restitution, brace_angle, brace_restitution)


@njit(**KERNEL_INLINE)
def place_of(p, kind):
    """The angle at which an event happens."""
    return p.brace_angle if kind == BRACE else 0.0


@njit(**KERNEL_INLINE)
def law(p, kind):
    """Speed away from an event over speed towards it."""
    return p.brace_restitution if kind == BRACE else p.restitution


@njit(**KERNEL_INLINE)
def arc_at(p, side, psi, place, velocity):
    """The arc that leaves at a forcing phase, which is brought near 0 first."""
    psi -= 2.0 * math.pi * round(psi / (2.0 * math.pi))
    return arc_from(p, side, psi * p.per_frequency, place, velocity)


@njit(**INTERNAL)
def link(p, side, first, last, psi, t):
    """The arc of length t > 0 from an event of one kind at the phase ``psi`` to one of another: eq. (5) solved for its speed."""
    start, end = place_of(p, first), place_of(p, last)
    arc = arc_at(p, side, psi, start, 0.0)
    free = evaluate(p, arc, t)
    sinh, cosh = free.sinh, 1.0 + free.versinh
    leaves = (end - start - free.risen) / sinh
    arrives = free.velocity + leaves * cosh
    push = end + forcing_term(p, free.cosine)
    place_a, rate_a, place_psi, rate_psi, place_f, rate_f = sensitivities(
        p, arc.cosine, arc.sine, t, sinh, free.versinh, sinh - t if t > 1.0 else excess_of(t)
    )
    # The place reached must not move: the speed at the start makes up for what else moves it.
    by_time = -arrives / sinh, push - arrives * cosh / sinh
    by_psi = place_psi / sinh, place_psi * cosh / sinh - rate_psi
    by_amplitude = place_a / sinh, place_a * cosh / sinh - rate_a
    by_f = place_f / sinh, place_f * cosh / sinh - rate_f
    held, met = 1.0 if first == BRACE else 0.0, 1.0 if last == BRACE else 0.0
    brace = (met - held * cosh) / sinh
    k = p.per_frequency
    return Link(
        leaves,
        arrives,
        (by_psi[0] - k * by_time[0], by_psi[1] - k * by_time[1]),
        (k * by_time[0], k * by_time[1]),
        by_amplitude,
        (by_f[0] - k * t * by_time[0], by_f[1] - k * t * by_time[1]),
        (brace, held * sinh + brace * cosh),
        sinh,
        cosh,
        arc.acceleration,
        push,
        t,
    )


@njit(**KERNEL_INLINE)
def excess_of(t):
    """sinh t - t for t up to 1."""
    q = t * t
    total = 1.0
    for k in range(19, 3, -2):
        total = 1.0 + total * q / (k * (k - 1.0))
    return q * t / 6.0 * total


@njit(**INTERNAL)
def assemble(p, which, chain, y, jacobian, misses, links):
    """The equations of a chain and their derivatives by the k phases and by one parameter, column k; False where events change places.

    Row j: what event j makes of the speed of arc j - 1, less what arc j must leave with. Row j of ``links`` takes
    (leaves, arrives, sinh, cosh, pull, push, time) of arc j.
    """
    k = chain.kinds.shape[0]
    jacobian[:k, : k + 1] = 0.0
    misses[:k] = 0.0
    side = chain.side
    for j in range(k):
        after = j + 1 if j + 1 < k else 0
        end = y[after] + (chain.turn if after == 0 else 0.0)
        t = (end - y[j]) * p.per_frequency
        if not t > 0.0:
            return False
        one = link(p, side, chain.kinds[j], chain.kinds[after], y[j], t)
        row = links[j]
        row[0], row[1], row[2], row[3] = one.leaves, one.arrives, one.sinh, one.cosh
        row[4], row[5], row[6] = one.acceleration, one.push, one.time
        kept = -law(p, chain.kinds[after])
        misses[j] -= one.leaves
        misses[after] += kept * one.arrives
        jacobian[j, j] -= one.by_place[0]
        jacobian[j, after] -= one.by_end[0]
        jacobian[after, j] += kept * one.by_place[1]
        jacobian[after, after] += kept * one.by_end[1]
        by = by_parameter(p, which, one)
        jacobian[j, k] -= by[0]
        jacobian[after, k] += kept * by[1]
        lossy = RESTITUTION if chain.kinds[after] == IMPACT else BRACE_RESTITUTION
        if which == lossy:
            jacobian[after, k] -= one.arrives
        if chain.kinds[after] == IMPACT:
            side = -side
    return True


@njit(**INTERNAL)
def by_parameter(p, which, one):
    """The derivatives of an arc's speeds by the parameter, the phases kept."""
    if which == AMPLITUDE:
        return one.by_amplitude
    if which == FREQUENCY:
        return one.by_frequency
    if which == PERIOD:
        turned = -p.frequency / p.period
        return turned * one.by_frequency[0], turned * one.by_frequency[1]
    if which == BRACE_ANGLE:
        return one.by_brace
    return 0.0, 0.0


@njit(**INTERNAL)
def monodromy(p, chain, links):
    """(trace, determinant) of the tangent once round the chain, mirrored where the chain is half an orbit.

    In (u, u') of the side the block is on: an event is [[-e, 0], [(u''+ + e u''-)/u'-, -e]].
    """
    k = chain.kinds.shape[0]
    aa, ab, ba, bb, determinant = 1.0, 0.0, 0.0, 1.0, 1.0
    for j in range(k):
        after = j + 1 if j + 1 < k else 0
        sinh, cosh = links[j, 2], links[j, 3]
        aa, ba = cosh * aa + sinh * ba, sinh * aa + cosh * ba
        ab, bb = cosh * ab + sinh * bb, sinh * ab + cosh * bb
        kept = law(p, chain.kinds[after])
        shear = (links[after, 4] + kept * links[j, 5]) / links[j, 1]
        aa, ba = -kept * aa, shear * aa - kept * ba
        ab, bb = -kept * ab, shear * ab - kept * bb
        determinant *= kept * kept
    return aa + bb, determinant
