"""Bracket of the first zero in each lane: the signs of u at known points prove which sign interval contains it.

At the ends of the sign intervals, and halfway, cos eta is known and e^t follows by multiplication. So u = c+
e^t + c- e^-t + 1 + beta cos eta needs no elementary function. The proof is that of ``arc.bracket``.
"""

from typing import NamedTuple

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.arc import MAX_ARC_TIME
from rocking.kernels.forcing.harmonic.bracket import MARGIN, may_dip
from rocking.kernels.lanes.state import BRACKET, FAILED, GUESS, MINIMUM
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import choose


class ConvexInterval(NamedTuple):
    """Values of u on a convex sign interval: at its start, halfway and at its end, with error bounds."""

    u: float
    u_half: float
    u_right: float
    error: float
    error_right: float
    passed: bool  # it contains no zero
    doubtful: bool  # it contains zeros only if u has a minimum below zero inside


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL_INLINE)
def turn_forcing(s, i, turns):
    """Move ``end`` of lane i forward by one forcing period, if ``turns``."""
    end, z, per_z = s.end[i], s.z[i], s.per_z[i]
    s.end[i] = choose(turns, end + s.period[i], end)
    s.z[i] = choose(turns, z * s.turn_growth[i], z)
    s.per_z[i] = choose(turns, per_z * s.turn_decay[i], per_z)


@njit(**INTERNAL_INLINE)
def skip_clear_period(s, i):
    """Advance the search by one forcing period, if the next sign intervals certainly contain no zero."""
    passed = convex_interval(s, i).passed & (s.stage[i] == BRACKET)
    s.low[i] = choose(passed, s.end[i] + s.outside[i], s.low[i])
    s.cleared[i] = choose(passed, 0.0, s.cleared[i])
    turn_forcing(s, i, passed)


@njit(**INTERNAL_INLINE)
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
