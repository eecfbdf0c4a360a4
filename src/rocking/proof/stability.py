"""Floquet multipliers of a proved orbit as balls, and its stability, symmetry and least period."""

from __future__ import annotations

import math

from flint import acb, arb, arb_mat

from rocking.proof.balls import Balls
from rocking.proof.chain import Chain, Link, law


def monodromy(p: Balls, chain: Chain, links: list[Link]) -> arb_mat:
    """Return the derivative of the return map over the chain, in (u, u') just after the first event.

    The saltation matrix of an event is [[-law, 0], [(u''+ + law u''-)/u'-, -law]].
    """
    product = arb_mat([[1, 0], [0, 1]])
    for j, one in enumerate(links):
        after = (j + 1) % len(links)
        kept = law(p, chain.kinds[after])
        shear = (links[after].start + kept * one.end) / one.arrives
        jump = arb_mat([[-kept, 0], [shear, -kept]])
        product = jump * (arb_mat([[one.cosh, one.sinh], [one.sinh, one.cosh]]) * product)
    return product


def determinant(p: Balls, chain: Chain) -> arb:
    """Return the determinant of the monodromy matrix: exact, because each event contributes the square of its coefficient."""
    total = arb(1)
    for kind in chain.kinds:
        total *= law(p, kind) ** 2
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
