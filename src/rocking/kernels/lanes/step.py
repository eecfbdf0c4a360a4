"""Pass over all lanes: every lane executes its next stage, an impact by eq. (2) or a brace impact, or a part of a search.

The compiler vectorises each short loop.
"""

import math

import numpy as np

from rocking.kernels.arc.extrema_cosine import may_rise_above
from rocking.kernels.block.impact import SLOW
from rocking.kernels.block.slender import hyperbolic_transfer
from rocking.kernels.lanes.search import (
    correct_event,
    evaluate_circular,
    evaluate_hyperbolic,
    evaluate_trial,
    guess,
    initial_guess,
    predict_event,
    skip_clear_period,
    step,
    walk,
)
from rocking.kernels.lanes.state import (
    AT_EVENT,
    BRACKET,
    CHECK_ZENO,
    END_LEG,
    FAILED,
    FIND_EVENT,
    FLUSH_LOG,
    LANES,
    LARGE,
    NEW_ARC,
    NO_REQUEST,
    SLOWEST,
    TO_SCALAR,
    UPDATE_PEAK,
    log_is_full,
)
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.tangent import brace_gain, carry_along, carry_through, impact_gain
from rocking.kernels.numerics.elementary import both_exponentials, choose, fma
from rocking.kernels.numerics.simd import ROUGHLY, logarithms_of_ratios

# Below this c+ and c- determine the maximum and its time accurately enough.
CREST_CERTAIN = -1e-5


@kernel(inline=True)
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


@kernel(inline=True)
def request_before_impact(s, i):
    """Write the request of lane i before its impact, and return whether there is one."""
    returned = s.restitution[i] * s.speed[i]
    request = choose(s.exceeds[i] == 0.0, NO_REQUEST, UPDATE_PEAK)
    request = choose((returned < SLOW) & may_settle(s, i, returned), CHECK_ZENO, request)
    return set_request(s, i, request, returned)


@kernel(inline=True)
def may_settle(s, i, returned):
    """Return whether the impact in lane i may begin chattering that ends in rest.

    ``settling_by_change`` requires this: within its time window the base acceleration changes by less than the
    difference of its size from 1.
    """
    press = 1.0 - s.amplitude[i] * abs(s.next_cosine[i])
    moved = 5.0 * returned * s.amplitude_rate[i] * abs(s.next_sine[i])
    return (press > 0.0) & (moved < press * press * (1.0 - s.restitution[i]))


@kernel(inline=True)
def next_forcing_term(s, i):
    """Return the forcing term f at the event of lane i: ``harmonic_term``."""
    return fma(-s.amplitude[i], s.next_cosine[i], -1.0)


@kernel(inline=True)
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


@kernel(inline=True)
def turn_clock(s, i):
    """Write the cycle of the event in lane i and the time within it, if it has arrived."""
    start, cycle, arrived = s.start[i], s.cycle[i], s.stage[i] == AT_EVENT
    turns = np.floor((start + s.wait[i]) * s.per_period[i])
    s.start[i] = choose(arrived, fma(-turns, s.period[i], start) + s.wait[i], start)
    s.cycle[i] = choose(arrived, cycle + turns, cycle)


@kernel(inline=True)
def carry_through_impact(s, i):
    """Propagate the tangent vector in lane i through its impact."""
    gained = impact_gain(s.restitution[i], 1.0, next_forcing_term(s, i), -1.0)
    propagate_tangent(s, i, s.restitution[i], gained / s.speed[i])


@kernel(inline=True)
def apply_impact(s, i):
    """Apply the impact in lane i, eq. (2), if it has arrived."""
    turn_clock(s, i)
    arrived = s.stage[i] == AT_EVENT
    s.side[i] = choose(arrived, -s.side[i], s.side[i])
    s.angle[i] = choose(arrived, 0.0, s.angle[i])
    s.velocity[i] = choose(arrived, s.restitution[i] * s.speed[i], s.velocity[i])
    s.cosine[i] = choose(arrived, -s.next_cosine[i], s.cosine[i])
    s.sine[i] = choose(arrived, -s.next_sine[i], s.sine[i])


@kernel(inline=True)
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


@kernel(inline=True)
def crest_may_exceed(s, i):
    """Return whether u may exceed the peak of lane i on the arc that begins."""
    away = fma(-0.5, s.inside[i] + s.twice[i], s.sign_change[i])
    away = fma(-np.floor(fma(away, s.per_period[i], 0.5)), s.period[i], away)
    away = max(abs(away) - ROUGHLY, 0.0)
    return may_rise_above(s.peak[i], s.deep[i], away, s.frequency_square[i], s.response[i])


@kernel(inline=True)
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


@kernel(inline=True)
def begin_bracket(s, i):
    """Write e^+-t at the start of the search along an arc that begins, and its stage."""
    begins = s.stage[i] >= NEW_ARC
    z, per_z = both_exponentials(s.end[i])
    s.z[i] = choose(begins, z, s.z[i])
    s.per_z[i] = choose(begins, per_z, s.per_z[i])
    s.stage[i] = choose(begins, BRACKET, s.stage[i])


