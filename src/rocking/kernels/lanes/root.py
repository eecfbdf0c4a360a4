"""First zero of the arc of each lane in its known sign interval: a guess, and steps of fifth order."""

import math

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.harmonic.bracket import MARGIN
from rocking.kernels.lanes.evaluate import derivatives, instant_of, set_next
from rocking.kernels.lanes.state import AT_EVENT, BRACKET, FAILED, GUESS, MINIMUM, REFINE
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import choose
from rocking.kernels.numerics.taylor import (
    I2,
    I3,
    I4,
    I5,
    I6,
    reversion,
    velocity_after,
    within_a_factor_of_two,
)

MAX_TRIES = 12
# From this close the remainder of the step of fifth order, and of the series after it, is below rounding.
NEAR = 1e-3


@njit(**INTERNAL_INLINE)
def taylor(c, x):
    """Evaluate a Taylor series with coefficients c a time x later, by three Horner schemes.

    Returns
    -------
    tuple of (float, float, float)
        w, w' and w''/2.
    """
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


@njit(**INTERNAL_INLINE)
def middle_of_half(s, i):
    """Evaluate the arc in the middle of that half of its sign interval which contains the zero.

    Returns
    -------
    tuple of six floats
        Time, u, u', cos eta and sin eta.
        A quarter of the length of the interval.
    """
    within, end = s.concave[i] > 0.0, s.end[i]
    # of the concave interval, which ends at ``end``, or of the convex one, which begins there
    more, less = choose(within, s.grow_in[i], s.grow_out[i]), choose(within, s.decay_in[i], s.decay_out[i])
    # from ``end`` to the middle: two quarters forwards or backwards
    on, back = choose(within, less, more), choose(within, more, less)
    growing, shrinking = s.growing[i] * (s.z[i] * (on * on)), s.shrinking[i] * (s.per_z[i] * (back * back))
    quarter = 0.25 * choose(within, s.inside[i], s.outside[i])
    middle = end + choose(within, -(quarter + quarter), quarter + quarter)
    late = (fma(s.concave[i], s.response[i], growing + shrinking) > -1.0) | (middle <= s.low[i])
    growing, shrinking = growing * choose(late, more, less), shrinking * choose(late, less, more)
    cosine = choose(within, s.cosine_in[i], s.cosine_out[i])
    sine = choose(within, s.sine_in[i], s.sine_out[i])
    sine = choose(late, sine, -sine)
    u = growing + shrinking + fma(s.response[i], cosine, 1.0)
    v = fma(-s.response_rate[i], sine, growing - shrinking)
    return middle + choose(late, quarter, -quarter), u, v, cosine, sine, quarter


@njit(**INTERNAL_INLINE)
def initial_guess(s, i):
    """Guess the zero by a parabola about the middle of half its sign interval, or about the start of a short arc."""
    about, u, v, cosine, sine, quarter = middle_of_half(s, i)
    # A short arc ends about where the parabola from its start does.
    amplitude, velocity, fall = s.amplitude[i], s.velocity[i], fma(s.amplitude[i], s.cosine[i], 1.0)
    short = 2.0 * velocity * s.frequency[i] < fall
    hops = (s.low[i] == 0.0) & short & (4.0 * velocity < fall * s.high[i])
    u, v = choose(hops, 0.0, u), choose(hops, velocity, v)
    cosine, sine = choose(hops, s.cosine[i], cosine), choose(hops, s.sine[i], sine)
    second = u + fma(-amplitude, cosine, -1.0)
    # else half a quarter further, on the side of the zero
    under = fma(v, v, -2.0 * u * second)
    root = math.sqrt(max(under, 0.0))
    x = choose(v > 0.0, v + root, 2.0 * u) / choose(v > 0.0, -second, root - v)
    near = hops | ((under > 0.0) & (abs(x) < quarter))
    s.angle_there[i] = u
    s.rate_there[i] = v
    s.cosine_there[i] = cosine
    s.sine_there[i] = sine
    s.about[i] = choose(hops, 0.0, about)
    s.guess_offset[i] = choose(near, x, choose(u > 0.0, 0.5, -0.5) * quarter)


