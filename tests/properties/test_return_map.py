"""Return map of the search for orbits, against the plain march; its events, against the oracle of first crossings."""

import math
from functools import cache

import numpy as np
import pytest

from oracles.arcs import arcs
from oracles.crossing import first_events
from oracles.distance import Arc
from rocking.kernels import event_kinds
from rocking.kernels.arc import fast_search_cosine, first_zero_cosine
from rocking.kernels.arc.slender_cosine import arc_from, propagator_or_none
from rocking.kernels.classify import cascade
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.march import DONE, UNKNOWN, Recording, begin_march, march
from rocking.kernels.motion.tangent import TangentState
from rocking.kernels.orbits import return_map
from rocking.kernels.system import harmonic_parameters, slender_of_row

# Its kernels are compiled once, for half a minute.
pytestmark = pytest.mark.long

STATES = 10_000
# Of the start, the phase and the amplitude; a march rounds each of its events by some 10^-15.
MOVED = 1e-12
ROUNDING = 1e-13
# Arcs that last longer are ill-conditioned: rounding grows by e^t.
LONG = 16.0


@kernel
def images(systems, starts, periods, mirrored, nothing, columns, out):
    """Map each state by ``return_map``, with the waits of a state nearby, as Newton's method does: (certain, Θ, Θ')."""
    for k in range(len(systems)):
        mapping = return_map.return_map(slender_of_row(systems[k]), periods[k], mirrored)
        recording = Recording(0.0, nothing.section, nothing.events, False, False)
        waits = UNKNOWN
        for beside in (0.5, 0.8, 1.0):
            guess = return_map.Guess(beside * starts[k, 0], beside * starts[k, 1], waits)
            state = TangentState(columns, nothing.tangent.growth)
            image = return_map.image_after(mapping, guess, recording, state)
            waits = image.waits
        out[k, 0], out[k, 1], out[k, 2] = (
            image.certain,
            mapping.sign * image.angle,
            mapping.sign * image.velocity,
        )


