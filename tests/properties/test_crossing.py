"""The first crossing of an arc against an oracle that proves it in ball arithmetic."""

import math

import numpy as np
import pytest
from flint import arb

from oracles.arcs import FAMILIES, TURN, arcs
from oracles.crossing import condition, first_events
from oracles.distance import ROUNDING, Arc, Distance
from oracles.engine import first_event

CHUNK = 300
CHUNKS = 9  # × CHUNK × 8 families: 21,600 arcs
LONG_CHUNK = 9_000
LONG_CHUNKS = 14  # 1,008,000 arcs
ROUNDINGS = 100  # of the terms of w and w', by which a returned time and speed may miss
ACCURACY = 5e-15


def _agrees(arc, event, found):
    """Return whether the package found this event: kind, place, distance zero to rounding, direction."""
    kind, time, velocity = found
    if event.kind in ("any", "none"):
        return event.kind in ("any", kind)
    if kind != event.kind or not (0 < time < math.inf and abs(arb(time) - event.time) <= event.time / 100):
        return False
    distance, time = Distance(arc, kind), arb(time)
    w, rate, bend, _ = distance.at(time)
    slip = ROUNDING * time
    off = abs(distance.outward * velocity - rate)
    on_zero = abs(w) <= ROUNDINGS * ROUNDING * distance.size(time) + 2 * slip * abs(rate)
    right_speed = off <= ROUNDINGS * ROUNDING * distance.rate_size(time) + 2 * slip * abs(bend)
    return bool(on_zero and right_speed and (distance.outward * velocity <= 0 or not event.definite))


def _guesses(arc, events):
    """Yield no guess, a good one and one beyond the event: a guess may cost time, but never changes the result."""
    time = float(events[-1].time)
    return (None, time * 1.001, time * 2.5) if events[-1].kind == "base" else (None, 1.0)


def _wrong(family, count, seed):
    """Arcs whose first event the package misses or misreads."""
    wrong = []
    for arc in arcs(family, count, seed):
        events = first_events(arc)
        for guess in _guesses(arc, events):
            found = first_event(arc, guess)
            if not any(_agrees(arc, event, found) for event in events):
                wrong.append(
                    (arc, guess, found, [(e.kind, float(e.time), float(e.velocity), e.depth) for e in events])
                )
    return wrong


def _report(wrong):
    return f"{len(wrong)} wrong; the first: {wrong[:3]}"


@pytest.mark.parametrize("chunk", [0, *(pytest.param(k, marks=pytest.mark.long) for k in range(1, CHUNKS))])
@pytest.mark.parametrize("family", FAMILIES)
def test_no_first_crossing_is_missed_or_misread(family, chunk):
    wrong = _wrong(family, CHUNK, chunk)
    assert not wrong, _report(wrong)


@pytest.mark.long
@pytest.mark.parametrize("chunk", range(LONG_CHUNKS))
@pytest.mark.parametrize("family", FAMILIES)
def test_no_first_crossing_is_missed_or_misread_in_a_million_arcs(family, chunk):
    wrong = _wrong(family, LONG_CHUNK, 1000 + chunk)
    assert not wrong, _report(wrong)


def _misses(arc, off):
    """Return condition numbers and relative errors of time and speed of an impact guessed ``off``; None for other arcs."""
    event, *more = first_events(arc)
    if more or event.kind != "base" or not math.isinf(event.depth):
        return None
    _, time, velocity = first_event(arc, off and off * float(event.time))
    misses = (time - event.time) / event.time, (velocity - event.velocity) / event.velocity
    return condition(arc, event), [abs(float(miss)) for miss in misses]


def _share(conditions, misses, inputs):
    """Return the larger relative error over 5e-15 times the largest condition number for the first ``inputs``."""
    largest = max(max(numbers[:inputs]) for numbers in conditions)
    return max(misses) / (ACCURACY * max(1.0, largest))


@pytest.mark.parametrize("off", [None, 1.01], ids=["without a guess", "with a guess"])
@pytest.mark.parametrize("chunk", range(2))
def test_impact_time_and_speed_to_five_parts_in_1e15_times_their_condition(chunk, off):
    """Speeds 1e-12 … 0.3 from the base; the condition number is with respect to (v₀, ψ₀, Ω)."""
    found = [
        (*result, arc) for arc in arcs("slow_from_base", 1500, 50 + chunk) if (result := _misses(arc, off))
    ]
    shares = [(_share(conditions, misses, 3), arc) for conditions, misses, arc in found]
    alone = [
        max(miss / max(1.0, *numbers[:3]) for numbers, miss in zip(conditions, misses, strict=True))
        / ACCURACY
        for conditions, misses, _ in found
    ]
    worst, arc = max(shares)
    report = (
        f"worst share of the tolerance: {worst:.3f} ({arc}); time and speed each by its own: {max(alone):.3f}"
    )
    print(report)
    assert len(found) > 1000
    assert worst <= 1, report