@njit(**INTERNAL_INLINE)
def guess(s, i):
    """Find the zero to about six digits: two steps on the Taylor series about the point of ``initial_guess``."""
    low, high, x, guessing = s.low[i], s.high[i], s.guess_offset[i], s.stage[i] == GUESS
    c0, c1, c2, c3, c4, c5, c6 = derivatives(s, i, there(s, i))
    c = c0, c1, I2 * c2, I3 * c3, I4 * c4, I5 * c5, I6 * c6
    w, dw, half_ddw = taylor(c, x)
    per = 1.0 / dw
    y = -w * per
    bend = y * half_ddw * per
    x += y * within_a_factor_of_two(fma(bend, fma(2.0, bend, -1.0), 1.0))
    w, dw, _ = taylor(c, x)
    found = s.about[i] + x - w / dw
    found = choose((dw < 0.0) & (found > low) & (found < high), found, 0.5 * (low + high))
    s.time[i] = choose(guessing, found, s.time[i])
    s.stage[i] = choose(guessing, REFINE, s.stage[i])


@njit(**INTERNAL_INLINE)
def there(s, i):
    """Return (u, u', cos eta, sin eta) of lane i at its last evaluation."""
    return s.angle_there[i], s.rate_there[i], s.cosine_there[i], s.sine_there[i]


@njit(**INTERNAL_INLINE)
def evaluate_trial(s, i):
    """Evaluate the arc of lane i, which starts at the base, at its trial time."""
    u, v, cosine, sine = instant_of(s, i, -1.0)
    s.angle_there[i] = u
    s.rate_there[i] = v
    s.cosine_there[i] = cosine
    s.sine_there[i] = sine


@njit(**INTERNAL_INLINE)
def positive_by_tangent(u, fall, t, low, high):
    """Return whether u is certainly positive on [low, high], in a convex sign interval, from one point of it.

    The point is u at t, with fall = u + u' there. The function y = u e^t, convex in e^2t, lies above its
    tangent. Up to d = 2, (e^2d - 1)/2d <= 1 + 8d holds.
    """
    left = high - t
    down = choose(left < 2.0, -fall * left * fma(8.0, left, 1.0), math.inf)
    return u - choose(fall > 0.0, fall * (t - low), down) > MARGIN


@njit(**INTERNAL_INLINE)
def step(s, i):
    """Step from the trial time to the zero or towards it, or to the minimum that proves that there is none."""
    u, v, cosine, sine = there(s, i)
    _, _, second, third, fourth, fifth, _ = derivatives(s, i, (u, v, cosine, sine))
    diving = s.stage[i] == MINIMUM
    per = 1.0 / choose(diving, v + second, v)
    y = -u * per
    factor = reversion(y, second, third, fourth, per)
    # near enough, as in ``fast_path.close``: the rest of the way by Taylor series
    bend, twist = y * per * second, y * (y * per) * third
    close = (v < 0.0) & (abs(y) * max(1.0, s.frequency[i]) < NEAR)
    close &= (abs(bend) < NEAR) & (abs(twist) < NEAR * NEAR)
    arrived, x = (s.stage[i] == REFINE) & close, y * factor
    s.wait[i] = choose(arrived, s.time[i] + x, s.wait[i])
    # these are used only for lanes that have arrived
    s.speed[i] = -velocity_after((v, second, third, fourth, fifth), x)
    set_next(s, i, x, cosine, sine)
    narrow(s, i, arrived, choose(diving, -(u + v) * per, y * within_a_factor_of_two(factor)))


@njit(**INTERNAL_INLINE)
def narrow(s, i, arrived, ahead):
    """Narrow the interval of the zero or of the minimum; choose the next stage.

    At the minimum u + u' = 0 (``first_zero.time_below_zero``). The next trial is ``ahead`` of the last one.
    """
    stage, t, low, high = s.stage[i], s.time[i], s.low[i], s.high[i]
    u, v, diving, tries = s.angle_there[i], s.rate_there[i], stage == MINIMUM, s.tries[i]
    fall = u + v
    held, through = diving | (stage == REFINE), diving & (u < 0.0)
    above = diving & positive_by_tangent(u, fall, t, low, high)
    beyond = choose(diving, through | (fall > 0.0), u <= 0.0)
    low, high = choose(held & (beyond == False), t, low), choose(held & beyond, t, high)  # noqa: E712
    ahead = t + ahead
    # A step that would leave the interval goes to its middle.
    inside = (ahead >= low) & (ahead <= high) & (diving | (v < 0.0))
    s.time[i] = choose(held, choose(inside, ahead, 0.5 * (low + high)), t)
    s.low[i] = low
    s.high[i] = high
    s.tries[i] = choose(held, tries + 1.0, tries)
    s.cleared[i] = choose(above, 1.0, s.cleared[i])
    tired = choose(held & (tries > MAX_TRIES), FAILED, stage)
    on = choose(above, BRACKET, choose(through, REFINE, tired))
    s.stage[i] = choose(arrived, AT_EVENT, on)
