"""First event of the arc of each lane: brackets, guesses, steps of fifth order, and the arcs between braces.

At the ends of the sign intervals, and halfway, cos eta is known and e^t follows by multiplication. So u = c+
e^t + c- e^-t + 1 + beta cos eta needs no elementary function. The signs of u there prove which interval contains the
first zero. The proof is that of ``fast_search_cosine``.

Between braces the series about the start of an arc, or about a later instant, predicts the event. The cubic between
two instants proves that nothing is met between them, as in ``fast_search_cosine.fast_first_event``. Undecided cases are left to the
functions for one block.
"""

import math
from typing import NamedTuple

from rocking.kernels.arc.arc import MAX_ARC_TIME
from rocking.kernels.arc.fast_search_cosine import MARGIN, REACH, grazes, may_dip, stays_between
from rocking.kernels.lanes.state import AT_EVENT, BRACKET, EXTEND, FAILED, GUESS, MINIMUM, REFINE
from rocking.kernels.library.kernel import kernel
from rocking.kernels.numerics.elementary import choose, fma
from rocking.kernels.numerics.simd import circular, hyperbolic
from rocking.kernels.numerics.taylor import (
    I2,
    I3,
    I4,
    I5,
    I6,
    reversion,
    series,
    velocity_after,
    within_a_factor_of_two,
)


class ConvexInterval(NamedTuple):
    """Values of u on a convex sign interval: at its start, halfway and at its end, with error bounds."""

    u: float
    u_half: float
    u_right: float
    error: float
    error_right: float
    passed: bool  # it contains no zero
    doubtful: bool  # it contains zeros only if u has a minimum below zero inside


@kernel(inline=True)
def convex_interval(s, i):
    """Return the ``ConvexInterval`` of lane i that begins at ``end``."""
    displacement, forced_velocity = s.sign_change_displacement[i], s.sign_change_velocity[i]
    response = s.response[i]
    growing, shrinking = s.growing[i] * s.z[i], s.shrinking[i] * s.per_z[i]
    u, du = growing + shrinking + displacement, growing - shrinking - forced_velocity
    error = MARGIN * (abs(growing) + abs(shrinking) + 1.0)
    growing, shrinking = growing * s.half_growth[i], shrinking * s.half_decay[i]
    u_half, du_half = growing + shrinking + 1.0 - response, growing - shrinking
    growing, shrinking = growing * s.half_growth[i], shrinking * s.half_decay[i]
    u_right, du_right = growing + shrinking + displacement, growing - shrinking + forced_velocity
    error_right = error + MARGIN * (abs(growing) + abs(shrinking))
    for_ever = (growing > 0.0) & (growing - abs(shrinking) + 1.0 - response > error_right)
    passed = (u > error) & (u_half > error_right) & (u_right > error_right)
    passed = passed & (s.end[i] < MAX_ARC_TIME) & (for_ever == False)  # noqa: E712
    tanh = s.half_tanh[i]
    doubt = may_dip(u, du, u_half, du_half, tanh) | may_dip(u_half, du_half, u_right, du_right, tanh)
    doubt = doubt & (s.cleared[i] == 0.0)
    return ConvexInterval(u, u_half, u_right, error, error_right, passed & (doubt == False), passed & doubt)  # noqa: E712


@kernel(inline=True)
def turn_forcing(s, i, turns):
    """Move ``end`` of lane i forward by one forcing period, if ``turns``."""
    end, z, per_z = s.end[i], s.z[i], s.per_z[i]
    s.end[i] = choose(turns, end + s.period[i], end)
    s.z[i] = choose(turns, z * s.turn_growth[i], z)
    s.per_z[i] = choose(turns, per_z * s.turn_decay[i], per_z)


@kernel(inline=True)
def skip_clear_period(s, i):
    """Advance the search by one forcing period, if the next sign intervals certainly contain no zero."""
    passed = convex_interval(s, i).passed & (s.stage[i] == BRACKET)
    s.low[i] = choose(passed, s.end[i] + s.outside[i], s.low[i])
    s.cleared[i] = choose(passed, 0.0, s.cleared[i])
    turn_forcing(s, i, passed)


