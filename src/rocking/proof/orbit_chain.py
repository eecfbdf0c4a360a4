"""Chain of events of an orbit: a guess, taken from a simulation of one period."""

from __future__ import annotations

from attrs import evolve

from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.model import Orbit
from rocking.motion import simulate
from rocking.proof.chain import Chain


def chain_of(orbit: Orbit) -> Chain:
    """Return the events of an orbit in their order; of a symmetric one, those of half a period.

    Raises
    ------
    ValueError
        If the simulated motion has another number of events than the orbit.
    """
    forcing, half = orbit.system.periodic, orbit.symmetric
    begun = evolve(orbit.system, forcing=evolve(forcing, phase=orbit.phase))
    events = simulate(begun, orbit.state, cycles=orbit.period).events
    names = [str(name) for name in events["kind"]]
    counts = names.count("impact"), names.count("brace")
    if counts != (orbit.impacts, orbit.brace_hits) or sum(counts) != len(names):
        raise ValueError(
            "the simulated motion has not the events of the orbit: it leaves it within one period"
        )
    kinds = [IMPACT if name == "impact" else BRACE for name in names]
    count = len(kinds) // 2 if half else len(kinds)
    phases = [orbit.phase + forcing.frequency * float(time) for time in events["time"][:count]]
    return Chain(
        tuple(kinds[:count]),
        1 if events["after"][0] * (1 if kinds[0] == IMPACT else -1) > 0 else -1,
        orbit.period if half else 2 * orbit.period,
        half,
        tuple(phases),
    )
