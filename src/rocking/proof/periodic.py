"""Proof of a periodic orbit by the chain of its events."""

from __future__ import annotations

from typing import Any, NamedTuple

from flint import arb

from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.proof import stability
from rocking.proof.arc import arc_from, stays_positive
from rocking.proof.balls import Balls, Refused
from rocking.proof.chain import Chain, Link, jacobian, links_of, place, residuals
from rocking.proof.krawczyk import Equations, Solution, solve
from rocking.proof.trajectory import State


class Enclosed(NamedTuple):
    """Proved orbit in balls."""

    p: Balls
    chain: Chain
    found: Solution
    links: list[Link]
    trace: arb  # of the derivative of the map over the chain
    determinant: arb

    def state(self, phase: arb, period: int) -> State:
        """Return the state of the orbit at a forcing phase, from the event before it."""
        chain, whole = self.chain, 2 * period * arb.pi()
        events = [
            (psi + shift * chain.half_turns * arb.pi(), side * (-1) ** shift, kind, one.leaves)
            for shift in range(2 if chain.mirrored else 1)
            for psi, side, kind, one in zip(self.found.box, chain.sides, chain.kinds, self.links, strict=True)
        ]
        since = [(phase - psi) / whole for psi, *_ in events]
        ago = [(turned - turned.floor()) * whole for turned in since]
        last = min(range(len(events)), key=lambda j: float(ago[j]))
        psi, side, kind, leaves = events[last]
        here = arc_from(self.p, side, psi, place(self.p, kind), leaves).at(ago[last] / self.p.frequency)
        return State(side, phase, here.value, here.first, 0, False)


def equations(p: Balls, chain: Chain) -> Equations:
    """Return the equations of a chain as functions of the phases."""

    def values(phases: list[arb]) -> Any:
        links = links_of(p, chain, phases)
        return None if links is None else residuals(p, chain, links)

    def derivatives(phases: list[arb]) -> Any:
        links = links_of(p, chain, phases)
        return None if links is None else jacobian(p, chain, links)

    return Equations(values, derivatives)


def solved(p: Balls, chain: Chain) -> tuple[Solution, list[Link]]:
    """Return the only closed motion near a chain, with its arcs, at the present precision; it may be repeated or symmetric.

    Raises
    ------
    Refused
        If the motion is not proved, with the reason.
    """
    if not chain.closes:
        raise Refused("the events do not close the orbit")
    found = solve(equations(p, chain), list(chain.phases))
    links = links_of(p, chain, found.box)
    if links is None:
        raise Refused("two events may come at the same time")
    check_arcs(p, chain, links)
    return found, links


def enclosed(p: Balls, chain: Chain) -> Enclosed:
    """Return the only orbit near a chain, with its least period and its symmetry; raise Refused as `solved` does."""
    found, links = solved(p, chain)
    if not stability.is_least(chain, found.box):
        raise Refused("a shorter period, or another symmetry, is not excluded")
    matrix = stability.monodromy(p, chain, links)
    return Enclosed(p, chain, found, links, matrix[0, 0] + matrix[1, 1], stability.determinant(p, chain))


def check_arcs(p: Balls, chain: Chain, links: list[Link]) -> None:
    """Raise Refused unless every arc leaves its first event, meets nothing on its way, and reaches its last event."""
    for j, (side, one) in enumerate(zip(chain.sides, links, strict=True)):
        check_arc(p, side, (chain.kinds[j], chain.kinds[(j + 1) % len(links)]), one)


def check_arc(p: Balls, side: int, kinds: tuple[int, int], one: Link) -> None:
    """Raise Refused unless an arc between events of two kinds meets nothing on its way, with the right signs of its speeds."""
    first, last = kinds
    leaves = one.leaves > 0 if first == IMPACT else one.leaves < 0
    arrives = one.arrives < 0 if last == IMPACT else one.arrives > 0
    if not (leaves and arrives):
        raise Refused("a speed at an event has the wrong sign, or may have it")
    arc = one.arc(p, side, place(p, first))
    clear = stays_positive(arc.at, one.time, int(first == IMPACT), last == IMPACT)
    if clear and p.brace_angle is not None:
        clear = stays_positive(arc.below_brace, one.time, int(first == BRACE), last == BRACE)
    if not clear:
        raise Refused("another event comes between, or may come")


def moves_between(p: Balls) -> None:
    """Raise Refused unless the motion 1 + beta cos psi, without any event, stays above the base and below the braces."""
    if not p.response < 1:
        raise Refused("the motion without events reaches the base, or may reach it")
    if p.brace_angle is not None and not 1 + p.response < p.brace_angle:
        raise Refused("the motion without events reaches a brace, or may reach it")
