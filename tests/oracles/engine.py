"""The package's first event of an arc, in the terms of the oracle."""

import math

from rocking.kernels import event_kinds
from rocking.kernels.arc import first_zero_cosine
from rocking.kernels.arc.slender_cosine import arc_from, propagator_or_none
from rocking.kernels.system import harmonic_parameters

KINDS = {event_kinds.IMPACT: "base", event_kinds.BRACE: "brace"}


def first_event(arc, guess=None):
    """Return the first event of an `oracles.distance.Arc`, from a guess of its time or without one.

    The result is (kind, time, d|Θ|/dτ), of kind "base", "brace" or "none".
    """
    system = harmonic_parameters(
        arc.amplitude, arc.frequency, 2 * math.pi / arc.frequency, arc.phase, 1.0, arc.brace, 1.0
    )
    flight = arc_from(system, arc.side, 0.0, arc.angle, arc.velocity)
    elapsed = 0.0
    while True:
        if guess is None:
            coming = first_zero_cosine.any_event(system, event_kinds.FLIGHT, flight)
        else:
            coming, _ = first_zero_cosine.next_event(
                system, event_kinds.FLIGHT, flight, propagator_or_none(system, guess)
            )
        if coming.event in KINDS:
            return KINDS[coming.event], elapsed + coming.wait, coming.velocity
        if coming.wait == math.inf:
            return "none", math.inf, math.nan
        elapsed += coming.wait  # a long arc is renewed
        flight = arc_from(system, arc.side, elapsed, coming.angle, coming.velocity)
