"""Proofs without a search that an arc meets nothing on its way, and their limits."""

import math

import numpy as np
import pytest

from rocking.kernels import event_kinds
from rocking.kernels.arc import fast_search_cosine, first_zero_cosine
from rocking.kernels.arc.slender_cosine import NONE_YET, arc_from
from rocking.kernels.library.kernel import kernel
from rocking.kernels.system import harmonic_parameters, slender_harmonic

SAMPLES = np.linspace(0.0, 1.0, 300)


@kernel
def stays_between(p, t, angle, velocity, end, arrival):
    system = p.forcing.amplitude, p.forcing.frequency, p.block.brace_angle
    return fast_search_cosine.stays_between(system, t, (angle, velocity), (end, arrival))


@kernel
def misread(systems, starts, told):
    """Count first events that differ from those of the search; ``told`` (n,) takes which of them needed no search."""
    count = 0
    for k in range(len(systems)):
        amplitude, period, brace = systems[k]
        frequency = 2.0 * math.pi / period
        p = slender_harmonic(amplitude, frequency, period, 0.0, 0.9, brace, 1.0)
        arc = arc_from(p, 1, starts[k, 0], starts[k, 1], starts[k, 2])
        told[k] = fast_search_cosine.fast_first_event(p, arc)[0] == fast_search_cosine.ZERO
        likely, _ = first_zero_cosine.next_event(p, event_kinds.FLIGHT, arc, NONE_YET)
        sure = first_zero_cosine.any_event(p, event_kinds.FLIGHT, arc)
        # a rounding of u moves the time by its ratio to the speed
        rounding = 1e-14 * (1.0 + amplitude) * (1.0 + sure.wait) / abs(sure.velocity)
        count += likely.event != sure.event or not abs(likely.wait - sure.wait) <= 1e-9 * sure.wait + rounding
    return count


@kernel
def first_events(p, start, angle, velocity):
    """Return (event, time) of the first event without a search, if certain, and of that by the search."""
    arc = arc_from(p, 1, start, angle, velocity)
    likely, _ = first_zero_cosine.next_event(p, event_kinds.FLIGHT, arc, NONE_YET)
    sure = first_zero_cosine.any_event(p, event_kinds.FLIGHT, arc)
    return (likely.event, likely.wait), (sure.event, sure.wait)


def exponentials(amplitude, frequency, psi, angle, velocity):
    """Return (c+, c-, beta) of the exponential form of eq. (5)."""
    beta = amplitude / (1.0 + frequency**2)
    mean = angle - 1.0 - beta * math.cos(psi)
    rate = velocity + beta * frequency * math.sin(psi)
    return 0.5 * (mean + rate), 0.5 * (mean - rate), beta


def angles(amplitude, frequency, psi, angle, velocity, times):
    grow, shrink, beta = exponentials(amplitude, frequency, psi, angle, velocity)
    return grow * np.exp(times) + shrink * np.exp(-times) + 1.0 + beta * np.cos(psi + frequency * times)


def velocities(amplitude, frequency, psi, angle, velocity, times):
    grow, shrink, beta = exponentials(amplitude, frequency, psi, angle, velocity)
    swung = beta * frequency * np.sin(psi + frequency * times)
    return grow * np.exp(times) - shrink * np.exp(-times) - swung


def test_flight_that_is_said_to_stay_between_meets_nothing():
    """Random arcs, also those that end beyond: the least distance to the base and to the braces, at 300 instants."""
    random = np.random.default_rng(17)
    left = claimed = stayed = 0
    for _ in range(40_000):
        amplitude, period = 1.0 + 10.0 ** random.uniform(-3, 1.3), 10.0 ** random.uniform(-1, 1)
        frequency, psi, brace = (
            math.tau / period,
            math.tau * random.random(),
            10.0 ** random.uniform(-1.5, 0.5),
        )
        angle = brace * random.choice([0.0, random.random(), 1.0])
        velocity, t = random.choice([-1, 1]) * 10.0 ** random.uniform(-3, 0.5), 0.6 * period * random.random()
        motion = (amplitude, frequency, psi, angle, velocity, t * SAMPLES)
        heights, arrival = angles(*motion), velocities(*motion)[-1]
        p = harmonic_parameters(amplitude, frequency, period, 0.0, 0.9, brace, 1.0)
        claims = stays_between(p, t, angle, velocity, heights[-1], arrival)
        between = heights[1:].min() > 0.0 and heights[1:].max() < brace
        assert not claims or between, (amplitude, period, brace, psi, angle, velocity, t)
        left += not between
        stayed += between
        claimed += claims
    # the question has both answers, and the proof is worth its while
    assert left > 2_000
    assert claimed > 0.6 * stayed


@pytest.mark.parametrize("place", ["on the base", "on a brace", "between", "just off a brace"])
def test_first_event_between_braces_is_that_of_the_search(place):
    """Random arcs with amplitudes, periods, braces and speeds over several decades; most need no search."""
    random, count = np.random.default_rng(31), 100_000
    amplitude, period = 1.0 + 10.0 ** random.uniform(-3, 1.3, count), 10.0 ** random.uniform(-1, 1, count)
    brace, speed = 10.0 ** random.uniform(-2, 0.5, count), 10.0 ** random.uniform(-5, 1, count)
    angle, sign = {
        "on the base": (0.0 * brace, 1),
        "on a brace": (brace, -1),
        "between": (brace * random.random(count), random.choice([-1, 1], count)),
        "just off a brace": (
            brace * (1.0 - 10.0 ** random.uniform(-12, 0, count)),
            random.choice([-1, 1], count),
        ),
    }[place]
    starts, told = (
        np.column_stack([period * random.random(count), angle, sign * speed]),
        np.zeros(count, bool),
    )
    assert misread(np.column_stack([amplitude, period, brace]), starts, told) == 0
    assert told.mean() > 0.8


def test_touch_that_hangs_on_the_last_digits_is_left_to_the_search():
    """Flights between braces that stand where the flight turns, to some parts in 10^16 to 10^12."""
    random = np.random.default_rng(29)
    touched = 0
    for _ in range(8_000):
        amplitude, period = 1.0 + 10.0 ** random.uniform(-2, 1.3), 10.0 ** random.uniform(-0.5, 1)
        frequency, start = math.tau / period, period * random.random()
        motion = (amplitude, frequency, frequency * start, random.random(), 10.0 ** random.uniform(-2, 0.5))
        times = 0.9 * period * SAMPLES
        heights = angles(*motion, times)
        turns = np.flatnonzero((heights[1:-1] > heights[:-2]) & (heights[1:-1] > heights[2:])) + 1
        if turns.size == 0 or (heights[: turns[0]] <= 0.0).any():
            continue
        t = times[turns[0]]
        for _ in range(8):
            pull = angles(*motion, t) - 1.0 - amplitude * math.cos(motion[2] + frequency * t)
            t -= velocities(*motion, t) / pull
        brace = angles(*motion, t) * (1.0 + random.choice([-1, 1]) * 10.0 ** random.uniform(-17, -12))
        if not brace > motion[3]:
            continue
        p = harmonic_parameters(amplitude, frequency, period, 0.0, 0.9, brace, 1.0)
        likely, sure = first_events(p, start, *motion[3:])
        assert likely[0] == sure[0], (amplitude, period, start, motion[3:], brace)
        assert likely[1] == pytest.approx(sure[1], rel=1e-6)
        touched += sure[0] == event_kinds.BRACE
    assert 800 < touched < 3_600