@pytest.mark.parametrize("family", ["stretch_boundary", "grazing_slow"])
def test_impact_time_and_speed_of_adverse_arcs_to_five_parts_in_1e15_times_their_condition(family):
    """The acceleration at the start nearly vanishes: the last digit of the amplitude matters like those of the others."""
    slow = [arc for arc in arcs(family, 1200, 60) if arc.angle == 0 and arc.velocity <= 0.3]
    found = [(_share(*result, 4), arc) for arc in slow if (result := _misses(arc, None))]
    worst, arc = max(found)
    report = f"worst share of the tolerance: {worst:.3f} ({arc})"
    print(report)
    assert len(found) > 30
    assert worst <= 1, report


def test_a_start_on_a_stretch_boundary_at_1e12_meets_the_base_falling():
    """Rounding there once made an "impact" with rising angle."""
    rng = np.random.default_rng(11)
    wrong = []
    for _ in range(500):
        amplitude, side = float(rng.uniform(1.01, 100)), int(rng.choice([-1, 1]))
        phase = math.acos(-side / amplitude)
        phase = (phase if rng.random() < 0.5 else TURN - phase) + float(rng.integers(-4, 5)) * math.ulp(phase)
        arc = Arc(amplitude, float(rng.uniform(0.1, 50)), math.inf, side, 0.0, 1e-12, phase)
        events, found = first_events(arc), first_event(arc)
        if not any(_agrees(arc, event, found) for event in events):
            wrong.append(
                (arc, None, found, [(e.kind, float(e.time), float(e.velocity), e.depth) for e in events])
            )
    assert not wrong, _report(wrong)


def test_a_second_dip_is_found_after_a_first_that_does_not_reach_zero():
    """Arcs that clear the base by a hair and meet it later: the oracle's dips are not the event, a later one is."""
    later = 0
    for arc in arcs("grazing_base", 600, 12):
        events = first_events(arc)
        if len(events) > 1 or events[-1].kind != "base" or not math.isinf(events[-1].depth):
            continue
        found = first_event(arc)
        assert _agrees(arc, events[-1], found), (arc, found, events)
        later += 1
    assert later > 60


def test_a_dip_narrower_than_a_billionth_of_its_stretch_is_found():
    """Falling slowly from a hair above the base while the base pushes the block up: there the parabola is the arc."""
    rng = np.random.default_rng(19)
    for _ in range(300):
        amplitude, frequency = float(rng.uniform(100, 1000)), float(rng.uniform(0.1, 0.3))
        height, phase = float(10.0 ** rng.uniform(-16, -13)), float(rng.uniform(0.6, 1.0)) * math.pi
        pull = height - 1.0 - amplitude * math.cos(phase)
        speed = math.sqrt(2.0 * height * pull) * float(1.0 + 10.0 ** rng.uniform(-2, 0))
        arc = Arc(amplitude, frequency, math.inf, 1, height, -speed, phase)
        kind, time, _ = first_event(arc)
        assert kind == "base", arc
        assert time == pytest.approx((speed - math.sqrt(speed**2 - 2.0 * height * pull)) / pull, rel=1e-5), (
            arc
        )


def test_hundreds_of_stretches_do_not_hide_the_base():
    """Ω 100–200 and flights of many time constants."""
    rng = np.random.default_rng(13)
    longest = 0.0
    for _ in range(150):
        amplitude, frequency = float(rng.uniform(2, 100)), float(rng.uniform(100, 200))
        phase, side = float(rng.uniform(0, TURN)), int(rng.choice([-1, 1]))
        ripple = side * amplitude / (1 + frequency**2)
        velocity = (
            1 + ripple * (math.cos(phase) - frequency * math.sin(phase)) - float(np.exp(rng.uniform(-25, -2)))
        )
        arc = Arc(amplitude, frequency, math.inf, side, 0.0, velocity, phase)
        events, found = first_events(arc), first_event(arc)
        assert any(_agrees(arc, event, found) for event in events), (arc, found, events)
        longest = max(longest, frequency * float(events[-1].time) / TURN)
    assert longest > 300


@pytest.mark.parametrize("amplitude", [0.0, 0.3, 1.0])
def test_no_return_is_proved_without_any_stretch_boundary(amplitude):
    """A ≤ 1: the forcing term never changes sign."""
    arc = Arc(amplitude, 2.0, math.inf, 1, 0.0, 2.5, 0.7)
    assert first_events(arc)[-1].kind == "none"
    assert first_event(arc)[0] == "none"


@pytest.mark.parametrize("velocity", [1e-12, 1e-6, 0.01, 0.5, 0.9])
def test_free_flight_takes_twice_the_artanh_of_its_speed(velocity):
    """A = 0: u = 1 − cosh t + v sinh t, back at t = 2 artanh v with speed v."""
    kind, time, speed = first_event(Arc(0.0, 3.0, math.inf, 1, 0.0, velocity, 0.4))
    assert kind == "base"
    assert math.isclose(time, 2 * math.atanh(velocity), rel_tol=1e-15 * max(4, 1 / (1 - velocity)))
    assert math.isclose(speed, -velocity, rel_tol=1e-15 * max(4, 1 / (1 - velocity)))
