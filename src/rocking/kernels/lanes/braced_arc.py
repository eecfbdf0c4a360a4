"""Flights between braces, for many blocks at once: where each ends, that nothing is met before, and what the event does.

As ``fast_path.likely_event`` does for one block: the series about the start, or about an instant further on, guesses the
event; the cubic between two instants proves that nothing is met between them. What that does not settle is left to the
functions for one block.
"""

import math

from numba import njit

from rocking.kernels.arc.bracket import MARGIN
from rocking.kernels.arc.enclosure import stays_between
from rocking.kernels.arc.fast_path import I2, I3, I4, I5, I6, I7, I8, REACH
from rocking.kernels.compile_options import SIMD_INLINE
from rocking.kernels.lanes.evaluate import correction, derivatives, elements, halved, instant_of, onward
from rocking.kernels.lanes.rows import (  # fmt: skip
    ABOUT,
    AMPLITUDE,
    AMPLITUDE_RATE,
    ANGLE,
    AT_BRACE,
    AT_EVENT,
    BRACE_ANGLE,
    BRACKET,
    EXTEND,
    FAILED,
    FREQUENCY,
    FREQUENCY_SQUARE,
    KNOT_ANGLE,
    KNOT_COSINE,
    KNOT_RATE,
    KNOT_SINE,
    LANES,
    NEXT_COSINE,
    NEXT_SINE,
    NEXT_SINH,
    NEXT_VERSINH,
    REFINE,
    SINH,
    SPEED,
    STAGE,
    TIME,
    TRIES,
    VELOCITY,
    VERSINH,
    WAIT,
    load,
    store,
)
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import choose

MAX_TRIES, ROUNDS = 8, 2
# As near as this the step of fifth order leaves less than rounding, and so do the series that follow it.
NEAR = 1e-3


@njit(**SIMD_INLINE)
def parabola(u, v, second, brace_angle):
    """(whether at a brace, when) the event is where the parabola comes, or, against the pull, the tangent; ``fast_path.stride``."""
    falls = second < 0.0
    towards, distance = choose(falls, -v, v), choose(falls, u, brace_angle - u)
    size = abs(second)
    root = math.sqrt(fma(towards, towards, 2.0 * size * distance))
    ahead = choose(towards > 0.0, 2.0 * distance, root - towards) / choose(
        towards > 0.0, root + towards, size
    )
    against = choose(towards < 0.0, (distance - brace_angle) / towards, math.inf)
    turns = against < ahead
    return falls == turns, choose(turns, against, ahead)


@njit(**SIMD_INLINE)
def predict_event(s):
    """When each lane looks next: where the series has its event, or, where that tells none, further on."""
    for i in range(LANES):
        stage, time, about = load(s, i, STAGE), load(s, i, TIME), load(s, i, ABOUT)
        at_brace, frequency = load(s, i, AT_BRACE), load(s, i, FREQUENCY)
        brace_angle = load(s, i, BRACE_ANGLE)
        u, v, cosine, sine = (
            load(s, i, KNOT_ANGLE),
            load(s, i, KNOT_RATE),
            load(s, i, KNOT_COSINE),
            load(s, i, KNOT_SINE),
        )
        c = derivatives(s, i, (u, v, cosine, sine))
        square = load(s, i, FREQUENCY_SQUARE)
        c7 = fma(square * square, load(s, i, AMPLITUDE_RATE) * sine, c[5])
        c8 = fma(square * square, square * load(s, i, AMPLITUDE) * cosine, c[6])
        brace_next, rough = parabola(u, v, c[2], brace_angle)
        sign = choose(brace_next, -1.0, 1.0)
        c0, c1, c2, c3 = choose(brace_next, brace_angle - u, u), sign * v, sign * c[2], sign * c[3]
        c4, c5, c6, c7, c8 = sign * c[4], sign * c[5], sign * c[6], sign * c7, sign * c8
        farthest = REACH / max(1.0, frequency)
        x = choose(rough <= farthest, rough, farthest)
        told = x > 0.0
        # as ``fast_path.polished``
        for _ in range(ROUNDS):
            q = x * x
            h = q * q
            w4 = fma(q, I2 * c6, fma(x, c5, c4))
            w3 = fma(q, fma(x, I3 * c6, I2 * c5), fma(x, c4, c3))
            w2 = fma(h, fma(x, I5 * c7, I4 * c6), fma(q, fma(x, I3 * c5, I2 * c4), fma(x, c3, c2)))
            w1 = fma(q, I6 * c7, fma(x, I5 * c6, I4 * c5))
            w1 = fma(h, w1, fma(q, fma(x, I3 * c4, I2 * c3), fma(x, c2, c1)))
            w0 = fma(h, I8 * c8, fma(q, fma(x, I7 * c7, I6 * c6), fma(x, I5 * c5, I4 * c4)))
            w0 = fma(h, w0, fma(q, fma(x, I3 * c3, I2 * c2), fma(x, c1, c0)))
            per = 1.0 / w1
            y = -w0 * per
            told = told & (w1 < 0.0)
            x += y * halved(correction(y, w2, w3, w4, per))
        told = told & (x > 0.0) & (x <= farthest)
        aims = stage == BRACKET
        store(
            s,
            i,
            TIME,
            choose(aims, about + choose(told, x, choose(rough <= farthest, rough, farthest)), time),
        )
        store(s, i, AT_BRACE, choose(aims, choose(brace_next, 1.0, 0.0), at_brace))
        store(s, i, STAGE, choose(aims, choose(told, REFINE, EXTEND), stage))


