"""Validation of a closed event chain: every arc is marched to its end; distance to a touch."""

import math
from typing import NamedTuple

from rocking.kernels.arc.extrema_cosine import peak_with
from rocking.kernels.arc.first_zero_cosine import next_event
from rocking.kernels.arc.slender_cosine import arc_from, evaluate, propagator_or_none
from rocking.kernels.base.cosine import harmonic_term
from rocking.kernels.block.impact import after_event
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT, NONE
from rocking.kernels.library.kernel import kernel
from rocking.kernels.orbits.chain import arc_at, event_after, place_of, side_after

# Events further apart in time than this are different.
APART = 1e-6
# A motion that nearly touches base or brace reaches it within this time of the extremum, if at all.
NEAR_TOUCH = 1e-3
MAX_TURNS = 20
# Shortest time after a touch at which the arc is clear of the surface again.
SHORTEST_TOUCH = 1e-6
# Maximum number of restarts of one arc.
LONG_ARCS = 64


class Condition(NamedTuple):
    """Condition that makes a point special; for a grazing also the place where the orbit touches base or brace."""

    kind: int  # a ``Special``
    arc: int  # the arc that touches, -1 if there is none
    level: int  # IMPACT if it touches the base, BRACE if a brace
    time: float  # from the start of the arc


class Contact(NamedTuple):
    """Contact of an arc with base or brace."""

    event: int
    time: float  # from the start of the arc
    peak: float  # largest angle so far


UNCONDITIONAL = Condition(-1, -1, IMPACT, 0.0)


@kernel
def first_contact(p, arc, t, waited, peak):
    """March an arc to its first contact with base or brace, which is expected at the time ``t``.

    The arc begins at the time ``waited``. NONE at an infinite time if there is no contact.
    """
    event = NONE
    for _ in range(LONG_ARCS):
        coming, _ = next_event(p, FLIGHT, arc, propagator_or_none(p, max(t - waited, 0.0)))
        if coming.wait == math.inf:
            return Contact(NONE, math.inf, peak)
        peak = peak_with(p, arc, coming, peak)
        waited += coming.wait
        event = coming.event
        if event != NONE:
            break
        _, arc = after_event(p, arc, arc.start + coming.wait, coming, 0.0, math.inf)
    return Contact(event, waited, peak)


@kernel
def contact_after_touch(p, arc, t, condition, touch):
    """March an arc on from its touch, as if it had no contact there.

    Rounding decides how deep the arc reaches. It is as far above the level again at the same time after its
    turning point as it reached it before. NONE if it is not.
    """
    ahead = max(2.0 * abs(touch.time - condition.time), SHORTEST_TOUCH)
    while ahead <= 2.0 * NEAR_TOUCH and condition.time + ahead < t:
        now = evaluate(p, arc, condition.time + ahead)
        above = p.block.brace_angle - now.angle if condition.level == BRACE else now.angle
        if above > 0.0:
            waited = condition.time + ahead
            rest = arc_from(p, arc.side, arc.start + waited, now.angle, now.velocity)
            return first_contact(p, rest, t, waited, touch.peak)
        ahead *= 2.0
    return Contact(NONE, math.inf, touch.peak)


@kernel
def verify_chain(p, chain, y, links, condition):
    """March every arc of a chain to its end, and check that the motion is that of the chain.

    The check fails if an arc reaches base or brace before its end, or leaves an event into the base or the
    brace. Only the arc of the condition may reach the surface that it touches, at about the time of the
    touch. It is marched on from there.

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
        contact = first_contact(p, arc, t, 0.0, peak)
        touches = j == condition.arc and contact.event == condition.level
        if touches and abs(contact.time - condition.time) <= NEAR_TOUCH and t - contact.time > APART:
            contact = contact_after_touch(p, arc, t, condition, contact)
        peak = contact.peak
        if not (contact.event == last and abs(contact.time - t) <= APART):
            return False, peak
        side = side_after(side, last)
    return True, peak


@kernel
def slowest_arrival(links, k):
    """Return the least speed at which a chain of k events reaches one of them."""
    slowest = math.inf
    for j in range(k):
        slowest = min(slowest, abs(links[j].arrives))
    return slowest


@kernel
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
        acceleration = now.angle + harmonic_term(p, now.drive.cosine)
        step = -now.velocity / acceleration
        if not 0.0 < t + step < links[touched].time:
            return math.nan, t
        t += step
        now = evaluate(p, arc, t)
        if abs(step) <= 1e-12:
            break
    return (p.block.brace_angle - now.angle if condition.level == BRACE else now.angle), t
