"""The package's first event of an arc, in the terms of the oracle."""

import math

from rocking.kernels import events
from rocking.kernels.arc import arc_from, recall
from rocking.kernels.parameters import harmonic_parameters

KINDS = {events.IMPACT: "base", events.BRACE: "brace"}


def first_event(arc, guess=None):
    """(kind, time, d|Θ|/dτ) of an `oracles.distance.Arc`: kind "base", "brace" or "none"; from a guess of the time or without one."""
    system = harmonic_parameters(
        arc.amplitude, arc.frequency, 2 * math.pi / arc.frequency, arc.phase, 1.0, arc.brace, 1.0
    )
    flight = arc_from(system, arc.side, 0.0, arc.angle, arc.velocity)
    elapsed = 0.0
    while True:
        if guess is None:
            coming = events.any_event(system, events.FLIGHT, flight)
        else:
            coming, _ = events.next_event(system, events.FLIGHT, flight, recall(system, guess))
        if coming.event in KINDS:
            return KINDS[coming.event], elapsed + coming.wait, coming.velocity
        if coming.wait == math.inf:
            return "none", math.inf, math.nan
        elapsed += coming.wait  # a long arc is renewed
        flight = arc_from(system, arc.side, elapsed, coming.angle, coming.velocity)