def plain_image(system, angle, velocity, period, mirrored):
    """Return (Θ, Θ') of the plain march after ``period`` cycles, or after half of them and mirrored; NaN if it overturns."""
    p = harmonic_parameters(*system)
    progress, _ = begin_march(p, angle, velocity)
    if not mirrored:
        status, progress, _, _ = march(p, progress, period, Recording())
        arc = progress.arc
        return np.array([arc.side * arc.angle, arc.side * arc.velocity] if status == DONE else [math.nan] * 2)
    section = np.full(((period + 1) // 2, 2), math.nan)
    march(p, progress, len(section), Recording(0.5 * p.forcing.period, section))
    return -section[-1]


def random_systems(count, braced, seed):
    """Draw systems and initial states: amplitudes, periods, restitutions, braces and states over a decade or more."""
    random = np.random.default_rng(seed)
    period = 10.0 ** random.uniform(-1.0, 0.5, count)
    brace = 10.0 ** random.uniform(-1, 0.3, count) if braced else np.full(count, math.inf)
    systems = np.column_stack(
        [
            10.0 ** random.uniform(0.05, 2.0, count), 2.0 * math.pi / period, period, random.uniform(-math.pi, math.pi, count),
            random.uniform(0.3, 1.0, count), brace, random.uniform(0.3, 1.0, count),
        ]
    )  # fmt: skip
    reach = np.minimum(brace, 0.9)
    return systems, np.column_stack([reach * random.uniform(-1, 1, count), random.uniform(-1, 1, count)])


@pytest.mark.parametrize("braced", [False, True], ids=["without braces", "with braces"])
@pytest.mark.parametrize("mirrored", [False, True], ids=["whole cycles", "half cycles"])
def test_map_of_the_search_is_that_of_the_plain_march(mirrored, braced):
    """To what a change of the start, the phase and the amplitude by 10^-12 moves the plain march: rounding grows alike."""
    systems, starts = random_systems(STATES, braced, 33)
    random = np.random.default_rng(5)
    periods = random.choice([1, 3, 5, 7] if mirrored else [1, 2, 3, 4, 5, 6, 7], STATES)
    memory, found = cascade.make_workspace(1, 1), np.empty((STATES, 3))
    images(systems, starts, periods, mirrored, memory.nothing, memory.trial, found)
    wrong, tight, stayed = [], 0, 0
    for k, (system, start, period) in enumerate(zip(systems, starts, periods.tolist(), strict=True)):
        expected = plain_image(system, *start, period, mirrored)
        if np.isnan(expected[0]) and found[k, 0] == 0.0:
            continue
        allowed = ROUNDING * (1.0 + np.abs(expected).max())
        for place in range(4):
            moved, off = system.copy(), start.copy()
            if place < 2:
                off[place] *= 1.0 - MOVED
            else:
                moved[(0, 3)[place - 2]] *= 1.0 + MOVED
            allowed += np.abs(plain_image(moved, *off, period, mirrored) - expected).max()
        stayed += 1
        tight += allowed <= 1e-8
        if not np.abs(found[k, 1:] - expected).max() <= allowed:
            wrong.append(
                (system.tolist(), start.tolist(), period, found[k].tolist(), expected.tolist(), allowed)
            )
    assert stayed > 0.1 * STATES
    assert tight > 0.9 * stayed
    assert not wrong, f"{len(wrong)} of {stayed}; the first: {wrong[:2]}"


@kernel
def first_event(p, period, mirrored, side, angle, velocity, guess):
    """Return (ψ at the start, event, time) of the first event of an arc as the search finds it from a guess of the time."""
    q, _, start, _ = return_map.return_map(p, period, mirrored)
    arc = arc_from(q, side, start, angle, velocity)
    coming, _ = first_zero_cosine.next_event(q, event_kinds.FLIGHT, arc, propagator_or_none(q, guess))
    return arc.constants.psi, coming.event, coming.wait


@kernel
def is_certified(p, period, mirrored, arc, time, rate):
    """Return whether the search would accept a zero of u as the first."""
    q, _, start, _ = return_map.return_map(p, period, mirrored)
    side, angle, velocity = arc
    flight = arc_from(q, side, start, angle, velocity)
    return fast_search_cosine.stays_clear(q, flight, fast_search_cosine.Jet(time, 0.0, rate, 0.0, 0.0))


MAPS = [(1, False), (2, False), (3, False), (5, False), (1, True), (3, True), (5, True)]


def system_of(arc):
    """The system of an arc of the oracle, its clock at 0 where the arc begins."""
    period = 2.0 * math.pi / arc.frequency
    return harmonic_parameters(arc.amplitude, arc.frequency, period, arc.phase, 0.9, arc.brace, 0.9)


def doubt_of(arc, event):
    """By how much the time of an event may be off: some roundings, grown like the arc, over the speed; a touch tells no time."""
    time, speed = float(event.time), abs(float(event.velocity))
    size = 1.0 + arc.amplitude + abs(arc.velocity)
    return 1e-9 * time + min(1e-14 * size * math.exp(time) / max(speed, 1e-30), 1e-3)


@pytest.mark.parametrize("period, mirrored", MAPS)
def test_first_events_of_the_search_are_those_of_the_oracle(period, mirrored):
    """Proved in ball arithmetic from the very phase with which the search begins; with a good guess of the time, a bad one and none."""
    kinds, wrong, checked = {event_kinds.IMPACT: "base", event_kinds.BRACE: "brace"}, [], 0
    for family in ("generic", "near_saddle", "release"):
        for arc in arcs(family, 250, period):
            psi, *_ = first_event(system_of(arc), period, mirrored, arc.side, arc.angle, arc.velocity, 0.0)
            proved = first_events(arc._replace(phase=psi))
            times = [float(each.time) for each in proved]
            if max(times) > LONG or not {each.kind for each in proved} <= set(kinds.values()):
                continue
            for guess in (0.0, 1.001 * times[0], 2.5 * times[0]):
                _, event, wait = first_event(
                    system_of(arc), period, mirrored, arc.side, arc.angle, arc.velocity, guess
                )
                checked += 1
                if not any(
                    kinds.get(event) == each.kind and abs(wait - time) <= doubt_of(arc, each)
                    for each, time in zip(proved, times, strict=True)
                ):
                    wrong.append((arc, guess, event, wait, times))
    assert checked > 1_000
    assert not wrong, f"{len(wrong)} of {checked}; the first: {wrong[:2]}"


@cache
def later_zeros(count, seed):
    """[(arc, time, u')] where u falls through zero once more than once: samples of eq. (5), bisected; no braces."""
    random, zeros = np.random.default_rng(seed), []
    for _ in range(count):
        amplitude, period = 10.0 ** random.uniform(0.1, 2), 10.0 ** random.uniform(-1, 0.5)
        arc = Arc(
            amplitude, 2.0 * math.pi / period, math.inf, int(random.choice([-1, 1])),
            random.choice([0.0, random.random()]), random.uniform(0.01, 2.0), random.uniform(0, 2.0 * math.pi),
        )  # fmt: skip
        times = np.linspace(0.0, 8.0 * period, 4_000)[1:]
        height = angle_of(arc, times)
        falls = np.flatnonzero((height[:-1] > 0.0) & (height[1:] <= 0.0))
        if len(falls) < 2:
            continue
        low, high = times[falls[1]], times[falls[1] + 1]
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if angle_of(arc, middle) > 0.0 else (low, middle)
        zeros.append((arc, high, (angle_of(arc, high + 1e-6) - angle_of(arc, high - 1e-6)) / 2e-6))
    return zeros


def angle_of(arc, times):
    """u by eq. (5)."""
    beta = arc.side * arc.amplitude / (1.0 + arc.frequency**2)
    mean = arc.angle - 1.0 - beta * math.cos(arc.phase)
    rate = arc.velocity + beta * arc.frequency * math.sin(arc.phase)
    swing = beta * np.cos(arc.phase + arc.frequency * times)
    return mean * np.cosh(times) + rate * np.sinh(times) + 1.0 + swing


@pytest.mark.parametrize("period, mirrored", MAPS)
def test_no_later_zero_is_certified_as_the_first(period, mirrored):
    zeros = later_zeros(10_000, 7)
    wrong = [
        (arc, time)
        for arc, time, rate in zeros
        if is_certified(system_of(arc), period, mirrored, (arc.side, arc.angle, arc.velocity), time, rate)
    ]
    assert len(zeros) > 300
    assert not wrong, f"{len(wrong)} of {len(zeros)}; the first: {wrong[:2]}"
