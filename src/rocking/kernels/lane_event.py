"""What each lane wants before an event between braces, and what the event does: eq. (2), or what a brace gives back."""

import math

from numba import njit

from .branchless import EXACT_INNER, choose
from .elementary import fma
from .impact import SLOW
from .lanes import (
    ABOUT,
    ACROSS,
    ALONE,
    ALONG,
    AMPLITUDE,
    ANGLE,
    ARRIVED,
    AT_BRACE,
    BEGUN,
    BRACE_ANGLE,
    BRACE_HITS,
    BRACE_RESTITUTION,
    CERTAINTY,
    CONTENT,
    COSINE,
    COUNTED,
    CYCLE,
    DOUBLINGS,
    EVENTS,
    EXCEEDS,
    KNOT_ANGLE,
    KNOT_COSINE,
    KNOT_RATE,
    KNOT_SINE,
    LANES,
    LARGE,
    LEG_END,
    NEXT_COSINE,
    NEXT_SINE,
    NEXT_SINH,
    NEXT_VERSINH,
    PEAK,
    PEAK_SEEN,
    PER_PERIOD,
    PERIOD,
    READING,
    RESTITUTION,
    SIDE,
    SINE,
    SLOW_SEEN,
    SLOWEST,
    SPEED,
    STAGE,
    START,
    TARGET,
    TRAILS,
    TRIES,
    UNSURE,
    VELOCITY,
    WAIT,
    WALK,
    WANTS,
    of,
    put,
    trail_is_full,
)  # fmt: skip


@njit(**EXACT_INNER)
def attend(s):
    """What each lane wants before its event; whether any wants anything."""
    any_wants = False
    for i in range(LANES):
        stage, start, wait, cycle = of(s, i, STAGE), of(s, i, START), of(s, i, WAIT), of(s, i, CYCLE)
        target, period, at_brace = of(s, i, TARGET), of(s, i, PERIOD), of(s, i, AT_BRACE) > 0.0
        speed, exceeds = of(s, i, SPEED), of(s, i, EXCEEDS) > 0.0
        returned = choose(at_brace, of(s, i, BRACE_RESTITUTION), of(s, i, RESTITUTION))
        full = trail_is_full(of(s, i, TRAILS), of(s, i, EVENTS), of(s, i, COUNTED))
        wants = choose(exceeds & (at_brace == False), PEAK_SEEN, CONTENT)  # noqa: E712
        wants = choose((returned < 1.0) & (returned * speed < SLOW), SLOW_SEEN, wants)
        wants = choose(full, READING, wants)
        wants = choose(returned * speed < SLOWEST, ALONE, wants)
        wants = choose(start + wait > (target - cycle) * period, LEG_END, wants)
        wants = choose(stage == ARRIVED, wants, choose(stage == UNSURE, CERTAINTY, CONTENT))
        put(s, i, WANTS, wants)
        any_wants |= wants != CONTENT
    return any_wants


@njit(**EXACT_INNER)
def carry(s):
    """What an event makes of the differences, where a lane has arrived."""
    for i in range(LANES):
        stage, across, along, doublings = (
            of(s, i, STAGE),
            of(s, i, ACROSS),
            of(s, i, ALONG),
            of(s, i, DOUBLINGS),
        )
        sinh, cosh, speed = of(s, i, NEXT_SINH), 1.0 + of(s, i, NEXT_VERSINH), of(s, i, SPEED)
        amplitude, next_cosine, brace_angle = (
            of(s, i, AMPLITUDE),
            of(s, i, NEXT_COSINE),
            of(s, i, BRACE_ANGLE),
        )
        restitution, brace_restitution = of(s, i, RESTITUTION), of(s, i, BRACE_RESTITUTION)
        at_brace = of(s, i, AT_BRACE) > 0.0
        # as ``tangent.event_map``
        pressed = (1.0 + brace_restitution) * fma(-amplitude, next_cosine, brace_angle - 1.0)
        pulled = fma((1.0 - restitution) * amplitude, next_cosine, -(1.0 + restitution))
        shear, factor = (
            choose(at_brace, pressed, pulled) / speed,
            choose(at_brace, -brace_restitution, restitution),
        )
        a, b = fma(cosh, across, sinh * along), fma(sinh, across, cosh * along)
        a, b = factor * a, fma(shear, a, factor * b)
        size = abs(a) + abs(b)
        large, little = size > LARGE, size < 1.0 / LARGE
        scale = choose(large, 1.0 / LARGE, choose(little, LARGE, 1.0))
        times = choose(large, 64.0, choose(little, -64.0, 0.0))
        arrived = stage == ARRIVED
        put(s, i, ACROSS, choose(arrived, a * scale, across))
        put(s, i, ALONG, choose(arrived, b * scale, along))
        put(s, i, DOUBLINGS, choose(arrived, doublings + times, doublings))


