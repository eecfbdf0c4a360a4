"""To the first zero of each lane's arc, once the stretch that holds it is known: a guess, and steps of fifth order."""

import math

from numba import njit

from rocking.kernels.arc.bracket import MARGIN
from rocking.kernels.arc.fast_path import I2, I3, I4, I5, I6
from rocking.kernels.compile_options import SIMD_INLINE
from rocking.kernels.lanes.evaluate import correction, derivatives, elements, halved, instant_of, onward
from rocking.kernels.lanes.rows import (  # fmt: skip
    ABOUT,
    AMPLITUDE,
    ANGLE_THERE,
    AT_EVENT,
    BRACKET,
    CLEARED,
    CONCAVE,
    COSINE,
    COSINE_IN,
    COSINE_OUT,
    COSINE_THERE,
    DECAY_IN,
    DECAY_OUT,
    END,
    FAILED,
    FREQUENCY,
    GROW_IN,
    GROW_OUT,
    GROWING,
    GUESS,
    GUESS_OFFSET,
    HIGH,
    INSIDE,
    LANES,
    LOW,
    MINIMUM,
    NEXT_COSINE,
    NEXT_SINE,
    NEXT_SINH,
    NEXT_VERSINH,
    OUTSIDE,
    PER_Z,
    RATE_THERE,
    REFINE,
    RESPONSE,
    RESPONSE_RATE,
    SHRINKING,
    SINE,
    SINE_IN,
    SINE_OUT,
    SINE_THERE,
    SINH,
    SPEED,
    STAGE,
    TIME,
    TRIES,
    VELOCITY,
    VERSINH,
    WAIT,
    Z,
    load,
    store,
)
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import choose

MAX_TRIES = 12
# As near as this the step of fifth order leaves of u less than rounding does, and so do the series that follow it.
NEAR = 1e-3


@njit(**SIMD_INLINE)
def taylor(c, x):
    """(w, w', w''/2) a time x later by their Taylor series, of which c are the coefficients: by Horner's rule, thrice."""
    c0, c1, c2, c3, c4, c5, c6 = c
    w = fma(x, c6, c5)
    dw = fma(x, c6, w)
    bend = fma(x, c6, dw)
    w = fma(x, w, c4)
    dw = fma(x, dw, w)
    bend = fma(x, bend, dw)
    w = fma(x, w, c3)
    dw = fma(x, dw, w)
    bend = fma(x, bend, dw)
    w = fma(x, w, c2)
    dw = fma(x, dw, w)
    bend = fma(x, bend, dw)
    w = fma(x, w, c1)
    dw = fma(x, dw, w)
    return fma(x, w, c0), dw, bend


