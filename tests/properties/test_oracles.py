"""The oracles against closed forms and against each other: proof by subdivision, and plain dense scan."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from flint import arb

from oracles.arcs import FAMILIES, arcs
from oracles.crossing import first_events
from oracles.distance import Arc
from oracles.long_runs import first_return
from oracles.motion import first_crossing
from oracles.recurrence import judge


@pytest.mark.parametrize("velocity", [1e-12, 0.3, 0.99])
def test_proved_return_of_free_flight(velocity):
    (event,) = first_events(Arc(0.0, 1.0, math.inf, 1, 0.0, velocity, 0.0))
    assert event.time.overlaps(2 * arb(velocity).atanh())
    assert event.velocity.overlaps(-arb(velocity))


def test_proved_fall_of_a_released_free_block():
    (event,) = first_events(Arc(0.0, 1.0, math.inf, -1, 0.75, 0.0, 0.0))
    assert event.time.overlaps(arb(4).acosh())
    assert float(event.time.rad()) < 1e-40


@pytest.mark.parametrize(
    "family",
    [pytest.param(each, marks=pytest.mark.long) if each == "near_saddle" else each for each in FAMILIES],
)
def test_proof_and_dense_scan_find_the_same_first_event(family):
    for arc in arcs(family, 40, 5):
        events = [event for event in first_events(arc) if event.definite or event.depth < 0]
        kind, time = first_crossing(arc)
        assert events[0].kind in (kind, "any"), (arc, kind, events)
        if events[0].definite and events[0].kind == kind != "none":
            assert abs(time - events[0].time) <= events[0].time / arb(10) ** 40, (arc, events)


LABELS = json.loads((Path(__file__).resolve().parents[1] / "data" / "labels.json").read_text())


# what takes a second or more is left to the table's own making
QUICK = [case for case in LABELS if case["kind"] not in ("chaotic", "quasi-periodic") and case["T"] < 4]


@pytest.mark.parametrize("case", QUICK)
def test_brute_force_recurrence_agrees_with_labels_found_elsewhere(case):
    found = judge(case)
    names = {"kind", "period", "impacts_per_period", "symmetric"}
    assert {name: found[name] for name in names} == {name: case[name] for name in names}


def test_first_return_is_the_smallest_lag_and_no_drift_passes_for_one():
    rows = np.tile([[0.1, 0.2], [0.3, -0.1], [0.5, 0.0]], (1400, 1))
    assert first_return(rows, 1e-11) == 3
    drift = np.linspace(0, 1e-8, len(rows))[:, None]  # 7e-12 from one return to the next
    assert first_return(rows + drift, 1e-11) is None


def test_a_response_that_begins_on_an_impact_at_the_section_is_seen_from_another():
    # the mode of A = 7, T = 4/3, e = .9 by its closed form, eqs. (8)-(10)
    omega, less, more = 1.5 * math.pi, 0.1 / 1.8, 1.9 / 1.8
    beta, t = 7 / (1 + omega**2), math.tanh(math.pi / omega / 2)
    square, half = (omega * t * less) ** 2 + more**2, t * more
    speed = (half + math.sqrt(half**2 - square * (t**2 - (omega * beta) ** 2))) / square
    phase = math.atan2((t - speed * more) / omega, -t * speed * less)
    case = {"A": 7.0, "T": 4 / 3, "e": 0.9, "phi": phase, "Theta0": 0.0, "dTheta0": speed}
    found = judge(case | {"brace": None, "r": None})
    assert (found["period"], found["impacts_per_period"], found["symmetric"]) == (1, 2, True)