@njit(**EXACT_INNER)
def strike(s):
    """Events: where a lane has arrived, eq. (2) or what a brace does, and the next arc."""
    carry(s)
    for i in range(LANES):
        stage, start, cycle, side = of(s, i, STAGE), of(s, i, START), of(s, i, CYCLE), of(s, i, SIDE)
        velocity, cosine, sine, wait = of(s, i, VELOCITY), of(s, i, COSINE), of(s, i, SINE), of(s, i, WAIT)
        angle, peak, events, hits = of(s, i, ANGLE), of(s, i, PEAK), of(s, i, EVENTS), of(s, i, BRACE_HITS)
        speed, next_cosine, next_sine = of(s, i, SPEED), of(s, i, NEXT_COSINE), of(s, i, NEXT_SINE)
        period, per_period, brace_angle = of(s, i, PERIOD), of(s, i, PER_PERIOD), of(s, i, BRACE_ANGLE)
        restitution, brace_restitution = of(s, i, RESTITUTION), of(s, i, BRACE_RESTITUTION)
        tries, about = of(s, i, TRIES), of(s, i, ABOUT)
        knot_angle, knot_rate = of(s, i, KNOT_ANGLE), of(s, i, KNOT_RATE)
        knot_cosine, knot_sine = of(s, i, KNOT_COSINE), of(s, i, KNOT_SINE)
        hit, arrived = of(s, i, AT_BRACE) > 0.0, stage == ARRIVED
        begins = arrived | (stage == BEGUN)
        turns, turned = math.floor((start + wait) * per_period), choose(hit, 1.0, -1.0)
        angle = choose(arrived, choose(hit, brace_angle, 0.0), angle)
        velocity = choose(arrived, choose(hit, -brace_restitution, restitution) * speed, velocity)
        cosine, sine = (
            choose(arrived, turned * next_cosine, cosine),
            choose(arrived, turned * next_sine, sine),
        )
        put(s, i, START, choose(arrived, fma(-turns, period, start) + wait, start))
        put(s, i, CYCLE, choose(arrived, cycle + turns, cycle))
        put(s, i, SIDE, choose(arrived, turned * side, side))
        put(s, i, ANGLE, angle)
        put(s, i, VELOCITY, velocity)
        put(s, i, COSINE, cosine)
        put(s, i, SINE, sine)
        peak = choose(arrived, max(peak, angle), peak)
        put(s, i, PEAK, peak)
        put(s, i, EXCEEDS, choose(peak < brace_angle, 1.0, 0.0))
        put(s, i, EVENTS, choose(arrived, events + 1.0, events))
        put(s, i, BRACE_HITS, choose(arrived & hit, hits + 1.0, hits))
        put(s, i, KNOT_ANGLE, choose(begins, angle, knot_angle))
        put(s, i, KNOT_RATE, choose(begins, velocity, knot_rate))
        put(s, i, KNOT_COSINE, choose(begins, cosine, knot_cosine))
        put(s, i, KNOT_SINE, choose(begins, sine, knot_sine))
        put(s, i, ABOUT, choose(begins, 0.0, about))
        put(s, i, TRIES, choose(begins, 0.0, tries))
        put(s, i, STAGE, choose(begins, WALK, stage))