@kernel(inline=True)
def walk(s, i):
    """Pass the next convex sign interval and the concave one before it, or bracket the zero in one of them.

    ``skip_clear_period`` before it only passes intervals: in most cases only the last of two periods contains
    the zero.
    """
    stage, low, end, outside = s.stage[i], s.low[i], s.end[i], s.outside[i]
    interval = convex_interval(s, i)
    above, found_in = interval.u > interval.error, interval.u < -interval.error
    dips = above & (interval.u_half < -interval.error_right)
    falls = (interval.u_right < -interval.error_right) & (interval.u_half > interval.error_right)
    found = found_in | dips | (above & falls)
    on = choose(interval.passed, BRACKET, choose(interval.doubtful, MINIMUM, FAILED))
    halfway = fma(0.5, outside, end)
    high = choose(found_in, end, choose(dips, halfway, end + outside))
    next_low = choose(found_in, low, choose(interval.passed, end + outside, end))
    walking = stage == BRACKET
    s.stage[i] = choose(walking, choose(found, GUESS, on), stage)
    s.concave[i] = choose(walking, choose(found_in, 1.0, -1.0), s.concave[i])
    s.low[i] = choose(walking, next_low, low)
    s.high[i] = choose(walking, high, s.high[i])
    s.time[i] = choose(walking, halfway, s.time[i])
    s.tries[i] = choose(walking, 0.0, s.tries[i])
    s.cleared[i] = choose(walking, 0.0, s.cleared[i])
    turn_forcing(s, i, interval.passed & walking)


@kernel(inline=True)
def derivatives(s, i, there):
    """Return u and its first six derivatives at an instant (u, u', cos eta, sin eta) in lane i, from u'' = u + f."""
    u, v, cosine, sine = there
    square, acceleration = s.frequency_square[i], s.amplitude[i] * cosine
    df, ddf = s.amplitude_rate[i] * sine, square * acceleration
    c2, c3 = u - (1.0 + acceleration), v + df
    c4, c5 = c2 + ddf, fma(-square, df, c3)
    return u, v, c2, c3, c4, c5, fma(-square, ddf, c4)


@kernel(inline=True)
def instant_of(s, i, above):
    """Evaluate the arc of lane i at its trial time, eq. (5); u0 = 1 + ``above``.

    The formulas are those of ``forced_response`` and ``propagate``.

    Returns
    -------
    tuple of (float, float, float, float)
        u - u0 and u'.
        cos eta and sin eta.
    """
    frequency, response = s.frequency[i], s.response[i]
    velocity, cosine, sine = s.velocity[i], s.cosine[i], s.sine[i]
    sinh, versinh, excess = s.sinh[i], s.versinh[i], s.excess[i]
    sin_x, versine, lag = s.sin_x[i], s.versine[i], s.lag[i]
    near = s.time[i] < s.short_time_limit[i]
    in_phase, quadrature = versinh + versine, fma(frequency, excess, lag)
    displacement = choose(near, -fma(s.frequency_square[i], s.higher[i], s.deficit[i]), in_phase)
    forced_velocity = choose(near, -frequency * quadrature, fma(frequency, sin_x, sinh))
    steady = choose(near, fma(-s.amplitude[i], cosine, above), above)
    response_cosine = response * cosine
    displaced = fma(response * sine, quadrature, -response_cosine * displacement)
    moved = fma(s.response_rate[i] * sine, in_phase, -response_cosine * forced_velocity)
    return (
        fma(velocity, sinh, fma(steady, versinh, displaced)),
        velocity + fma(velocity, versinh, fma(steady, sinh, moved)),
        cosine - fma(cosine, versine, sine * sin_x),
        sine - fma(sine, versine, -cosine * sin_x),
    )


@kernel(inline=True)
def evaluate_hyperbolic(s, i):
    """Evaluate the hyperbolic functions of the trial time of lane i."""
    s.sinh[i], s.versinh[i], s.excess[i], s.higher[i] = hyperbolic(s.time[i])


@kernel(inline=True)
def evaluate_circular(s, i):
    """Evaluate the circular functions of the trial time of lane i."""
    s.sin_x[i], s.versine[i], s.lag[i], s.deficit[i] = circular(s.frequency[i], s.time[i])


@kernel(inline=True)
def set_next(s, i, x, cosine, sine):
    """Write the forcing and the hyperbolic functions a small time x after the trial time.

    The series are those of ``fast_search_cosine.taylor_step``.
    """
    sinh, versinh, angle = s.sinh[i], s.versinh[i], s.frequency[i] * x
    sin_x = angle * fma(-angle * angle, I3, 1.0)
    versine = angle * angle * fma(-angle * angle, I4, I2)
    sinh_x, versinh_x = x * fma(x * x, I3, 1.0), x * x * fma(x * x, I4, I2)
    s.next_cosine[i] = cosine - fma(cosine, versine, sine * sin_x)
    s.next_sine[i] = sine - fma(sine, versine, -cosine * sin_x)
    s.next_sinh[i] = sinh + fma(sinh, versinh_x, fma(versinh, sinh_x, sinh_x))
    s.next_versinh[i] = versinh + fma(versinh, versinh_x, fma(sinh, sinh_x, versinh_x))