@njit(**SIMD_INLINE)
def initial_guess(s):
    """The middle of the half of its stretch that holds the zero, u and its derivatives there, and where a parabola comes down."""
    for i in range(LANES):
        concave, end, low, high = load(s, i, CONCAVE), load(s, i, END), load(s, i, LOW), load(s, i, HIGH)
        z, per_z, grow, shrink = (
            load(s, i, Z),
            load(s, i, PER_Z),
            load(s, i, GROWING),
            load(s, i, SHRINKING),
        )
        amplitude, frequency, response = load(s, i, AMPLITUDE), load(s, i, FREQUENCY), load(s, i, RESPONSE)
        inside, cosine_in, sine_in = load(s, i, INSIDE), load(s, i, COSINE_IN), load(s, i, SINE_IN)
        outside, cosine_out, sine_out = load(s, i, OUTSIDE), load(s, i, COSINE_OUT), load(s, i, SINE_OUT)
        grow_in, decay_in = load(s, i, GROW_IN), load(s, i, DECAY_IN)
        grow_out, decay_out = load(s, i, GROW_OUT), load(s, i, DECAY_OUT)
        velocity, cosine_0, sine_0 = load(s, i, VELOCITY), load(s, i, COSINE), load(s, i, SINE)
        within = concave > 0.0
        # of the concave stretch, which ends at ``end``, or of the convex one, which begins there
        more, less = choose(within, grow_in, grow_out), choose(within, decay_in, decay_out)
        # from ``end`` to the middle twice a quarter on, or back
        on, back = choose(within, less, more), choose(within, more, less)
        growing, shrinking = grow * (z * (on * on)), shrink * (per_z * (back * back))
        quarter = 0.25 * choose(within, inside, outside)
        middle = end + choose(within, -(quarter + quarter), quarter + quarter)
        late = (fma(concave, response, growing + shrinking) > -1.0) | (middle <= low)
        growing, shrinking = growing * choose(late, more, less), shrinking * choose(late, less, more)
        cosine, sine = choose(within, cosine_in, cosine_out), choose(within, sine_in, sine_out)
        sine = choose(late, sine, -sine)
        u = growing + shrinking + fma(response, cosine, 1.0)
        v = fma(-load(s, i, RESPONSE_RATE), sine, growing - shrinking)
        about = middle + choose(late, quarter, -quarter)
        # A short hop comes down about where the parabola from its start does.
        fall = fma(amplitude, cosine_0, 1.0)
        hops = (low == 0.0) & (2.0 * velocity * frequency < fall) & (4.0 * velocity < fall * high)
        u, v = choose(hops, 0.0, u), choose(hops, velocity, v)
        cosine, sine = choose(hops, cosine_0, cosine), choose(hops, sine_0, sine)
        second = u + fma(-amplitude, cosine, -1.0)
        # else half of a quarter further, on the zero's side
        under = fma(v, v, -2.0 * u * second)
        root = math.sqrt(max(under, 0.0))
        x = choose(v > 0.0, v + root, 2.0 * u) / choose(v > 0.0, -second, root - v)
        near = hops | ((under > 0.0) & (abs(x) < quarter))
        store(s, i, ANGLE_THERE, u)
        store(s, i, RATE_THERE, v)
        store(s, i, COSINE_THERE, cosine)
        store(s, i, SINE_THERE, sine)
        store(s, i, ABOUT, choose(hops, 0.0, about))
        store(s, i, GUESS_OFFSET, choose(near, x, choose(u > 0.0, 0.5, -0.5) * quarter))


@njit(**SIMD_INLINE)
def guess(s):
    """Where the zero lies, to some six digits: two steps on the Taylor series about where ``initial_guess`` has it."""
    for i in range(LANES):
        stage, time, low, high = load(s, i, STAGE), load(s, i, TIME), load(s, i, LOW), load(s, i, HIGH)
        about, x = load(s, i, ABOUT), load(s, i, GUESS_OFFSET)
        there = (
            load(s, i, ANGLE_THERE),
            load(s, i, RATE_THERE),
            load(s, i, COSINE_THERE),
            load(s, i, SINE_THERE),
        )
        c0, c1, c2, c3, c4, c5, c6 = derivatives(s, i, there)
        c = c0, c1, I2 * c2, I3 * c3, I4 * c4, I5 * c5, I6 * c6
        w, dw, half_ddw = taylor(c, x)
        per = 1.0 / dw
        y = -w * per
        bend = y * half_ddw * per
        x += y * halved(fma(bend, fma(2.0, bend, -1.0), 1.0))
        w, dw, _ = taylor(c, x)
        found = about + x - w / dw
        found = choose((dw < 0.0) & (found > low) & (found < high), found, 0.5 * (low + high))
        guessing = stage == GUESS
        store(s, i, TIME, choose(guessing, found, time))
        store(s, i, STAGE, choose(guessing, REFINE, stage))


@njit(**SIMD_INLINE)
def evaluate_trial(s):
    """The instant at the time that each lane looks at, on arcs from the base."""
    elements(s)
    for i in range(LANES):
        u, v, cosine, sine = instant_of(s, i, -1.0)
        store(s, i, ANGLE_THERE, u)
        store(s, i, RATE_THERE, v)
        store(s, i, COSINE_THERE, cosine)
        store(s, i, SINE_THERE, sine)


