"""Whether the motion is what a closed chain of arcs says: every arc marched to its first event, and how near it comes to others."""

import math
from typing import NamedTuple

from numba import njit

from rocking.kernels.arc.extrema import peak_with
from rocking.kernels.arc.solution import evaluate, propagator_or_none
from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, NONE
from rocking.kernels.forcing.harmonic import forcing_term
from rocking.kernels.march.impact_law import after_event
from rocking.kernels.march.next_event import next_event
from rocking.kernels.orbits.event_chain import arc_at, event_after, place_of, side_after

# Events as far apart as this, in time, are not the same.
APART = 1e-6
# A motion that all but touches meets what it touches this near to the turn, if at all.
NEAR_TOUCH = 1e-3
MAX_TURNS = 20
# One arc is renewed so often at most.
LONG_ARCS = 64


class Condition(NamedTuple):
    """What makes a point special: of a grazing also where the orbit touches the base or a brace."""

    kind: int  # a ``Special``
    arc: int  # the arc that touches, -1 where none does
    level: int  # what it touches: IMPACT for the base, BRACE
    time: float  # from the start of the arc


UNCONDITIONAL = Condition(-1, -1, IMPACT, 0.0)


@njit(**INTERNAL)
def verify_chain(p, chain, y, links, condition):
    """(whether the motion is the chain's own, its largest angle): every arc is marched to its first event.

    An arc that meets something before its end is not, nor one that leaves an event into the base or the brace. Only the arc
    of the condition may meet what it touches, at about the time of the touch.
    """
    side, peak = chain.side, 0.0
    for j in range(chain.kinds.shape[0]):
        kind, last, leaves, t = (
            chain.kinds[j],
            chain.kinds[event_after(chain, j)],
            links[j].leaves,
            links[j].time,
        )
        if not (leaves > 0.0 if kind == IMPACT else leaves < 0.0):
            return False, peak
        arc = arc_at(p, side, y[j], place_of(p, kind), leaves)
        waited = 0.0
        for _ in range(LONG_ARCS):
            coming, _ = next_event(p, FLIGHT, arc, propagator_or_none(p, max(t - waited, 0.0)))
            if coming.wait == math.inf:
                return False, peak
            peak = peak_with(p, arc, coming, peak)
            waited += coming.wait
            if coming.event != NONE:
                break
            _, arc = after_event(p, arc, arc.start + coming.wait, coming, 0.0)
        met = coming.event == last and abs(waited - t) <= APART
        if not met and not (j == condition.arc and abs(waited - condition.time) <= NEAR_TOUCH):
            return False, peak
        side = side_after(side, last)
    return True, peak


@njit(**INTERNAL)
def clearance(p, chain, y, links, condition):
    """(distance left to what an arc touches, where it turns; time of that): by Newton's method from a time near."""
    touched, t, side = condition.arc, condition.time, chain.side
    for j in range(touched):
        side = side_after(side, chain.kinds[j + 1])
    arc = arc_at(p, side, y[touched], place_of(p, chain.kinds[touched]), links[touched].leaves)
    now = evaluate(p, arc, t)
    for _ in range(MAX_TURNS):
        acceleration = now.angle + forcing_term(p, now.cosine)
        step = -now.velocity / acceleration
        if not 0.0 < t + step < links[touched].time:
            return math.nan, t
        t += step
        now = evaluate(p, arc, t)
        if abs(step) <= 1e-12:
            break
    return (p.brace_angle - now.angle if condition.level == BRACE else now.angle), t
