"""What is proved of a flight without a search: that it turns nowhere, that a dip stays above zero; and what is not."""

import math

import numpy as np
import pytest
from numba import njit

from rocking.kernels import events, shortcut, walk
from rocking.kernels.arc import NONE_YET, arc_from
from rocking.kernels.elementary import COMPILED
from rocking.kernels.parameters import harmonic_parameters

SAMPLES = np.linspace(0.0, 1.0, 300)


@njit(**COMPILED)
def crosses(p, start, angle, velocity, at_brace, t, speed):
    return shortcut.crosses(p, arc_from(p, 1, start, angle, velocity), at_brace, t, speed)


@njit(**COMPILED)
def held_up(p, start, angle, velocity, at_brace):
    """(what is claimed of the convex stretch in which the arc starts, its end); nothing of an arc that starts in another."""
    level = walk.brace_level(p) if at_brace else walk.base_level(p)
    arc = arc_from(p, 1, start, angle, velocity)
    end, convex = walk.first_stretch(p, arc, level)
    return convex and walk.held_up(p, level, walk.start_knot(p, arc, level), end), end


@njit(**COMPILED)
def first_events(p, start, angle, velocity):
    """(event, time) of the first event: without a search where that is certain; by the search."""
    arc = arc_from(p, 1, start, angle, velocity)
    likely, _ = events.next_event(p, events.FLIGHT, arc, NONE_YET)
    sure = events.any_event(p, events.FLIGHT, arc)
    return (likely.event, likely.wait), (sure.event, sure.wait)


def exponentials(amplitude, frequency, psi, angle, velocity):
    """(c+, c-, beta) of the exponential form of eq. (5)."""
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


def flights(at_brace, count):
    """Random flights from the base to what is then the brace, or from a brace to the base: (system, start, u, u', t, all u')."""
    random = np.random.default_rng(17)
    while count > 0:
        amplitude, period = 1.0 + 10.0 ** random.uniform(-3, 1.3), 10.0 ** random.uniform(-1, 1)
        frequency, start = math.tau / period, period * random.random()
        velocity, t = 10.0 ** random.uniform(-3, 0.5), 0.9 * period * random.random()
        angle, times = 0.0, t * SAMPLES
        psi = frequency * start
        if not at_brace:
            # u at t is linear in the angle at the start
            velocity = -velocity
            angle = -angles(amplitude, frequency, psi, 0.0, velocity, t) / math.cosh(t)
        speeds = velocities(amplitude, frequency, psi, angle, velocity, times)
        brace = angles(amplitude, frequency, psi, angle, velocity, t) if at_brace else angle
        if brace > 1e-6 and (speeds[-1] > 0.0) == at_brace:
            count -= 1
            yield (
                harmonic_parameters(amplitude, frequency, period, 0.0, 0.9, brace, 1.0),
                start,
                angle,
                velocity,
                t,
                speeds,
            )


@pytest.mark.parametrize("at_brace", [True, False], ids=["to a brace", "to the base"])
def test_flight_that_is_said_to_cross_never_turns(at_brace):
    turned = claimed = 0
    for p, start, angle, velocity, t, speeds in flights(at_brace, 40_000):
        turns = not ((speeds > 0.0) == at_brace).all()
        claims = crosses(p, start, angle, velocity, at_brace, t, abs(speeds[-1]))
        assert not (claims and turns), (p.amplitude, p.period, start, angle, velocity, t)
        turned += turns
        claimed += claims
    # the question has both answers, and the proof is worth its while
    assert turned > 2_000
    assert claimed > 0.4 * (40_000 - turned)


@pytest.mark.parametrize("at_brace", [True, False], ids=["of the distance to a brace", "of that to the base"])
def test_dip_that_is_said_to_be_held_up_stays_above_zero(at_brace):
    random = np.random.default_rng(23)
    sign, fell, claimed, stayed = (-1.0 if at_brace else 1.0), 0, 0, 0
    for _ in range(40_000):
        amplitude, period = 1.0 + 10.0 ** random.uniform(-2, 1.3), 10.0 ** random.uniform(-1, 1)
        frequency, brace = math.tau / period, 10.0 ** random.uniform(-1.5, 0.3)
        # where w'' - w is positive, and until it is no more
        half = math.acos(max((brace - 1.0) / amplitude, -1.0)) if at_brace else math.acos(1.0 / amplitude)
        phase = half * random.uniform(-1, 1)
        length, psi = (half - phase) / frequency, phase if at_brace else phase + math.pi
        start, distance = psi % math.tau / frequency, brace * random.random()
        rate = -(10.0 ** random.uniform(-2, 1))
        p = harmonic_parameters(amplitude, frequency, period, 0.0, 0.9, brace, 1.0)
        angle = brace - distance if at_brace else distance
        claims, end = held_up(p, start, angle, sign * rate, at_brace)
        assert end == pytest.approx(length, rel=1e-9, abs=1e-12)
        times = length * SAMPLES
        heights = angles(amplitude, frequency, psi, angle, sign * rate, times)
        least = (brace - heights if at_brace else heights).min()
        assert not (claims and least <= 0.0), (amplitude, period, start, angle, rate)
        fell += least <= 0.0
        stayed += least > 0.0
        claimed += claims
    assert fell > 2_000
    assert claimed > 0.2 * stayed


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
        touched += sure[0] == events.BRACE
    assert 800 < touched < 3_600
