"""Validation of a closed event chain: every arc is marched to its first event; distance to a touch."""

import math
from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, NONE
from rocking.kernels.forcing.harmonic.acceleration import forcing_term
from rocking.kernels.forcing.harmonic.extrema import peak_with
from rocking.kernels.forcing.harmonic.next_event import next_event
from rocking.kernels.forcing.harmonic.solution import evaluate, propagator_or_none
from rocking.kernels.march.impact_law import after_event
from rocking.kernels.orbits.event_chain import arc_at, event_after, place_of, side_after

# Events further apart in time than this are different.
APART = 1e-6
# A motion that nearly touches base or brace reaches it within this time of the extremum, if at all.
NEAR_TOUCH = 1e-3
MAX_TURNS = 20
# Maximum number of restarts of one arc.
LONG_ARCS = 64


class Condition(NamedTuple):
    """Condition that makes a point special; for a grazing also the place where the orbit touches base or brace."""

    kind: int  # a ``Special``
    arc: int  # the arc that touches, -1 if there is none
    level: int  # IMPACT if it touches the base, BRACE if a brace
    time: float  # from the start of the arc


UNCONDITIONAL = Condition(-1, -1, IMPACT, 0.0)


@njit(**INTERNAL)
def verify_chain(p, chain, y, links, condition):
    """March every arc of a chain to its first event, and check that the motion is that of the chain.

    The check fails if an arc reaches base or brace before its end, or leaves an event into the base or the
    brace. Only the arc of the condition may reach the surface that it touches, at about the time of the
    touch.

    Returns
    -------
    tuple of (bool, float)
        Whether the motion is that of the chain.
        Its largest angle.
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
    """Find the extremum at which an arc nearly touches, by Newton's method from the time in ``condition``.

    Returns
    -------
    tuple of (float, float)
        Distance left to base or brace there, NaN if the extremum leaves the arc.
        Its time.
    """
    touched, t, side = condition.arc, condition.time, chain.side
    for j in range(touched):
        side = side_after(side, chain.kinds[j + 1])
    arc = arc_at(p, side, y[touched], place_of(p, chain.kinds[touched]), links[touched].leaves)
    now = evaluate(p, arc, t)
    for _ in range(MAX_TURNS):
        acceleration = now.angle + forcing_term(p, now.drive.cosine)
        step = -now.velocity / acceleration
        if not 0.0 < t + step < links[touched].time:
            return math.nan, t
        t += step
        now = evaluate(p, arc, t)
        if abs(step) <= 1e-12:
            break
    return (p.block.brace_angle - now.angle if condition.level == BRACE else now.angle), t
