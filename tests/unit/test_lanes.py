"""Lanes: many blocks in lockstep behave as each does alone."""

import math

import mpmath as mp
import numpy as np
import pytest

from oracles import lanes as oracle
from rocking.kernels import event_kinds
from rocking.kernels.arc import first_zero_cosine
from rocking.kernels.arc.slender_cosine import arc_from
from rocking.kernels.lanes import state
from rocking.kernels.library.kernel import kernel
from rocking.kernels.numerics import elementary as standard
from rocking.kernels.numerics import simd
from rocking.kernels.system import harmonic_parameters

pytestmark = pytest.mark.xdist_group("lanes")  # the kernels of the oracle are compiled once

ULP = 2.0**-52


@kernel
def elementary(rate, t):
    return standard.both_exponentials(t), simd.hyperbolic(t), simd.circular(rate, t)


@kernel
def logarithms_of_ratios(a, b, c, d):
    return simd.logarithms_of_ratios(a, b, c, d)


@kernel
def alone(p, side, start, velocity, angle=0.0):
    """The first event of an arc, as the functions for one block find it."""
    return first_zero_cosine.any_event(p, event_kinds.FLIGHT, arc_from(p, side, start, angle, velocity))


def test_elementary_functions_have_full_relative_accuracy_however_short_the_arc():
    random = np.random.default_rng(1)
    for _ in range(4000):
        t, rate = 10.0 ** random.uniform(-7, 1.5), 10.0 ** random.uniform(-1, 1.5)
        (grown, shrunk), (sinh, versinh, excess, higher), (sin, versine, lag, deficit) = elementary(rate, t)
        with mp.workdps(60):
            T, x = mp.mpf(t), mp.mpf(rate) * mp.mpf(t)
            whole = [(grown, mp.exp(T)), (shrunk, mp.exp(-T)), (sinh, mp.sinh(T))]
            hyperbolics = [(versinh, mp.cosh(T) - 1), (excess, mp.sinh(T) - T)]
            circulars = [(sin, mp.sin(x)), (versine, 1 - mp.cos(x)), (lag, x - mp.sin(x))]
            if t < simd.SHORT_TIME:
                whole += [*hyperbolics, (higher, mp.cosh(T) - 1 - T * T / 2)]
            if x < simd.SHORT_ANGLE:
                whole += [*circulars, (deficit, x * x / 2 - 1 + mp.cos(x))]
            for ours, exact in whole:
                assert abs(ours - exact) <= 4 * ULP * abs(exact), (rate, t)
            for ours, exact in (*hyperbolics, *circulars):
                assert abs(ours - exact) <= 4 * ULP * max(1, abs(exact)), (rate, t)


@pytest.mark.parametrize("other", [(2.0, 3.0), (math.nan, 1.0), (-1.0, 0.0), (math.inf, -math.inf)])
def test_logarithms_of_ratios_are_as_good_as_they_are_said_to_be(other):
    first, second = 0.0, 0.0
    # either is worst where the one number is nearly twice the other, but for powers of two
    low, high = np.nextafter(0.5**0.5, 1.0), np.nextafter(2.0**0.5, 0.0)
    worst = [
        (high, low),
        (low, high),
        (high * 2.0**1000, low / 2.0**1000),
        (low / 2.0**1000, high * 2.0**1000),
    ]
    for a, b in [*np.exp(np.random.default_rng(2).uniform(-60, 60, (20_000, 2))), *worst]:
        exact = math.log(a) - math.log(b)
        first = max(first, abs(logarithms_of_ratios(a, b, *other)[0] - exact))
        second = max(second, abs(logarithms_of_ratios(*other, a, b)[1] - exact))
    assert 5e-6 < first < simd.ROUGHLY
    assert 5e-6 < second < simd.ROUGHLY


def drawn(count, seed):
    """Systems and starts from the base, slow ones among them."""
    random = np.random.default_rng(seed)
    systems, starts = [], []
    for _ in range(count):
        period, amplitude = random.uniform(0.15, 3.0), 1.0 + 10.0 ** random.uniform(-2, 1.2)
        restitution, phase = random.uniform(0.1, 1.0), random.uniform(-3.0, 3.0)
        systems.append(harmonic_parameters(amplitude, math.tau / period, period, phase, restitution))
        slow = 10.0 ** random.uniform(-5, 0.5)
        starts.append((int(random.choice([-1, 1])), random.uniform(0, period), slow))
    return systems, starts


