"""Impact that ends the arc of each lane, eq. (2), the arc that follows, and the requests before it."""

import math

import numpy as np

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.forcing.harmonic.extrema import may_rise_above
from rocking.kernels.forcing.slender import hyperbolic_transfer
from rocking.kernels.lanes.state import (
    AT_EVENT,
    BRACKET,
    CHECK_ZENO,
    END_LEG,
    FAILED,
    FIND_EVENT,
    FLUSH_LOG,
    LARGE,
    NEW_ARC,
    NO_REQUEST,
    SLOWEST,
    TO_SCALAR,
    UPDATE_PEAK,
    log_is_full,
)
from rocking.kernels.march.impact_law import SLOW
from rocking.kernels.march.tangent import carry_along, carry_through, impact_gain
from rocking.kernels.numerics.elementary import fma
from rocking.kernels.numerics.simd import ROUGHLY, both_exponentials, choose, logarithms_of_ratios

# Below this c+ and c- determine the maximum and its time accurately enough.
CREST_CERTAIN = -1e-5


@njit(**INTERNAL_INLINE)
def set_request(s, i, request, returned):
    """Set the service request of lane i before its event; the condition with the highest priority wins.

    ``returned`` is the speed after the event. Returns whether a request is pending.
    """
    request = choose(log_is_full(s, i), FLUSH_LOG, request)
    request = choose(returned < SLOWEST, TO_SCALAR, request)
    beyond = s.start[i] + s.wait[i] > (s.target[i] - s.cycle[i]) * s.period[i]
    request = choose(beyond, END_LEG, request)
    failed = choose(s.stage[i] == FAILED, FIND_EVENT, NO_REQUEST)
    request = choose(s.stage[i] == AT_EVENT, request, failed)
    s.request[i] = request
    return request != NO_REQUEST


@njit(**INTERNAL_INLINE)
def request_before_impact(s, i):
    """Write the request of lane i before its impact, and return whether there is one."""
    returned = s.restitution[i] * s.speed[i]
    request = choose(s.exceeds[i] == 0.0, NO_REQUEST, UPDATE_PEAK)
    request = choose((returned < SLOW) & may_settle(s, i, returned), CHECK_ZENO, request)
    return set_request(s, i, request, returned)


@njit(**INTERNAL_INLINE)
def may_settle(s, i, returned):
    """Return whether the impact in lane i may begin chattering that ends in rest.

    ``settling.settling_by_change`` requires this: within its time window the base acceleration changes by less than the
    difference of its size from 1.
    """
    press = 1.0 - s.amplitude[i] * abs(s.next_cosine[i])
    moved = 5.0 * returned * s.amplitude_rate[i] * abs(s.next_sine[i])
    return (press > 0.0) & (moved < press * press * (1.0 - s.restitution[i]))


@njit(**INTERNAL_INLINE)
def next_forcing_term(s, i):
    """Return the forcing term f at the event of lane i: ``harmonic.forcing_term``."""
    return fma(-s.amplitude[i], s.next_cosine[i], -1.0)


@njit(**INTERNAL_INLINE)
def propagate_tangent(s, i, factor, shear):
    """Propagate the tangent vector in lane i along the arc and through its event, if that has arrived.

    The saltation matrix is [[factor, 0], [shear, factor]].
    """
    angle, velocity, arrived = s.delta_angle[i], s.delta_velocity[i], s.stage[i] == AT_EVENT
    moved = hyperbolic_transfer(s.next_sinh[i], s.next_versinh[i])
    ahead = carry_along((angle, velocity), moved)
    a, b = carry_through(ahead, factor, shear, factor)
    size = abs(a) + abs(b)
    large, little = size > LARGE, size < 1.0 / LARGE
    scale = choose(large, 1.0 / LARGE, choose(little, LARGE, 1.0))
    times = choose(large, 64.0, choose(little, -64.0, 0.0))
    s.delta_angle[i] = choose(arrived, a * scale, angle)
    s.delta_velocity[i] = choose(arrived, b * scale, velocity)
    s.doublings[i] = choose(arrived, s.doublings[i] + times, s.doublings[i])
    s.events[i] = choose(arrived, s.events[i] + 1.0, s.events[i])


@njit(**INTERNAL_INLINE)
def turn_clock(s, i):
    """Write the cycle of the event in lane i and the time within it, if it has arrived."""
    start, cycle, arrived = s.start[i], s.cycle[i], s.stage[i] == AT_EVENT
    turns = np.floor((start + s.wait[i]) * s.per_period[i])
    s.start[i] = choose(arrived, fma(-turns, s.period[i], start) + s.wait[i], start)
    s.cycle[i] = choose(arrived, cycle + turns, cycle)


