"""Extrema of the angle of a slender block along an arc under a cosine, and the largest angle."""

import math

import numpy as np

from rocking.kernels import contract
from rocking.kernels.arc.arc import arc_peak, within_reach
from rocking.kernels.arc.first_zero_cosine import EventFunction, first_zero
from rocking.kernels.arc.slender_cosine import ROUNDING, evaluate, exponentials
from rocking.kernels.base.cosine import TURN, Cosine, forcing_rates, harmonic_term
from rocking.kernels.event_kinds import BRACE, IMPACT
from rocking.kernels.library.kernel import body, kernel
from rocking.kernels.numerics.elementary import RIGHT_ANGLE, fma, logarithm
from rocking.kernels.numerics.taylor import I2, I4, I6, I8, reversion, series, within_a_factor_of_two
from rocking.kernels.system import Slender

# Accuracy required of the middle of an arc, as a forcing phase. Two maxima closer to a tie than TIED are
# compared.
KNOWN, TIED = 1e-6, 1e-3
# From this close, in units of 1/max(1, Omega), a Taylor series reaches a maximum to rounding. TRIES limits
# the iterations.
NEAR, TRIES = 0.03, 6


@kernel(inline=True)
def turn_event_function(p, sign):
    """Return the event function of an extremum of the angle: w = sign u', f_w = sign A Omega sin eta."""
    half = RIGHT_ANGLE if p.forcing.amplitude > 0.0 else math.inf
    return EventFunction(0.0, 0.0, sign, sign * RIGHT_ANGLE, half, p.forcing.amplitude > 0.0)


@body(contract.turn_from, Slender, Cosine)
def turn_from(p, arc, sign, start, until):
    """Provide ``contract.turn_from``."""
    return first_zero(p, arc, turn_event_function(p, sign), start, until)


@kernel(inline=True)
def may_exceed(p, arc, coming, peak):
    """Return whether an arc up to an impact may reach an angle beyond ``peak``.

    h = u - 1 - beta cos eta obeys h'' = h. If h is negative at both ends, it stays below -min(|h|)/cosh(half
    the wait).
    """
    if peak >= p.block.brace_angle:
        return False
    start = 1.0 + p.forcing.response * arc.drive.cosine - arc.angle
    end = 1.0 + p.forcing.response * coming.drive.cosine
    nearest = min(start, end)
    return not (
        nearest > 0.0 and 1.0 + p.forcing.response - nearest / math.sqrt(1.0 + 0.5 * coming.versinh) <= peak
    )


@kernel(inline=True)
def may_rise_above(peak, m, away, frequency_square, response):
    """Return whether 1 - m cosh(t - middle) + beta cos eta may exceed ``peak``.

    The nearest maximum of cos eta lies a time ``away`` from the middle. The best compromise between the two
    terms is at most

        1 - m + beta - away**2 b m/(2 (m + b)).

    Here b is the least curvature of beta cos eta between the two times. It follows with a = Omega away from

        1 - cos y >= y**2 (1/2 - a**2/4! + a**4/6! - a**6/8!) for y up to a.

    From y = pi/2 to pi, 1 - cos y is at least 1.
    """
    away_2 = away * away
    a = min(frequency_square * away_2, RIGHT_ANGLE * RIGHT_ANGLE)
    bowl = 2.0 * response * frequency_square * fma(-a, fma(-a, fma(-a, I8, I6), I4), I2)
    above = 1.0 - m + response - peak
    return (above > response) | (above * (m + bowl) > 0.5 * away_2 * bowl * m)


@kernel(inline=True)
def maximum_near(p, now, second):
    """Find the maximum of u near an instant by the Taylor series there; ``second`` is u''.

    Returns
    -------
    tuple of (float, float, bool)
        Step towards the maximum.
        u there.
        Whether both are accurate to rounding.
    """
    square = p.forcing.frequency * p.forcing.frequency
    df, ddf = forcing_rates(p, now.drive.cosine, now.drive.sine)
    third, fourth, per = now.velocity + df, second + ddf, 1.0 / second
    fifth, sixth = third - square * df, fourth - square * ddf
    seventh, eighth = fifth + square * square * df, sixth + square * square * ddf
    y = -now.velocity * per
    step = y * within_a_factor_of_two(reversion(y, third, fourth, fifth, per))
    derivatives = now.angle, now.velocity, second, third, fourth, fifth, sixth, seventh, eighth
    most, rate, _, _, _ = series(derivatives, step)
    near = abs(step) < NEAR / max(1.0, p.forcing.frequency)
    # Beyond it u rises by no more than that, as long as u'' is below half of ``second``.
    return step, most, near and rate * rate <= ROUNDING * -second


