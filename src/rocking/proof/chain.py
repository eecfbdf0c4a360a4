"""Equations of the closed chain of events of a periodic orbit, in balls.

The unknowns are the forcing phases of the events. Between two events at known phases the arc is a closed form, Eq. (5) of Yim &
Lin (1991). An equation is the impact law, Eq. (2), at an event: with e, or with the restitution of the braces,

    (speed after) + law (speed before) = 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.proof.arc import Arc, Balls, arc_from


class Chain(NamedTuple):
    """Events of a periodic orbit; of a symmetric orbit, those of half a period."""

    kinds: tuple[int, ...]
    side: int  # of the arc after the first event
    half_turns: int  # of the forcing phase, between the first event and its repetition
    mirrored: bool
    phases: tuple[float, ...]  # guess

    @property
    def sides(self) -> list[int]:
        """Side of the arc after each event."""
        flips = [1] + [-1 if kind == IMPACT else 1 for kind in self.kinds[1:]]
        return [int(side) for side in self.side * np.cumprod(flips)]

    @property
    def closes(self) -> bool:
        """True if the side after the last arc is that of the first one, or its mirror image."""
        if self.half_turns % 2 != self.mirrored:  # mirror images differ by an odd number of half turns
            return False
        last = self.sides[-1] * (-1 if self.kinds[0] == IMPACT else 1)
        return last == (-self.side if self.mirrored else self.side)


class ArcBounds(NamedTuple):
    """Arc between two events."""

    phase: arb
    time: arb
    leaves: arb  # u' at its start
    arrives: arb  # u' at its end
    start: arb  # u'' at its start
    end: arb  # u'' at its end
    sinh: arb
    cosh: arb
    by: tuple[arb, arb, arb, arb]  # of leaves by the phases at start and end, then of arrives

    def arc(self, p: Balls, side: int, angle: arb) -> Arc:
        """Return the arc itself."""
        return arc_from(p, side, self.phase, angle, self.leaves)


def place(p: Balls, kind: int) -> arb:
    """Return the angle u at an event."""
    return arb(0) if kind != BRACE or p.brace_angle is None else p.brace_angle


def law(p: Balls, kind: int) -> arb:
    """Return the coefficient of restitution of an event."""
    return p.brace_restitution if kind == BRACE else p.restitution


def link(p: Balls, side: int, ends: tuple[arb, arb], phases: tuple[arb, arb]) -> ArcBounds:
    """Return the arc between two places at two forcing phases, the second one later."""
    rate, swing = p.frequency, side * p.response
    time = (phases[1] - phases[0]) / rate
    growth = time.exp()
    sinh, cosh = (growth - 1 / growth) / 2, (growth + 1 / growth) / 2
    (sine0, cosine0), (sine1, cosine1) = (phase.sin_cos() for phase in phases)
    above0, above1 = ends[0] - 1 - swing * cosine0, ends[1] - 1 - swing * cosine1
    forward, back = above1 - above0 * cosh, above1 * cosh - above0
    # d/dt of forward/sinh and of back/sinh
    slow, fast = (above0 - above1 * cosh) / (sinh * sinh), (above0 * cosh - above1) / (sinh * sinh)
    turn0, turn1, bend = swing * sine0, swing * sine1, swing * rate
    push = side * p.amplitude
    return ArcBounds(
        phases[0],
        time,
        forward / sinh - bend * sine0,
        back / sinh - bend * sine1,
        ends[0] - 1 - push * cosine0,
        ends[1] - 1 - push * cosine1,
        sinh,
        cosh,
        (
            -turn0 * cosh / sinh - bend * cosine0 - slow / rate,
            turn1 / sinh + slow / rate,
            -turn0 / sinh - fast / rate,
            turn1 * cosh / sinh - bend * cosine1 + fast / rate,
        ),
    )


def links_of(p: Balls, chain: Chain, phases: list[arb]) -> list[ArcBounds] | None:
    """Return the arcs of a chain; None if events may change their order."""
    turn, result = chain.half_turns * arb.pi(), []
    for j, side in enumerate(chain.sides):
        after = (j + 1) % len(phases)
        later = phases[after] + turn if after == 0 else phases[after]
        if not later > phases[j]:
            return None
        ends = place(p, chain.kinds[j]), place(p, chain.kinds[after])
        result.append(link(p.on(side), side, ends, (phases[j], later)))
    return result


def residuals(p: Balls, chain: Chain, links: list[ArcBounds]) -> arb_mat:
    """Return the equations of the chain, a column, with the speeds of both sides in the same units."""
    own = [p.on(side) for side in chain.sides]
    rows = [
        [own[j].speed * one.leaves + law(own[j - 1], kind) * (own[j - 1].speed * links[j - 1].arrives)]
        for j, (kind, one) in enumerate(zip(chain.kinds, links, strict=True))
    ]
    return arb_mat(rows)


def jacobian(p: Balls, chain: Chain, links: list[ArcBounds]) -> arb_mat:
    """Return the derivatives of the equations by the phases."""
    k = len(links)
    rows = [[arb(0)] * k for _ in range(k)]
    for j, (side, one) in enumerate(zip(chain.sides, links, strict=True)):
        after, own = (j + 1) % k, p.on(side)
        kept = law(own, chain.kinds[after]) * own.speed
        rows[j][j] += own.speed * one.by[0]
        rows[j][after] += own.speed * one.by[1]
        rows[after][j] += kept * one.by[2]
        rows[after][after] += kept * one.by[3]
    return arb_mat(rows)
