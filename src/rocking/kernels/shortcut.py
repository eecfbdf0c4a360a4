"""The first event of a flight, proved at a fraction of the cost of ``crossing``.

A steady motion repeats its arcs, so an earlier arc tells where the next zero is, and what carries an arc on by that
time is still at hand (``Lapse``): from there a Taylor series reaches the zero. Where it lies further off the series
guesses, and one new evaluation follows. Between braces flights are short, and the series about their start guesses. It is
the *first* zero if the block cannot turn on its way there, or no stretch before it holds one: most often their order
alone proves that, else ``walk``. Where the guess is no good, the walk brackets the zero and tells where to begin.
Whatever is not certain by a wide margin is left to ``crossing``.
"""

import math

from numba import njit

from .arc import Instant, after, lapse_of
from .crossing import LONGEST, reversion, step_to_zero
from .elementary import INNER
from .harmonic import forcing_rates, forcing_term
from .walk import (
    CLEAR,
    MARGIN,
    UNSURE,
    ZERO,
    Knot,
    base_level,
    brace_level,
    knot,
    start_knot,
    stays_clear,
    walk,
)

TRIES = 6
# The step by the reverted series and the Taylor series that follow it are exact to rounding for steps below this, in
# units of 1/max(1, Omega), of w'/w'' and of the root of w'/w'''.
SMALL = 2e-4
# A longer step is polished where it is shorter than REACH, in units of 1/max(1, Omega), in so many rounds; from a
# bend below this one more round would not show.
REACH, ROUNDS, BEND = 1.8, 3, 0.25
# From so near, and such a bend, it needs no polish.
NEAR = 0.7
I2, I3, I4, I5, I6, I7, I8 = (1.0 / math.factorial(k) for k in range(2, 9))


@njit(**INNER)
def advance(p, now, step):
    """An instant carried on by a small step: Taylor series with all its derivatives from u'' = u + f; the angle is the caller's."""
    f = forcing_term(p, now.cosine)
    df, ddf = forcing_rates(p, now.cosine, now.sine)
    second = now.angle + f
    third = now.velocity + df
    fourth = second + ddf
    fifth = third - p.frequency * p.frequency * df
    velocity = now.velocity + step * (
        second + step * (0.5 * third + step * ((1.0 / 6.0) * fourth + step * ((1.0 / 24.0) * fifth)))
    )
    x = p.frequency * step
    sin_x = x * (1.0 - x * x * (1.0 / 6.0 - x * x * (1.0 / 120.0)))
    versine = x * x * (0.5 - x * x * (1.0 / 24.0))
    cosine = now.cosine - (now.cosine * versine + now.sine * sin_x)
    sine = now.sine - (now.sine * versine - now.cosine * sin_x)
    h = step * (1.0 + step * step * (1.0 / 6.0))
    v = step * step * (0.5 + step * step * (1.0 / 24.0))
    sinh = now.sinh + (now.sinh * v + h + now.versinh * h)
    versinh = now.versinh + (now.versinh * v + v + now.sinh * h)
    return Instant(0.0, 0.0, velocity, cosine, sine, sinh, versinh)


@njit(**INNER)
def close(p, now):
    """Whether the zero of w is so near that one step of the series reaches it."""
    w, v = abs(now.w), -now.dw
    bend, twist = w * abs(now.w + now.f), w * w * abs(now.dw + now.df)
    return (
        w * max(1.0, p.frequency) < SMALL * v and bend < SMALL * v * v and twist < SMALL * SMALL * v * v * v
    )


@njit(**INNER)
def stride(now):
    """A step towards the zero of w from further off: to where the parabola comes down, infinity where it does not."""
    fall = now.w + now.f
    under = now.dw * now.dw - 2.0 * now.w * fall
    if fall < 0.0 and under > 0.0:
        return (now.dw + math.sqrt(under)) / -fall
    return -now.w / now.dw if now.dw < 0.0 else math.inf


@njit(**INNER)
def turned(p, steady, now):
    """f'' at a knot; f = -steady and a part that turns with the forcing."""
    return -p.frequency * p.frequency * (now.f + steady)