@kernel(inline=True)
def closed_form_peak(p, arc, until, peak):
    """Find the largest of ``peak`` and the angles on the arc up to ``until``, if certain without a search.

    If c+ and c- are negative,

        u = 1 - m cosh(t - middle) + beta cos eta with m = 2 sqrt(c+ c-).

    This function is largest between ``middle`` and the nearest eta = 0 (mod 2 pi). Shifts by whole forcing
    periods and reflections about either time move any other time between the two, and each of them raises u.
    Let s be the time from the middle and d the phase left. Between the two times

        m sinh s - beta Omega sin(d - Omega s)

    is convex, at most 0 at first and at least 0 at last. So the maximum is the only extremum. It belongs to
    the arc if the arc reaches it. An arc that starts in the middle (a lift-off) has one of two equal maxima
    before its start.

    Returns
    -------
    tuple of (bool, float)
        Whether the result is certain.
        The largest angle.
    """
    grow, shrink, error = exponentials(p, arc)
    if not (max(grow, shrink) < 0.0 and p.forcing.frequency * error < -KNOWN * max(grow, shrink)):
        return False, peak
    m = 2.0 * math.sqrt(grow * shrink)
    middle = 0.5 * logarithm(shrink / grow)
    eta = p.forcing.frequency * middle + arc.constants.psi + (math.pi if arc.side < 0 else 0.0)
    ahead = TURN * np.floor(eta / TURN + 0.5) - eta
    if not may_rise_above(
        peak,
        m,
        abs(ahead) * p.forcing.per_frequency,
        p.forcing.frequency * p.forcing.frequency,
        p.forcing.response,
    ):
        return True, peak
    if 0.5 * TURN - abs(ahead) < TIED:
        if middle * p.forcing.frequency > KNOWN:
            return False, peak
        ahead = abs(ahead)
    other = middle + ahead * p.forcing.per_frequency
    low, high = max(min(middle, other), 0.0), min(max(middle, other), until)
    if low >= high:
        return False, peak
    acceleration = p.forcing.response * p.forcing.frequency * p.forcing.frequency
    t = min(max(middle + ahead * p.forcing.per_frequency * (acceleration / (acceleration + m)), low), high)
    for _ in range(TRIES):
        now = evaluate(p, arc, t)
        second = now.angle + harmonic_term(p, now.drive.cosine)
        if not second < 0.0:
            break
        # u' is concave: it lies below its tangent beyond the maximum, and above its chord before it.
        ahead_of = now.velocity * ahead > 0.0
        rest = now.velocity / (-second) if ahead_of else t - middle
        if now.angle + 0.5 * abs(now.velocity * rest) <= peak:
            return True, peak
        step, most, accurate = maximum_near(p, now, second)
        if accurate:
            return 0.0 < t + step < until, max(peak, within_reach(p, most))
        before, t = t, min(max(t + step, low), high)
        if t == before:
            break
    return False, peak


@body(contract.largest_on, Slender, Cosine)
def largest_on(p, arc, until, peak):
    """Return the result of ``arc_peak``, without a search if ``closed_form_peak`` is certain."""
    certain, largest = closed_form_peak(p, arc, until, peak)
    return largest if certain else arc_peak(p, arc, until, peak)


@body(contract.peak_with, Slender, Cosine, inline=True)
def peak_with(p, arc, coming, peak):
    """Return the largest of ``peak`` and the angles of an arc up to the event that ends it."""
    if coming.event == BRACE:
        return p.block.brace_angle
    if coming.event == IMPACT and not may_exceed(p, arc, coming, peak):
        return peak
    return largest_on(p, arc, coming.wait, peak)