@njit(**INTERNAL_INLINE)
def carry_through_impact(s, i):
    """Propagate the tangent vector in lane i through its impact."""
    gained = impact_gain(s.restitution[i], 1.0, next_forcing_term(s, i), -1.0)
    propagate_tangent(s, i, s.restitution[i], gained / s.speed[i])


@njit(**INTERNAL_INLINE)
def apply_impact(s, i):
    """Apply the impact in lane i, eq. (2), if it has arrived."""
    turn_clock(s, i)
    arrived = s.stage[i] == AT_EVENT
    s.side[i] = choose(arrived, -s.side[i], s.side[i])
    s.angle[i] = choose(arrived, 0.0, s.angle[i])
    s.velocity[i] = choose(arrived, s.restitution[i] * s.speed[i], s.velocity[i])
    s.cosine[i] = choose(arrived, -s.next_cosine[i], s.cosine[i])
    s.sine[i] = choose(arrived, -s.next_sine[i], s.sine[i])


@njit(**INTERNAL_INLINE)
def begin_exponentials(s, i):
    """Write c+ and c- of an arc that begins, and bounds of the time in which u is positive.

    If c+ and c- are negative, u lies within beta of 1 - m cosh(t - middle), m = 2 sqrt(c+ c-). It is above 0
    between the roots of c+ z + 1 - beta + c-/z in z = e^t.
    """
    begins, q = s.stage[i] >= NEW_ARC, 1.0 - s.response[i]
    mean = fma(-s.response[i], s.cosine[i], -1.0)
    half = fma(s.response_rate[i], s.sine[i], s.velocity[i])
    # 2 c+ and 2 c-
    grow, shrink = mean + half, mean - half
    m, root = math.sqrt(grow * shrink), math.sqrt(fma(q, q, -grow * shrink))
    late, twice = logarithms_of_ratios(q + root, -grow, -shrink, -grow)
    to_sign_change = choose(s.side[i] > 0.0, s.sign_change_right[i], s.sign_change_left[i]) - s.start[i]
    s.growing[i] = choose(begins, 0.5 * grow, s.growing[i])
    s.shrinking[i] = choose(begins, 0.5 * shrink, s.shrinking[i])
    s.deep[i] = m
    s.twice[i] = twice
    s.late[i] = choose(q > m, late, -math.inf)
    s.sign_change[i] = fma(-np.floor(to_sign_change * s.per_period[i]), s.period[i], to_sign_change)


@njit(**INTERNAL_INLINE)
def crest_may_exceed(s, i):
    """Return whether u may exceed the peak of lane i on the arc that begins."""
    away = fma(-0.5, s.inside[i] + s.twice[i], s.sign_change[i])
    away = fma(-np.floor(fma(away, s.per_period[i], 0.5)), s.period[i], away)
    away = max(abs(away) - ROUGHLY, 0.0)
    return may_rise_above(s.peak[i], s.deep[i], away, s.frequency_square[i], s.response[i])


@njit(**INTERNAL_INLINE)
def begin_walk(s, i):
    """Write the start of the search along an arc that begins.

    Whole forcing periods between the roots of the exponentials are skipped.
    """
    sign_change, late, begins = s.sign_change[i], s.late[i], s.stage[i] >= NEW_ARC
    has_crest = max(s.growing[i], s.shrinking[i]) < CREST_CERTAIN
    certain = has_crest & (crest_may_exceed(s, i) == False)  # noqa: E712
    early, late = s.twice[i] - late + 2.0 * ROUGHLY, late - 2.0 * ROUGHLY
    leaps = has_crest & (sign_change > early) & (sign_change < late)
    turns = choose(leaps, np.floor((late - sign_change) * s.per_period[i]), 0.0)
    sign_change = fma(turns, s.period[i], sign_change)
    s.exceeds[i] = choose(begins, choose(certain, 0.0, 1.0), s.exceeds[i])
    s.low[i] = choose(begins, max(sign_change - s.inside[i], 0.0), s.low[i])
    s.end[i] = choose(begins, sign_change, s.end[i])


@njit(**INTERNAL_INLINE)
def begin_bracket(s, i):
    """Write e^+-t at the start of the search along an arc that begins, and its stage."""
    begins = s.stage[i] >= NEW_ARC
    z, per_z = both_exponentials(s.end[i])
    s.z[i] = choose(begins, z, s.z[i])
    s.per_z[i] = choose(begins, per_z, s.per_z[i])
    s.stage[i] = choose(begins, BRACKET, s.stage[i])