MAX_TRIES = 12
# From this close the remainder of the step of fifth order, and of the series after it, is below rounding.
NEAR = 1e-3


@kernel(inline=True)
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


@kernel(inline=True)
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


@kernel(inline=True)
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


@kernel(inline=True)
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


@kernel(inline=True)
def there(s, i):
    """Return (u, u', cos eta, sin eta) of lane i at its last evaluation."""
    return s.angle_there[i], s.rate_there[i], s.cosine_there[i], s.sine_there[i]


@kernel(inline=True)
def evaluate_trial(s, i):
    """Evaluate the arc of lane i, which starts at the base, at its trial time."""
    u, v, cosine, sine = instant_of(s, i, -1.0)
    s.angle_there[i] = u
    s.rate_there[i] = v
    s.cosine_there[i] = cosine
    s.sine_there[i] = sine


@kernel(inline=True)
def positive_by_tangent(u, fall, t, low, high):
    """Return whether u is certainly positive on [low, high], in a convex sign interval, from one point of it.

    The point is u at t, with fall = u + u' there. The function y = u e^t, convex in e^2t, lies above its
    tangent. Up to d = 2, (e^2d - 1)/2d <= 1 + 8d holds.
    """
    left = high - t
    down = choose(left < 2.0, -fall * left * fma(8.0, left, 1.0), math.inf)
    return u - choose(fall > 0.0, fall * (t - low), down) > MARGIN


@kernel(inline=True)
def step(s, i):
    """Step from the trial time to the zero or towards it, or to the minimum that proves that there is none."""
    u, v, cosine, sine = there(s, i)
    _, _, second, third, fourth, fifth, _ = derivatives(s, i, (u, v, cosine, sine))
    diving = s.stage[i] == MINIMUM
    per = 1.0 / choose(diving, v + second, v)
    y = -u * per
    factor = reversion(y, second, third, fourth, per)
    # near enough, as in ``fast_search_cosine.close``: the rest of the way by Taylor series
    bend, twist = y * per * second, y * (y * per) * third
    close = (v < 0.0) & (abs(y) * max(1.0, s.frequency[i]) < NEAR)
    close &= (abs(bend) < NEAR) & (abs(twist) < NEAR * NEAR)
    arrived, x = (s.stage[i] == REFINE) & close, y * factor
    s.wait[i] = choose(arrived, s.time[i] + x, s.wait[i])
    # these are used only for lanes that have arrived
    s.speed[i] = -velocity_after((v, second, third, fourth, fifth), x)
    set_next(s, i, x, cosine, sine)
    narrow(s, i, arrived, choose(diving, -(u + v) * per, y * within_a_factor_of_two(factor)))


