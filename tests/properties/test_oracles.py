"""The oracles against closed forms and against each other: proof by subdivision, and plain dense scan."""

import math

import pytest
from flint import arb

from oracles.arcs import FAMILIES, arcs
from oracles.crossing import first_events
from oracles.distance import Arc
from oracles.motion import first_crossing


@pytest.mark.parametrize("velocity", [1e-12, 0.3, 0.99])
def test_proved_return_of_free_flight(velocity):
    (event,) = first_events(Arc(0.0, 1.0, math.inf, 1, 0.0, velocity, 0.0))
    assert event.time.overlaps(2 * arb(velocity).atanh())
    assert event.velocity.overlaps(-arb(velocity))


def test_proved_fall_of_a_released_free_block():
    (event,) = first_events(Arc(0.0, 1.0, math.inf, -1, 0.75, 0.0, 0.0))
    assert event.time.overlaps(arb(4).acosh())
    assert float(event.time.rad()) < 1e-40


@pytest.mark.parametrize("family", FAMILIES)
def test_proof_and_dense_scan_find_the_same_first_event(family):
    for arc in arcs(family, 40, 5):
        events = [event for event in first_events(arc) if event.definite or event.depth < 0]
        kind, time = first_crossing(arc)
        assert events[0].kind in (kind, "any"), (arc, kind, events)
        if events[0].definite and events[0].kind == kind != "none":
            assert abs(time - events[0].time) <= events[0].time / arb(10) ** 40, (arc, events)
