"""Proof of a horseshoe: by a transversal crossing of manifolds at Θ = 0, or by the block shift of two words of events."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat, ctx

from rocking.kernels.event_kinds import IMPACT
from rocking.model.orbit import Orbit
from rocking.model.proof import Horseshoe
from rocking.model.system import System
from rocking.proof.arc import Balls, Refused, Values, balls_of, hull, stays_positive
from rocking.proof.chain import ArcBounds, Chain, law, link, links_of, place
from rocking.proof.periodic import chain_of, check_arc, solved

PRECISIONS = (128, 256, 512)


def tangle_of(system: System) -> Horseshoe:
    """Return the proof by the closed form, at the first precision that suffices."""
    reason = ""
    for bits in PRECISIONS:
        with ctx.workprec(bits):
            try:
                phase = float(crossing(balls_of(system, {})))
            except Refused as refusal:
                reason = str(refusal)
                continue
        claim = (
            "the manifolds of the saddle orbits cross transversally at Θ = 0, "
            f"at the forcing phase {phase:.3g} rad"
        )
        return Horseshoe(system, True, claim, phase)
    return Horseshoe(system, False, reason)


def crossing(p: Balls) -> arb:
    """Return the phase of a transversal crossing whose arcs stay on their side; raise Refused if there is none."""
    if not p.restitution > 0:
        raise Refused("the impact takes all energy, so that the motion cannot be reversed")
    if not p.response < 1:
        raise Refused("the saddle orbits reach Θ = 0, or may reach it")
    gain, loss = 1 + p.restitution, 1 - p.restitution
    size = p.response * (gain**2 + (p.frequency * loss) ** 2).sqrt()
    if not size > loss:
        raise Refused(
            "the manifolds do not cross, or it is not decided: the amplitude is not above that of their tangency"
        )
    shift, opening = (p.frequency * loss / gain).atan(), (-loss / size).acos()
    for root in (opening - shift, -opening - shift):
        if arcs_stay(p, root):
            return root
    raise Refused("the manifolds cross, but their arcs reach Θ = 0 before, or may reach it")


def arcs_stay(p: Balls, phase: arb) -> bool:
    """Return whether both arcs that meet at a phase stay on their side of Θ = 0."""
    longest = ((1 + p.response) / (1 - p.response)).log() + 1
    return all(
        bool(arc(arb(0)).first > 0) and stays_positive(arc, longest, 1, False)
        for arc in (distance(p, phase, -1), distance(p, phase, 1))
    )


def distance(p: Balls, phase: arb, sign: int) -> Callable[[arb], Values]:
    """Return 1 + sign β cos(ψ + sign Ω t) - (1 + sign β cos ψ) e^-t as a function of t, with its derivatives."""
    rate, swing = sign * p.frequency, sign * p.response
    start = 1 + swing * phase.cos()

    def at(time: arb) -> Values:
        sine, cosine = (phase + rate * time).sin_cos()
        decay = start / time.exp()
        return Values(
            1 + swing * cosine - decay,
            decay - swing * rate * sine,
            -decay - swing * rate * rate * cosine,
            decay + swing * rate**3 * sine,
        )

    return at


# Radii of the boxes of both words that are tried, in rad.
RADII = (3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7)
# Largest distance of two orbits at an event, in forcing phase and in speed.
NEAR = 0.3
BITS = 128
# Number of pairs that are tried, from the nearest on.
PAIRS = 400


class Word(NamedTuple):
    """Closed chain of events over whole cycles, with the middles of its phases."""

    chain: Chain
    phases: list[arb]  # exact

    @property
    def cycles(self) -> int:
        """Number of forcing cycles."""
        return self.chain.half_turns // 2

    @property
    def kinds(self) -> tuple[int, ...]:
        """Kinds of the last event before the word, of its own events, and of the first event after it."""
        return (self.chain.kinds[-1], *self.chain.kinds, self.chain.kinds[0])

    @property
    def sides(self) -> list[int]:
        """Side of the arc before the first event, and of the arc after each event."""
        return [self.chain.side * (-1 if self.chain.kinds[0] == IMPACT else 1), *self.chain.sides]

    def boxes(self, radius: float) -> list[arb]:
        """Return the boxes of the phases."""
        return [psi + arb(0, radius) for psi in self.phases]


def whole_chain(chain: Chain, phases: list[float]) -> Chain:
    """Return the chain over a whole period: of a symmetric orbit, half a period and its mirror image."""
    if not chain.mirrored:
        return chain._replace(phases=tuple(phases))
    turn = chain.half_turns * math.pi
    later = tuple(psi + turn for psi in phases)
    return Chain(2 * chain.kinds, chain.side, 2 * chain.half_turns, False, (*phases, *later))


def rotated(chain: Chain, count: int) -> Chain:
    """Return a chain that begins with a later event, at a phase in [0, 2 pi)."""
    turn = chain.half_turns * math.pi
    phases = [*chain.phases[count:], *(psi + turn for psi in chain.phases[:count])]
    back = math.tau * math.floor(phases[0] / math.tau)
    kinds = chain.kinds[count:] + chain.kinds[:count]
    return chain._replace(kinds=kinds, side=chain.sides[count], phases=tuple(psi - back for psi in phases))


def joined(*chains: Chain) -> Chain:
    """Return chains one after the other, as a guess of a closed chain."""
    phases: list[float] = []
    kinds: tuple[int, ...] = ()
    turns = 0
    for chain in chains:
        phases += [psi + turns * math.pi for psi in chain.phases]
        kinds, turns = kinds + chain.kinds, turns + chain.half_turns
    return Chain(kinds, chains[0].side, turns, False, tuple(phases))


def pairs(p: Balls, chains: list[Chain]) -> list[tuple[Chain, Chain]]:
    """Return pairs of chains that begin with events near each other in phase and speed, the nearest first."""
    starts = []
    for owner, chain in enumerate(chains):
        links = links_of(p, chain, [arb(psi) for psi in chain.phases]) or []
        starts += [
            (owner, k, chain.kinds[k], chain.sides[k], chain.phases[k] % math.tau, float(one.leaves))
            for k, one in enumerate(links)
        ]
    number, event, kind, side, phase, speed = np.array(starts).T.reshape(6, -1)
    near: list[tuple[float, int, int]] = []
    for i in range(len(starts)):
        apart = np.maximum(abs(phase - phase[i]), abs(speed - speed[i]))
        same = (number != number[i]) & (kind == kind[i]) & (side == side[i]) & (apart < NEAR)
        near += [(float(apart[j]), i, int(j)) for j in np.flatnonzero(same)]
    return [
        (rotated(chains[int(number[i])], int(event[i])), rotated(chains[int(number[j])], int(event[j])))
        for _, i, j in sorted(near)[:PAIRS]
    ]


def word_of(p: Balls, chain: Chain) -> Word:
    """Return the word of a proved closed chain; raise Refused if it is not proved."""
    result, _ = solved(p, chain)
    return Word(chain, [psi.mid() for psi in result.box])


def block_links(p: Balls, word: Word, phases: list[arb]) -> list[ArcBounds]:
    """Return the arcs of a word. ``phases`` begin with the last event before it and end with the first event after it."""
    kinds = word.kinds
    if not all(one < other for one, other in pairwise(phases)):
        raise Refused("events may change their order")
    return [
        link(p, side, (place(p, kinds[j]), place(p, kinds[j + 1])), (phases[j], phases[j + 1]))
        for j, side in enumerate(word.sides)
    ]


def check_block(p: Balls, word: Word, radius: float, before: arb, after: arb) -> None:
    """Raise Refused unless the box of a word is taken into itself for all neighbours in balls, without other events.

    The neighbours vary by at least the radius, so that the operator is a contraction of whole sequences, too.
    """
    k = len(word.phases)
    exact = block_links(p, word, [before.mid(), *word.phases, after.mid()])
    links = block_links(p, word, [before, *word.boxes(radius), after])
    laws = [law(p, kind) for kind in word.chain.kinds]
    residual = arb_mat([[exact[j + 1].leaves + laws[j] * exact[j].arrives] for j in range(k)])
    rows = [[arb(0)] * (k + 2) for _ in range(k)]
    for j in range(k):
        rows[j][j] += laws[j] * links[j].by[2]
        rows[j][j + 1] += laws[j] * links[j].by[3] + links[j + 1].by[0]
        rows[j][j + 2] += links[j + 1].by[1]
    middle = np.array([[float(x) for x in row[1:-1]] for row in rows])
    inverse = arb_mat([[arb(float(x)) for x in row] for row in np.linalg.inv(middle)])
    step, product = inverse * residual, inverse * arb_mat(rows)
    reach = [before.rad(), *[arb(radius)] * k, after.rad()]
    for i in range(k):
        spread = sum((abs(int(j == i + 1) - product[i, j]) * reach[j] for j in range(k + 2)), arb(0))
        if not spread + abs(step[i, 0]) < radius:
            raise Refused("the box of a word is not taken into itself")
    for j, one in enumerate(links):
        check_arc(p, word.sides[j], (word.kinds[j], word.kinds[j + 1]), one)


def are_distinct(a: Word, b: Word, radius: float) -> bool:
    """Return whether the first event after the word a certainly differs from the event of the longer word b with its number."""
    k, turn = len(a.phases), 2 * a.cycles * arb.pi()
    if len(b.phases) <= k:
        return False
    if b.chain.kinds[k] != a.chain.kinds[0]:
        return True
    here = b.boxes(radius)[k]
    return not any(here.overlaps(one.boxes(radius)[0] + turn) for one in (a, b))


def check_shift(p: Balls, a: Word, b: Word, radius: float) -> None:
    """Raise Refused unless every sequence of two words is the sequence of events of exactly one motion."""
    if not are_distinct(a, b, radius):
        raise Refused("the two words are not distinct: their events may be the same")
    ends = [word.boxes(radius)[-1] - 2 * word.cycles * arb.pi() for word in (a, b)]
    starts = [word.boxes(radius)[0] for word in (a, b)]
    for word in (a, b):
        after = hull(*starts) + 2 * word.cycles * arb.pi()
        check_block(p, word, radius, hull(*ends), after)


def entropy(a: int, b: int) -> float:
    """Return a lower bound of h with e^(-h a) + e^(-h b) = 1, by bisection."""
    low, high = 0.0, 1.0
    for _ in range(60):
        h = 0.5 * (low + high)
        low, high = (h, high) if math.exp(-h * a) + math.exp(-h * b) > 1.0 + 1e-12 else (low, h)
    return low


def shift_of(p: Balls, chains: list[Chain]) -> tuple[Word, Word]:
    """Return two words made of the chains of unstable orbits; raise Refused if there are none."""
    for first, second in pairs(p, chains):
        try:
            a, b = word_of(p, first), word_of(p, joined(first, second, first))
        except Refused:
            continue
        for radius in RADII:
            try:
                check_shift(p, a, b, radius)
            except Refused:
                continue
            return a, b
    raise Refused("no two words of the orbits are proved to follow each other in any order")


def whole_chains(p: Balls, orbits: list[Orbit]) -> Iterator[Chain]:
    """Yield the chains of those orbits that are proved and have events."""
    for orbit in orbits:
        if not orbit.superstable and (orbit.impacts or orbit.brace_hits):
            try:
                chain = chain_of(orbit)
                result, _ = solved(p, chain)
            except Refused:
                continue
            yield whole_chain(chain, [float(psi) for psi in result.box])


def word_shift_of(system: System, orbits: list[Orbit]) -> Horseshoe:
    """Return the proof by two words made of unstable orbits of a system."""
    with ctx.workprec(BITS):
        p = balls_of(system, {})
        try:
            a, b = shift_of(p, list(whole_chains(p, orbits)))
        except Refused as refusal:
            return Horseshoe(system, False, str(refusal))
    bound = entropy(a.cycles, b.cycles)
    words = " and ".join(f"{len(one.phases)} events in {one.cycles} cycles" for one in (a, b))
    claim = (
        f"each sequence of two patterns, with {words}, is followed by exactly one motion near them; "
        f"the topological entropy is at least {math.floor(1e4 * bound) / 1e4:.4f} per cycle"
    )
    return Horseshoe(system, True, claim, cycles=(a.cycles, b.cycles), entropy=bound)
