"""Proof of a periodic orbit by the chain of its events: multipliers, stability, symmetry and least period."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from flint import acb, arb, arb_mat

from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.model.orbit import Orbit
from rocking.proof.arc import Balls, Refused, arc_from, balls_of, stays_positive
from rocking.proof.chain import ArcBounds, Chain, jacobian, law, links_of, place, residuals
from rocking.proof.krawczyk import Equations, Solution, solve
from rocking.proof.trajectory import (
    State,
    after_event,
    flight,
    half_turns_to_release,
    initial,
    release,
    rests,
)


def chain_of(orbit: Orbit) -> Chain:
    """Return the events of an orbit in their order; of a symmetric one, those of half a period.

    Raises
    ------
    Refused
        If the motion has other events than the orbit, or differs in the second half of the period of a symmetric orbit.
    """
    p, half = balls_of(orbit.system, {}), orbit.symmetric
    state = initial(p, orbit.phase, orbit.state)
    end = state.phase + orbit.period * 2 * arb.pi()
    kinds: list[int] = []
    after: list[State] = []
    while len(kinds) <= (orbit.impacts or 0) + (orbit.brace_hits or 0):
        flown = flight(p, state)
        state = after_event(p, state, flown)
        if not state.phase < end:
            break
        kinds.append(flown.event)
        after.append(state)
    if (kinds.count(IMPACT), kinds.count(BRACE)) != (orbit.impacts, orbit.brace_hits):
        raise Refused("the motion from its state has not the events of the orbit within one period")
    count = len(kinds) // 2 if half else len(kinds)
    if half and kinds[:count] != kinds[count:]:
        raise Refused(
            "the orbit is not symmetric: the events of the second half period are not those of the first"
        )
    return Chain(
        tuple(kinds[:count]),
        after[0].side,
        orbit.period if half else 2 * orbit.period,
        half,
        tuple(float(state.phase) for state in after[:count]),
    )


def monodromy(p: Balls, chain: Chain, links: list[ArcBounds]) -> arb_mat:
    """Return the derivative of the return map over the chain, in (u, u') just after the first event.

    The saltation matrix of an event is [[-law, 0], [(u''+ + law u''-)/u'-, -law]], between states in the units of their sides.
    """
    product = arb_mat([[1, 0], [0, 1]])
    for j, one in enumerate(links):
        after = (j + 1) % len(links)
        own, new = p.on(chain.sides[j]), p.on(chain.sides[after])
        kept, angle, speed = (
            law(own, chain.kinds[after]),
            own.angle / arb(new.angle),
            own.speed / arb(new.speed),
        )
        bend = links[after].start * (new.speed * new.rate) + kept * (one.end * (own.speed * own.rate))
        shear = bend * own.angle / (one.arrives * own.speed * new.speed)
        jump = arb_mat([[-kept * angle, 0], [shear, -kept * speed]])
        product = jump * (arb_mat([[one.cosh, one.sinh], [one.sinh, one.cosh]]) * product)
    return product


def determinant(p: Balls, chain: Chain) -> arb:
    """Return the determinant of the monodromy matrix: exact, because each event contributes the square of its coefficient."""
    total = arb(1)
    for j, kind in enumerate(chain.kinds):
        total *= law(p.on(chain.sides[j - 1]), kind) ** 2
    return total


def stable(trace: arb, product: arb) -> bool | None:
    """Return whether both multipliers lie inside the unit circle, from their sum and product; None if this is not decided."""
    if abs(trace) > 1 + product:
        return False
    return True if abs(trace) < 1 + product and product < 1 else None


def multipliers(trace: arb, product: arb, squared: bool) -> tuple[acb, acb]:
    """Return both multipliers, the larger first, or the one above the real axis; ``squared`` for two half periods."""
    root = (acb(trace) ** 2 / 4 - product).sqrt()
    first, second = trace / 2 + root, trace / 2 - root
    if squared:
        first, second = first * first, second * second
    ahead = first.imag - second.imag if not first.imag.is_zero() else abs(first) - abs(second)
    return (first, second) if ahead.mid() >= 0 else (second, first)


def repeats(chain: Chain, phases: list[arb], count: int, half_turns: int) -> bool:
    """Return whether the events may be the same, shifted by ``count`` of them and by half turns of the forcing phase."""
    k = len(phases)
    for j in range(k):
        later, turns = j + count, 0
        while later >= k:
            later, turns = later - k, turns + chain.half_turns
        if chain.kinds[later] != chain.kinds[j]:
            return False
        moved = phases[later] + (turns - half_turns) * arb.pi()
        if not moved.overlaps(phases[j]):
            return False
    return True


def is_least(chain: Chain, phases: list[arb]) -> bool:
    """Return whether it is proved that no part of the chain repeats itself: neither a shorter period nor a mirror image.

    A part is the chain divided by a whole number. It repeats itself after an even number of half turns, or its mirror image does
    after an odd number. So the symmetry of the orbit is proved, too.
    """
    k, whole = len(phases), chain.half_turns
    return not any(
        repeats(chain, phases, k // d, whole // d)
        for d in range(2, math.gcd(k, whole) + 1)
        if k % d == 0 == whole % d
    )


# Number of events between two rests, after which the proof is given up.
MAX_EVENTS = 2000


def next_release(p: Balls, state: State) -> int:
    """Return the half turns of the release after the next rest."""
    for _ in range(MAX_EVENTS):
        if rests(p, state) is not None:
            return half_turns_to_release(p, state.phase)
        state = after_event(p, state, flight(p, state))
    raise Refused(f"the block does not rest within {MAX_EVENTS} events")


def check_equal(p: Balls) -> None:
    """Raise Refused for a block with unequal sides: of its orbits, those are proved whose impacts do not accumulate."""
    if p.left is not None:
        raise Refused("this is proved for a block with equal sides only")


def turns_of_reset(p: Balls) -> int:
    """Return the half turns between two releases of the orbit that rests."""
    check_equal(p)
    if not (0 < p.restitution < 1 and p.amplitude > 1):
        raise Refused("an orbit that rests is proved only for 0 < e < 1 and A > 1")
    return next_release(p, release(p, 0))


class Enclosed(NamedTuple):
    """Proved orbit in balls."""

    p: Balls
    chain: Chain
    found: Solution
    links: list[ArcBounds]
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


def solved(p: Balls, chain: Chain) -> tuple[Solution, list[ArcBounds]]:
    """Return the only closed motion near a chain, with its arcs, at the present precision; it may be repeated or symmetric.

    Raises
    ------
    Refused
        If the motion is not proved, with the reason.
    """
    if not chain.closes:
        raise Refused("the events do not close the orbit")
    result = solve(equations(p, chain), list(chain.phases))
    links = links_of(p, chain, result.box)
    if links is None:
        raise Refused("two events may come at the same time")
    check_arcs(p, chain, links)
    return result, links


def enclosed(p: Balls, chain: Chain) -> Enclosed:
    """Return the only orbit near a chain, with its least period and its symmetry; raise Refused as `solved` does."""
    result, links = solved(p, chain)
    if not is_least(chain, result.box):
        raise Refused("a shorter period, or another symmetry, is not excluded")
    matrix = monodromy(p, chain, links)
    return Enclosed(p, chain, result, links, matrix[0, 0] + matrix[1, 1], determinant(p, chain))


def check_arcs(p: Balls, chain: Chain, links: list[ArcBounds]) -> None:
    """Raise Refused unless every arc leaves its first event, meets nothing on its way, and reaches its last event."""
    for j, (side, one) in enumerate(zip(chain.sides, links, strict=True)):
        check_arc(p.on(side), side, (chain.kinds[j], chain.kinds[(j + 1) % len(links)]), one)


def check_arc(p: Balls, side: int, kinds: tuple[int, int], one: ArcBounds) -> None:
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
    check_equal(p)
    if not p.response < 1:
        raise Refused("the motion without events reaches the base, or may reach it")
    if p.brace_angle is not None and not 1 + p.response < p.brace_angle:
        raise Refused("the motion without events reaches a brace, or may reach it")
