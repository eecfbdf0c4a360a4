"""Requests before events between braces, and the events themselves: eq. (2) and the impact on a brace."""

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.lanes.impact import next_forcing_term, propagate_tangent, set_request, turn_clock
from rocking.kernels.lanes.state import AT_EVENT, BRACKET, CHECK_ZENO, NEW_ARC, NO_REQUEST, UPDATE_PEAK
from rocking.kernels.march.impact_law import SLOW
from rocking.kernels.march.tangent import brace_gain, impact_gain
from rocking.kernels.numerics.simd import choose


@njit(**INTERNAL_INLINE)
def request_before_event(s, i):
    """Write the request of lane i before its event, and return whether there is one."""
    at_brace, exceeds = s.at_brace[i] > 0.0, s.exceeds[i] > 0.0
    restitution = choose(at_brace, s.brace_restitution[i], s.restitution[i])
    returned = restitution * s.speed[i]
    request = choose(exceeds & (at_brace == False), UPDATE_PEAK, NO_REQUEST)  # noqa: E712
    request = choose((restitution < 1.0) & (returned < SLOW), CHECK_ZENO, request)
    return set_request(s, i, request, returned)


@njit(**INTERNAL_INLINE)
def carry_through_event(s, i):
    """Propagate the tangent vector in lane i through its event."""
    hit, r, f = s.at_brace[i] > 0.0, s.brace_restitution[i], next_forcing_term(s, i)
    pressed, pulled = brace_gain(r, s.brace_angle[i] + f), impact_gain(s.restitution[i], 1.0, f, -1.0)
    propagate_tangent(s, i, choose(hit, -r, s.restitution[i]), choose(hit, pressed, pulled) / s.speed[i])


@njit(**INTERNAL_INLINE)
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
