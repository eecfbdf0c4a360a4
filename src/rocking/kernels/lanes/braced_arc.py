"""Arcs between braces, in lanes: the event that ends each, and the proof that nothing is met before.

The method is that of ``fast_path.fast_first_event`` for one block. The series about the start, or about a
later instant, predicts the event. The cubic between two instants proves that nothing is met between them.
Undecided cases are left to the functions for one block.
"""

import math

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.harmonic.enclosure import grazes, stays_between
from rocking.kernels.forcing.harmonic.fast_path import REACH
from rocking.kernels.lanes.evaluate import derivatives, instant_of, set_next
from rocking.kernels.lanes.state import AT_EVENT, BRACKET, EXTEND, FAILED, REFINE
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import choose
from rocking.kernels.numerics.taylor import reversion, series, velocity_after, within_a_factor_of_two

MAX_TRIES, ROUNDS = 8, 2
# From this close the remainder of the step of fifth order, and of the series after it, is below rounding.
NEAR = 1e-3


@njit(**INTERNAL_INLINE)
def parabola(u, v, second, brace_angle):
    """Guess the next event by the parabola or, against the acceleration, by the tangent.

    The guess is that of ``fast_path.parabola_step``.

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


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL_INLINE)
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
    close = (abs(left) * max(1.0, s.frequency[i]) < NEAR * towards) & (abs(left * second) < NEAR * v * v)
    close = close & (left * left * abs(third) < NEAR * NEAR * towards * v * v)

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


@njit(**INTERNAL_INLINE)
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
    on = choose(arrived | (tries < MAX_TRIES), on, FAILED)
    s.stage[i] = choose(moves, on, stage)