@njit(**INNER)
def polished(p, steady, now, rough):
    """A rough step to the zero of w, corrected by where the Taylor series about ``now`` has it: no new elementary functions.

    c_k are the derivatives of w there, w_k those at the end of the step. Only a guess: the series stops where it is
    good to some three digits within REACH. Where it does not fall towards a zero the rough step is returned as it was.
    """
    square = -p.frequency * p.frequency
    df, ddf = now.df, turned(p, steady, now)
    c0, c1 = now.w, now.dw
    c2, c3 = c0 + now.f, c1 + df
    c4, c5 = c2 + ddf, c3 + square * df
    c6, c7 = c4 + square * ddf, c5 + square * square * df
    c8 = c6 + square * square * ddf
    s = rough
    for _ in range(ROUNDS):
        q = s * s
        h = q * q
        w4 = (c4 + s * c5) + q * (I2 * c6)
        w3 = (c3 + s * c4) + q * (I2 * c5 + s * (I3 * c6))
        w2 = (c2 + s * c3) + q * (I2 * c4 + s * (I3 * c5)) + h * (I4 * c6 + s * (I5 * c7))
        w1 = (c1 + s * c2) + q * (I2 * c3 + s * (I3 * c4)) + h * ((I4 * c5 + s * (I5 * c6)) + q * (I6 * c7))
        w0 = (c0 + s * c1) + q * (I2 * c2 + s * (I3 * c3))
        w0 += h * ((I4 * c4 + s * (I5 * c5)) + q * (I6 * c6 + s * (I7 * c7)) + h * (I8 * c8))
        if not w1 < 0.0:
            return rough
        s += step_to_zero(w0, w1, (w2 - w0, w3 - w1, w4 - w2))
        if abs(w0 * w2) < BEND * w1 * w1:
            break
    return s


@njit(**INNER)
def leap(p, steady, here):
    """(whether the series about a knot tells where w has its zero, the step there)."""
    if abs(here.w * (here.w + here.f)) < BEND * here.dw * here.dw and here.dw < 0.0:
        step = step_to_zero(here.w, here.dw, (here.f, here.df, turned(p, steady, here)))
        if max(1.0, p.frequency) * abs(step) < NEAR:
            return True, step
    step = stride(here)
    if max(1.0, p.frequency) * abs(step) <= REACH:
        return True, polished(p, steady, here, step)
    return False, step


@njit(**INNER)
def seek(p, arc, constant, s, lapse, low, high):
    """(reached, time, instant, lapse close by) of a zero of w = constant + s u between two times, from a lapse not far from it."""
    now = after(p, arc, lapse)
    for _ in range(TRIES):
        here = knot(p, arc, constant, s, lapse.time, now)
        if close(p, here):
            y, correction = reversion(here.w, here.dw, (here.f, here.df, turned(p, constant + s, here)))
            step = y * correction
            t = lapse.time + step
            return low < t < high, t, advance(p, now, step), lapse
        told, step = leap(p, constant + s, here)
        t = lapse.time + step
        if not (told and low < t < high):
            break
        lapse = lapse_of(p, t)
        now = after(p, arc, lapse)
    return False, lapse.time, now, lapse


@njit(**INNER)
def seek_in(p, arc, constant, s, bracket):
    """``seek`` in a bracket: from where the series about its nearer end has the zero, or from the middle where both are far."""
    low, high = bracket.low, bracket.high
    told, step = leap(p, constant + s, low)
    t = low.time + step
    if not (told and low.time < t < high.time):
        told, step = leap(p, constant + s, high)
        t = high.time + step
        if not (told and low.time < t < high.time):
            t = 0.5 * (low.time + high.time)
    return seek(p, arc, constant, s, lapse_of(p, t), low.time, min(high.time, LONGEST))