def test_first_impacts_are_those_of_one_block():
    """Random arcs, also those that approach the base without reaching it: never a later zero, never another.

    Time and speed agree to rounding, 16 ulp of what they are made of; a rounding of u moves them by its ratio to the speed.
    """
    systems, starts = drawn(4096, 3)
    found, certain = oracle.first_events(systems, starts)
    compared = 0
    for p, start, ours, sure in zip(systems, starts, found, certain, strict=True):
        if not sure:
            continue
        one = alone(p, *start)
        assert one.event == event_kinds.IMPACT, (p, start)
        compared += 1
        grown = math.cosh(one.wait)
        scale = (
            16
            * ULP
            * grown
            * (start[2] + (1.0 + p.forcing.amplitude) * min(one.wait, 1.0) + p.forcing.response)
        )
        bend = abs(1.0 + p.forcing.amplitude) / -one.velocity
        assert abs(ours[0] - one.wait) <= 16 * ULP * one.wait + scale / -one.velocity, (p, start)
        assert abs(ours[1] + one.velocity) <= scale * (1.0 + bend), (p, start)
        there = one.drive.cosine, one.drive.sine, one.sinh, one.versinh, 0.0
        assert ours[2:] == pytest.approx(there, rel=1e-8, abs=1e-8), (p, start)
    assert compared >= 0.4 * len(systems)


def test_no_step_reaches_a_zero_that_it_only_comes_near():
    """From instants at which u, u' and u'' are small, either side of the base, against the closed form in 40 digits."""
    random = np.random.default_rng(12)
    amplitude, frequency, count = 10.0, 5.0, 2000
    p = harmonic_parameters(amplitude, frequency, math.tau / frequency, 0.0, 0.9)
    speed = 10.0 ** random.uniform(-6, -1, count)
    u = speed * 10.0 ** random.uniform(-7, -3, count) * random.choice([-1, 1], count)
    second = 10.0 ** random.uniform(-7, 0, count) * random.choice([-1, 1], count)
    cosine = (u - 1.0 - second) / amplitude
    sine = np.sqrt(1.0 - cosine**2) * random.choice([-1, 1], count)
    instants = np.column_stack([u, -speed, cosine, sine])
    found, arrived = oracle.steps_to_zero(p, instants)
    assert 0.2 < arrived.mean() < 0.8
    with mp.workdps(40):
        for (wait, falls), instant in zip(found[arrived], instants[arrived], strict=True):
            u0, v0, cos0, sin0 = map(mp.mpf, instant)
            eta, beta = mp.atan2(sin0, cos0), mp.mpf(amplitude) / (1 + frequency**2)
            mean, half = u0 - 1 - beta * mp.cos(eta), v0 + beta * frequency * mp.sin(eta)

            def angle(t, mean=mean, half=half, eta=eta, beta=beta):
                return mean * mp.cosh(t) + half * mp.sinh(t) + 1 + beta * mp.cos(frequency * t + eta)

            zero = mp.findroot(angle, (0, -u0 / v0))
            assert abs(wait - zero) <= 1e-11 * abs(zero), instant
            assert abs(falls + mp.diff(angle, zero)) <= 1e-11 * abs(v0), instant


def test_arc_that_rises_above_the_peak_is_always_looked_at_and_few_others():
    """The largest angle is that of u = c+ e^t + c- e^-t + 1 + beta cos eta at a thousand instants up to the impact."""
    systems, starts = drawn(4096, 6)
    largest = np.full(len(systems), np.nan)
    for k, (p, (side, start, velocity)) in enumerate(zip(systems, starts, strict=True)):
        coming = alone(p, side, start, velocity)
        if coming.event != event_kinds.IMPACT:
            continue
        t = np.linspace(0.0, coming.wait, 1000)
        eta = p.forcing.frequency * (start + t) + p.forcing.phase + (0.0 if side > 0 else math.pi)
        beta = p.forcing.amplitude / (1.0 + p.forcing.frequency**2)
        mean, half = -1.0 - beta * math.cos(eta[0]), velocity + beta * p.forcing.frequency * math.sin(eta[0])
        u = 0.5 * ((mean + half) * np.exp(t) + (mean - half) * np.exp(-t)) + 1.0 + beta * np.cos(eta)
        largest[k] = u.max()
    falls = np.isfinite(largest)
    assert falls.mean() > 0.4
    looked_at = oracle.may_exceed(systems, starts, largest - 1e-9)
    assert looked_at[falls].all()
    above = oracle.may_exceed(systems, starts, largest + 0.03)
    assert above[falls].mean() < 0.4