@kernel(inline=True)
def request_before_event(s, i):
    """Write the request of lane i before its event, and return whether there is one."""
    at_brace, exceeds = s.at_brace[i] > 0.0, s.exceeds[i] > 0.0
    restitution = choose(at_brace, s.brace_restitution[i], s.restitution[i])
    returned = restitution * s.speed[i]
    request = choose(exceeds & (at_brace == False), UPDATE_PEAK, NO_REQUEST)  # noqa: E712
    request = choose((restitution < 1.0) & (returned < SLOW), CHECK_ZENO, request)
    return set_request(s, i, request, returned)


@kernel(inline=True)
def carry_through_event(s, i):
    """Propagate the tangent vector in lane i through its event."""
    hit, r, f = s.at_brace[i] > 0.0, s.brace_restitution[i], next_forcing_term(s, i)
    pressed, pulled = brace_gain(r, s.brace_angle[i] + f), impact_gain(s.restitution[i], 1.0, f, -1.0)
    propagate_tangent(s, i, choose(hit, -r, s.restitution[i]), choose(hit, pressed, pulled) / s.speed[i])


@kernel(inline=True)
def apply_event(s, i):
    """Apply the event in lane i if it has arrived, eq. (2) or a brace impact, and begin the next arc."""
    turn_clock(s, i)
    hit, arrived, begins = s.at_brace[i] > 0.0, s.stage[i] == AT_EVENT, s.stage[i] >= NEW_ARC
    turned = choose(hit, 1.0, -1.0)
    returned = choose(hit, -s.brace_restitution[i], s.restitution[i]) * s.speed[i]
    s.side[i] = choose(arrived, turned * s.side[i], s.side[i])
    s.angle[i] = choose(arrived, choose(hit, s.brace_angle[i], 0.0), s.angle[i])
    s.velocity[i] = choose(arrived, returned, s.velocity[i])
    s.cosine[i] = choose(arrived, turned * s.next_cosine[i], s.cosine[i])
    s.sine[i] = choose(arrived, turned * s.next_sine[i], s.sine[i])
    s.peak[i] = choose(arrived, max(s.peak[i], s.angle[i]), s.peak[i])
    s.exceeds[i] = choose(s.peak[i] < s.brace_angle[i], 1.0, 0.0)
    s.brace_hits[i] = choose(arrived & hit, s.brace_hits[i] + 1.0, s.brace_hits[i])
    s.knot_angle[i] = choose(begins, s.angle[i], s.knot_angle[i])
    s.knot_rate[i] = choose(begins, s.velocity[i], s.knot_rate[i])
    s.knot_cosine[i] = choose(begins, s.cosine[i], s.knot_cosine[i])
    s.knot_sine[i] = choose(begins, s.sine[i], s.knot_sine[i])
    s.about[i] = choose(begins, 0.0, s.about[i])
    s.tries[i] = choose(begins, 0.0, s.tries[i])
    s.stage[i] = choose(begins, BRACKET, s.stage[i])


@kernel
def apply_impacts(s):
    """Apply the impacts of all lanes that have arrived, and begin their next arcs."""
    for i in range(LANES):
        carry_through_impact(s, i)
    for i in range(LANES):
        apply_impact(s, i)
    for i in range(LANES):
        begin_exponentials(s, i)
    for i in range(LANES):
        begin_walk(s, i)
    for i in range(LANES):
        begin_bracket(s, i)


@kernel
def advance(s):
    """Advance all lanes, to their impacts if those are near enough; return whether any makes a request."""
    for i in range(LANES):
        skip_clear_period(s, i)
    for i in range(LANES):
        walk(s, i)
    for i in range(LANES):
        initial_guess(s, i)
    for i in range(LANES):
        guess(s, i)
    for i in range(LANES):
        evaluate_hyperbolic(s, i)
    for i in range(LANES):
        evaluate_circular(s, i)
    for i in range(LANES):
        evaluate_trial(s, i)
    for i in range(LANES):
        step(s, i)
    requested = False
    for i in range(LANES):
        requested |= request_before_impact(s, i)
    return requested


@kernel
def apply_events(s):
    """Apply the events of all lanes that have arrived, between braces, and begin their next arcs."""
    for i in range(LANES):
        carry_through_event(s, i)
    for i in range(LANES):
        apply_event(s, i)


@kernel
def advance_between(s):
    """Advance all lanes between braces; return whether any makes a request."""
    for i in range(LANES):
        predict_event(s, i)
    for i in range(LANES):
        evaluate_hyperbolic(s, i)
    for i in range(LANES):
        evaluate_circular(s, i)
    for i in range(LANES):
        correct_event(s, i)
    requested = False
    for i in range(LANES):
        requested |= request_before_event(s, i)
    return requested