@njit(**INNER)
def likely_impact(p, arc, guess):
    """(answer, time, instant, lapse close by) of the first event of a flight without braces: ZERO, NEVER, or UNSURE.

    From the lapse that is guessed, if it leads to an impact that is certainly the first; else from a walk.
    """
    if guess.time > 0.0:
        reached, t, now, lapse = seek(p, arc, 0.0, 1.0, guess, 0.0, LONGEST)
        if reached and stays_clear(p, arc, base_level(p), Knot(t, 0.0, now.velocity, 0.0, 0.0)):
            return ZERO, t, now, lapse
    bracket = walk(p, arc, base_level(p), Knot(math.inf, 0.0, 0.0, 0.0, 0.0))
    reached, t, now, lapse = seek_in(p, arc, 0.0, 1.0, bracket)
    return (bracket.answer if bracket.answer != ZERO or reached else UNSURE), t, now, lapse


@njit(**INNER)
def bracketed(p, arc, reached, event):
    """(answer, whether at a brace, walk): the bracket of a flight's first event, or CLEAR where the one ``reached`` is the first.

    ``event`` is that in terms of the base, u and u'. Where a brace is met the base is far, and the other way round: a zero in
    the bracket of the one comes before that of the other.
    """
    never = Knot(math.inf, 0.0, 0.0, 0.0, 0.0)
    base = walk(p, arc, base_level(p), event if reached else never)
    if base.answer == UNSURE:
        return UNSURE, False, base
    until = base.high if base.answer == ZERO else event
    end = Knot(until.time, p.brace_angle - until.w, -until.dw, 0.0, 0.0)
    brace = walk(p, arc, brace_level(p), end if reached or base.answer == ZERO else never)
    if brace.answer == ZERO or brace.answer == UNSURE:
        return brace.answer, True, brace
    if base.answer == ZERO:
        return ZERO, False, base
    return CLEAR if reached else UNSURE, False, base


@njit(**INNER)
def ahead(p, arc):
    """(whether at a brace, after how long) the event seems to be, by the series about the start; infinite where that tells none."""
    base, brace = start_knot(p, arc, base_level(p)), start_knot(p, arc, brace_level(p))
    to_base, to_brace = stride(base), stride(brace)
    at_brace = to_brace < to_base
    here, rough = (brace, to_brace) if at_brace else (base, to_base)
    if not max(1.0, p.frequency) * rough <= REACH:
        return at_brace, math.inf
    step = polished(p, p.brace_angle - 1.0 if at_brace else 1.0, here, rough)
    return at_brace, step if step > 0.0 and step != rough else math.inf


@njit(**INNER)
def crosses(p, arc, at_brace, t, speed):
    """Whether an arc that arrives with this speed after t certainly never turns on its way: then it meets nothing before.

    u'' >= -A - 1 above the base and u'' <= A + brace_angle - 1 below the brace. So |u'| is above zero for its value at the start
    over the one bound, counted from there, and for its value at the end over the other, counted back from there: together
    longer than t.
    """
    fall, rise = p.amplitude + 1.0, (p.amplitude - 1.0) + p.brace_angle
    towards, first, last = (arc.velocity, fall, rise) if at_brace else (-arc.velocity, rise, fall)
    return (1.0 + MARGIN) * t * first * last < towards * last + speed * first


@njit(**INNER)
def likely_event(p, arc):
    """(answer, whether at a brace, time, instant) of the first event of a flight between braces.

    It is guessed from the start of the arc, not from an earlier one: in chaos that is seldom like it.
    """
    at_brace, t = ahead(p, arc)
    constant, s = (p.brace_angle, -1.0) if at_brace else (0.0, 1.0)
    reached, velocity = False, 0.0
    if t < math.inf:
        reached, t, now, _ = seek(p, arc, constant, s, lapse_of(p, t), 0.0, LONGEST)
        velocity = now.velocity
        if reached and crosses(p, arc, at_brace, t, abs(velocity)):
            return ZERO, at_brace, t, now
    answer, other, bracket = bracketed(p, arc, reached, Knot(t, constant, velocity, 0.0, 0.0))
    if reached and answer != ZERO:
        return UNSURE if answer == UNSURE else ZERO, at_brace, t, now
    constant, s = (p.brace_angle, -1.0) if other else (0.0, 1.0)
    reached, t, now, _ = seek_in(p, arc, constant, s, bracket)
    return ZERO if answer == ZERO and reached else UNSURE, other, t, now