@kernel(inline=True)
def narrow(s, i, arrived, ahead):
    """Narrow the interval of the zero or of the minimum; choose the next stage.

    At the minimum u + u' = 0 (``first_zero_cosine.time_below_zero``). The next trial is ``ahead`` of the last one.
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


MAX_BRACED_TRIES, ROUNDS = 8, 2
# From this close the remainder of the step of fifth order, and of the series after it, is below rounding.
BRACED_NEAR = 1e-3


@kernel(inline=True)
def parabola(u, v, second, brace_angle):
    """Guess the next event by the parabola or, against the acceleration, by the tangent.

    The guess is that of ``fast_search_cosine.parabola_step``.

    Returns
    -------
    tuple of (bool, float)
        Whether it is at a brace.
        The time to it.
    """
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


@kernel(inline=True)
def coefficients(s, i, u, c, at_brace):
    """Return value and first eight derivatives, at the last jet, of the function that vanishes at the event.

    The function is u, or the distance from a brace.
    """
    square = s.frequency_square[i]
    c7 = fma(square * square, s.amplitude_rate[i] * s.knot_sine[i], c[5])
    c8 = fma(square * square, square * s.amplitude[i] * s.knot_cosine[i], c[6])
    sign = choose(at_brace, -1.0, 1.0)
    c0 = choose(at_brace, s.brace_angle[i] - u, u)
    return (
        c0,
        sign * c[1],
        sign * c[2],
        sign * c[3],
        sign * c[4],
        sign * c[5],
        sign * c[6],
        sign * c7,
        sign * c8,
    )


@kernel(inline=True)
def predict_event(s, i):
    """Write the next trial time of lane i: the event that the series predicts or, if there is none, a later time."""
    u, v, aims = s.knot_angle[i], s.knot_rate[i], s.stage[i] == BRACKET
    c = derivatives(s, i, (u, v, s.knot_cosine[i], s.knot_sine[i]))
    at_brace, rough = parabola(u, v, c[2], s.brace_angle[i])
    c = coefficients(s, i, u, c, at_brace)
    farthest = REACH / max(1.0, s.frequency[i])
    rough = choose(rough <= farthest, rough, farthest)
    x, certain = rough, rough > 0.0
    for _ in range(ROUNDS):
        w, dw, second, third, fourth = series(c, x)
        per = 1.0 / dw
        y = -w * per
        certain = certain & (dw < 0.0)
        x += y * within_a_factor_of_two(reversion(y, second, third, fourth, per))
    certain = certain & (x > 0.0) & (x <= farthest)
    s.time[i] = choose(aims, s.about[i] + choose(certain, x, rough), s.time[i])
    s.at_brace[i] = choose(aims, choose(at_brace, 1.0, 0.0), s.at_brace[i])
    s.stage[i] = choose(aims, choose(certain, REFINE, EXTEND), s.stage[i])


@kernel(inline=True)
def correct_event(s, i):
    """Step from the trial time of lane i to the event or towards it, or expand the series there if it is too far."""
    t, angle, brace_angle, at_brace = s.time[i], s.angle[i], s.brace_angle[i], s.at_brace[i] > 0.0
    risen, v, cosine, sine = instant_of(s, i, angle - 1.0)
    u = angle + risen
    _, _, second, third, fourth, fifth, _ = derivatives(s, i, (u, v, cosine, sine))
    # near a brace: the remaining distance to it
    left = choose(at_brace, risen - (brace_angle - angle), u)
    per = 1.0 / v
    y = -left * per
    factor = reversion(y, second, third, fourth, per)
    x = y * factor
    slope = velocity_after((v, second, third, fourth, fifth), x)
    towards = choose(at_brace, v, -v)
    close = (abs(left) * max(1.0, s.frequency[i]) < BRACED_NEAR * towards) & (
        abs(left * second) < BRACED_NEAR * v * v
    )
    close = close & (left * left * abs(third) < BRACED_NEAR * BRACED_NEAR * towards * v * v)

    heads = s.stage[i] == REFINE
    end = choose(heads, choose(at_brace, brace_angle, 0.0), u), choose(heads, slope, v)
    free = stays_between(
        (s.amplitude[i], s.frequency[i], brace_angle),
        choose(heads, t + x, t) - s.about[i],
        (s.knot_angle[i], s.knot_rate[i]),
        end,
    )
    touches = grazes(s.amplitude[i], angle, s.velocity[i], t + x, slope)
    arrived = heads & close & free & (touches == False)  # noqa: E712
    # these are used only for lanes that have arrived
    s.wait[i] = choose(arrived, t + x, s.wait[i])
    s.speed[i] = abs(slope)
    set_next(s, i, x, cosine, sine)
    nears = heads & (close == False) & (towards > 0.0)  # noqa: E712
    choose_trial(s, i, (u, v, cosine, sine), arrived, free, nears, t + y * within_a_factor_of_two(factor))


@kernel(inline=True)
def choose_trial(s, i, there, arrived, free, nears, ahead):
    """Choose the next stage and trial time of lane i from its state ``there``, at the last trial time.

    * If the lane has ``arrived`` at the event, the arc ends.
    * If it ``nears`` the event, the next trial is the time ``ahead``.
    * If the arc is certainly ``free`` until then, it continues from there.
    * Else it goes back by half of the way.
    """
    u, v, cosine, sine = there
    stage, t, about, tries = s.stage[i], s.time[i], s.about[i], s.tries[i]
    heads, goes_on = stage == REFINE, stage == EXTEND
    moves, further, nears = heads | goes_on, goes_on & free, nears & (ahead > about)
    # too far: the event lies before
    above, beneath = goes_on & (u > s.brace_angle[i]), goes_on & (u < 0.0)
    beyond = above | beneath
    back = moves & ((arrived | nears | further | beyond) == False)  # noqa: E712
    s.knot_angle[i] = choose(further, u, s.knot_angle[i])
    s.knot_rate[i] = choose(further, v, s.knot_rate[i])
    s.knot_cosine[i] = choose(further, cosine, s.knot_cosine[i])
    s.knot_sine[i] = choose(further, sine, s.knot_sine[i])
    s.about[i] = choose(further, t, about)
    s.at_brace[i] = choose(above, 1.0, choose(beneath, 0.0, s.at_brace[i]))
    s.time[i] = choose(nears, ahead, choose(back, fma(0.5, t - about, about), t))
    s.tries[i] = choose(moves, tries + 1.0, tries)
    on = choose(arrived, AT_EVENT, choose(nears | beyond, REFINE, choose(further, BRACKET, EXTEND)))
    on = choose(arrived | (tries < MAX_BRACED_TRIES), on, FAILED)
    s.stage[i] = choose(moves, on, stage)
