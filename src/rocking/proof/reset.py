"""Proof of an orbit that rests in every period: one flight from a release to the next rest decides it.

Every release is the same state, up to the mirror image, because lift-off comes where |A cos psi| = 1. So if the block that is
released comes to rest, it is released again after j half turns of the forcing phase. If j is odd, the orbit is symmetric with
period j. If j is even, it has the period j/2. Perturbations vanish at rest, so that the orbit is stable.
"""

from __future__ import annotations

from rocking.proof.balls import Balls, Refused
from rocking.proof.trajectory import State, after_event, flight, half_turns_to_release, release, rests

# Number of events between two rests, after which the proof is given up.
MAX_EVENTS = 2000


def next_release(p: Balls, state: State) -> int:
    """Return the half turns of the release after the next rest."""
    for _ in range(MAX_EVENTS):
        if rests(p, state) is not None:
            return half_turns_to_release(p, state.phase)
        state = after_event(p, state, flight(p, state))
    raise Refused(f"the block does not rest within {MAX_EVENTS} events")


def turns_of_reset(p: Balls) -> int:
    """Return the half turns between two releases of the orbit that rests."""
    if not (0 < p.restitution < 1 and p.amplitude > 1):
        raise Refused("an orbit that rests is proved only for 0 < e < 1 and A > 1")
    return next_release(p, release(p, 0))