def test_lanes_leave_little_to_the_functions_for_one_block():
    """All but a few per cent of the arcs that come down do so in their lanes."""
    systems, starts = drawn(2048, 4)
    _, certain = oracle.first_events(systems, starts)
    comes_down = [
        alone(p, *start).event == event_kinds.IMPACT for p, start in zip(systems, starts, strict=True)
    ]
    assert certain[comes_down].mean() > 0.95


def drawn_between(count, seed):
    """Systems with braces, and flights from the base, from a brace and between: (side, start, velocity, angle)."""
    random = np.random.default_rng(seed)
    systems, starts = [], []
    for _ in range(count):
        period, amplitude = 10 ** random.uniform(-0.8, 1), 1.0 + 10 ** random.uniform(-2, 1.2)
        brace, place = 10 ** random.uniform(-1.5, 0.5), random.integers(3)
        p = harmonic_parameters(
            amplitude, math.tau / period, period, random.uniform(0, math.tau), 0.9, brace, random.random()
        )
        side, start, speed = random.choice([-1, 1]), period * random.random(), 10 ** random.uniform(-4, 1)
        angle = (0.0, brace, brace * random.random())[place]
        systems.append(p)
        starts.append((int(side), start, (speed, -speed, speed * random.choice([-1, 1]))[place], angle))
    return systems, starts


def test_first_events_between_braces_are_those_of_one_block():
    """Never a later one, never another, and nearly always one that needs no function for one block."""
    systems, starts = drawn_between(8192, 8)
    found, certain = oracle.first_events(systems, starts)
    at_brace = 0
    for p, start, ours, sure in zip(systems, starts, found, certain, strict=True):
        if not sure:
            continue
        one = alone(p, *start)
        assert ours[6] == (one.event == event_kinds.BRACE), (p, start)
        assert one.event in (event_kinds.BRACE, event_kinds.IMPACT), (p, start)
        at_brace += one.event == event_kinds.BRACE
        grown = math.cosh(one.wait)
        scale = (
            32
            * ULP
            * grown
            * (
                abs(start[2])
                + start[3]
                + (1.0 + p.forcing.amplitude) * min(one.wait, 1.0)
                + p.forcing.response
            )
        )
        bend = (1.0 + p.forcing.amplitude + p.block.brace_angle) / abs(one.velocity)
        assert abs(ours[0] - one.wait) <= 16 * ULP * one.wait + scale / abs(one.velocity), (p, start)
        assert abs(ours[1] - abs(one.velocity)) <= scale * (1.0 + bend), (p, start)
        there = one.drive.cosine, one.drive.sine, one.sinh, one.versinh
        assert ours[2:6] == pytest.approx(there, rel=1e-8, abs=1e-8), (p, start)
    assert 0.2 * len(systems) < at_brace < 0.8 * len(systems)
    assert certain.mean() > 0.9


@pytest.mark.parametrize(
    ("amplitude", "period", "restitution", "brace"),
    [
        (4.0, 0.4, 0.8, math.inf),
        (4.0, 0.4, 0.95, math.inf),
        (4.0, 0.4, 1.0, math.inf),
        (8.0, 1.0, 0.9, 0.3),
        (8.0, 1.0, 0.9, 1.0),
    ],
)
def test_what_a_lane_does_hangs_on_no_other(amplitude, period, restitution, brace):
    """Results are bit-identical in every lane, whatever the other lanes contain."""
    p = harmonic_parameters(amplitude, math.tau / period, period, 0.3, restitution, brace, 0.8)
    random = np.random.default_rng(5)
    blocks = [
        (1, float(random.uniform(0, period)), float(random.uniform(0.2, 0.6))) for _ in range(state.LANES)
    ]

    def marched(order):
        s, noted = oracle.empty(), np.zeros((state.LANES, 2000, 4))
        for i, k in enumerate(order):
            oracle.sit_down(s, i, p, *blocks[k], oracle.EYE, 20)
        oracle.to_the_end(s, p, noted)
        return noted[np.argsort(order)]

    order = random.permutation(state.LANES)
    assert np.array_equal(marched(np.arange(state.LANES)), marched(order))
