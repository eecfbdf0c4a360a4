"""Chain of events of an orbit: a guess, taken from the motion from its state over one period."""

from __future__ import annotations

from flint import arb

from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.model import Orbit
from rocking.proof.balls import Refused, balls_of
from rocking.proof.chain import Chain
from rocking.proof.trajectory import State, after_event, flight, initial


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