@njit(**SIMD_INLINE)
def correct_event(s):
    """From the time looked at to the event, or nearer to it; or on from there, where that is too far."""
    elements(s)
    for i in range(LANES):
        stage, t, about, tries = load(s, i, STAGE), load(s, i, TIME), load(s, i, ABOUT), load(s, i, TRIES)
        wait, at_brace = load(s, i, WAIT), load(s, i, AT_BRACE) > 0.0
        angle, velocity, brace_angle = load(s, i, ANGLE), load(s, i, VELOCITY), load(s, i, BRACE_ANGLE)
        sinh, versinh = load(s, i, SINH), load(s, i, VERSINH)
        amplitude, frequency = load(s, i, AMPLITUDE), load(s, i, FREQUENCY)
        knot_angle, knot_rate = load(s, i, KNOT_ANGLE), load(s, i, KNOT_RATE)
        knot_cosine, knot_sine = load(s, i, KNOT_COSINE), load(s, i, KNOT_SINE)
        risen, v, cosine, sine = instant_of(s, i, angle - 1.0)
        u = angle + risen
        _, _, second, third, fourth, fifth, _ = derivatives(s, i, (u, v, cosine, sine))
        # towards a brace u falls short of it
        left = choose(at_brace, risen - (brace_angle - angle), u)
        per = 1.0 / v
        y = -left * per
        factor = correction(y, second, third, fourth, per)
        x = y * factor
        slope = fma(x, fma(x, fma(x, fma(x, I4 * fifth, I3 * fourth), I2 * third), second), v)
        towards = choose(at_brace, v, -v)
        close = (abs(left) * max(1.0, frequency) < NEAR * towards) & (abs(left * second) < NEAR * v * v)
        close = close & (left * left * abs(third) < NEAR * NEAR * towards * v * v)

        heads, goes_on = stage == REFINE, stage == EXTEND
        place = choose(at_brace, brace_angle, 0.0)
        span, end, arrival = (
            choose(heads, t + x, t) - about,
            choose(heads, place, u),
            choose(heads, slope, v),
        )
        system = amplitude, frequency, brace_angle
        free = stays_between(system, span, (knot_angle, knot_rate), (end, arrival))
        # ``next_event.grazes``
        acceleration, later = amplitude + 1.0, t + x
        touches = slope * slope <= MARGIN * acceleration * (
            angle + later * (abs(velocity) + later * acceleration)
        )
        arrived, further = heads & close & free & (touches == False), goes_on & free  # noqa: E712
        ahead = t + y * halved(factor)
        nears = heads & (close == False) & (towards > 0.0) & (ahead > about)  # noqa: E712
        # too far: what was met lies before
        above, beneath = goes_on & (u > brace_angle), goes_on & (u < 0.0)

        next_cosine, next_sine, next_sinh, next_versinh = onward(x, frequency, cosine, sine, sinh, versinh)
        store(s, i, WAIT, choose(arrived, later, wait))
        # of a lane that has not arrived nobody asks for these
        store(s, i, SPEED, abs(slope))
        store(s, i, NEXT_COSINE, next_cosine)
        store(s, i, NEXT_SINE, next_sine)
        store(s, i, NEXT_SINH, next_sinh)
        store(s, i, NEXT_VERSINH, next_versinh)
        store(s, i, KNOT_ANGLE, choose(further, u, knot_angle))
        store(s, i, KNOT_RATE, choose(further, v, knot_rate))
        store(s, i, KNOT_COSINE, choose(further, cosine, knot_cosine))
        store(s, i, KNOT_SINE, choose(further, sine, knot_sine))
        store(s, i, ABOUT, choose(further, t, about))
        moves, beyond = heads | goes_on, above | beneath
        back = moves & ((arrived | nears | further | beyond) == False)  # noqa: E712
        store(s, i, AT_BRACE, choose(above, 1.0, choose(beneath, 0.0, choose(at_brace, 1.0, 0.0))))
        store(s, i, TIME, choose(nears, ahead, choose(back, fma(0.5, t - about, about), t)))
        store(s, i, TRIES, choose(moves, tries + 1.0, tries))
        on = choose(arrived, AT_EVENT, choose(nears | beyond, REFINE, choose(further, BRACKET, EXTEND)))
        on = choose(arrived | (tries < MAX_TRIES), on, FAILED)
        store(s, i, STAGE, choose(heads | goes_on, on, stage))