@njit(**SIMD_INLINE)
def positive_by_tangent(u, fall, t, low, high):
    """Whether u is certainly positive on [low, high], in a convex stretch, by its value at t and fall = u + u' there.

    y = u e^t, convex in e^2t, lies above its tangent; (e^2d - 1)/2d <= 1 + 8d up to d = 2.
    """
    left = high - t
    down = choose(left < 2.0, -fall * left * fma(8.0, left, 1.0), math.inf)
    return u - choose(fall > 0.0, fall * (t - low), down) > MARGIN


@njit(**SIMD_INLINE)
def step(s):
    """From the time looked at to the zero, or nearer to it; or to the bottom of a dip, which shows that there is none."""
    for i in range(LANES):
        stage, t, low, high = load(s, i, STAGE), load(s, i, TIME), load(s, i, LOW), load(s, i, HIGH)
        tries, wait, cleared = load(s, i, TRIES), load(s, i, WAIT), load(s, i, CLEARED)
        sinh, versinh = load(s, i, SINH), load(s, i, VERSINH)
        frequency = load(s, i, FREQUENCY)
        u, v, cosine, sine = (
            load(s, i, ANGLE_THERE),
            load(s, i, RATE_THERE),
            load(s, i, COSINE_THERE),
            load(s, i, SINE_THERE),
        )
        _, _, second, third, fourth, fifth, _ = derivatives(s, i, (u, v, cosine, sine))
        diving, fall = stage == MINIMUM, u + v
        per = 1.0 / choose(diving, v + second, v)
        y = -u * per
        factor = correction(y, second, third, fourth, per)

        # near enough, as ``fast_path.close``: the rest of the way by Taylor series
        bend, twist = y * per * second, y * (y * per) * third
        close = (v < 0.0) & (abs(y) * max(1.0, frequency) < NEAR)
        close &= (abs(bend) < NEAR) & (abs(twist) < NEAR * NEAR)
        arrived, x = (stage == REFINE) & close, y * factor
        slope = fma(x, fma(x, fma(x, fma(x, I4 * fifth, I3 * fourth), I2 * third), second), v)
        cosine, sine, sinh, versinh = onward(x, frequency, cosine, sine, sinh, versinh)
        store(s, i, WAIT, choose(arrived, t + x, wait))
        # of a lane that has not arrived nobody asks for these
        store(s, i, SPEED, -slope)
        store(s, i, NEXT_COSINE, cosine)
        store(s, i, NEXT_SINE, sine)
        store(s, i, NEXT_SINH, sinh)
        store(s, i, NEXT_VERSINH, versinh)

        # the bottom of a dip, where u + u' = 0, as ``first_zero.dip``
        held, through = diving | (stage == REFINE), diving & (u < 0.0)
        above = diving & positive_by_tangent(u, fall, t, low, high)
        beyond = choose(diving, through | (fall > 0.0), u <= 0.0)
        low, high = choose(held & (beyond == False), t, low), choose(held & beyond, t, high)  # noqa: E712
        ahead = t + choose(diving, -fall * per, y * halved(factor))
        # A step that would leave what holds the zero, or the bottom, goes to its middle.
        inside = (ahead >= low) & (ahead <= high) & (diving | (v < 0.0))
        store(s, i, TIME, choose(held, choose(inside, ahead, 0.5 * (low + high)), t))
        store(s, i, LOW, low)
        store(s, i, HIGH, high)
        store(s, i, TRIES, choose(held, tries + 1.0, tries))
        store(s, i, CLEARED, choose(above, 1.0, cleared))
        tired = choose(held & (tries > MAX_TRIES), FAILED, stage)
        on = choose(above, BRACKET, choose(through, REFINE, tired))
        store(s, i, STAGE, choose(arrived, AT_EVENT, on))
