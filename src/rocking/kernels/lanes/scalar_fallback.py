"""Scalar fallback of a lane, by the functions for one block: uncertain events, maxima of the angle, chattering."""

import math

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT
from rocking.kernels.forcing.arc import MAX_ARC_TIME
from rocking.kernels.forcing.drives import HarmonicDrive
from rocking.kernels.forcing.harmonic.extrema import largest_on
from rocking.kernels.forcing.harmonic.next_event import next_event
from rocking.kernels.forcing.harmonic.solution import NONE_YET
from rocking.kernels.lanes.state import (
    AT_EVENT,
    CHECK_ZENO,
    END_LEG,
    FAILED,
    FIND_EVENT,
    FLUSH_LOG,
    NO_REQUEST,
    SLOWEST,
    TO_SCALAR,
    UPDATE_PEAK,
    log_is_full,
)
from rocking.kernels.lanes.transfer import arc_of
from rocking.kernels.march.chatter import base_settling_time, brace_settling_time
from rocking.kernels.march.impact_law import SLOW


@njit(**INTERNAL)
def leg_done(s, i):
    """Return whether the coming event lies beyond the end of the leg."""
    left = (s.target[i] - s.cycle[i]) * s.period[i]
    return s.start[i] + s.wait[i] > left


@njit(**INTERNAL)
def settles(s, i, p):
    """Return whether chattering certainly follows the coming event, as in ``impact_law``."""
    hits, cosine, sine = s.at_brace[i] > 0.0, s.next_cosine[i], s.next_sine[i]
    restitution = p.block.brace_restitution if hits else p.block.restitution
    speed = restitution * s.speed[i]
    if not (restitution < 1.0 and speed < SLOW):
        return False
    if hits:
        return brace_settling_time(p, int(s.side[i]), HarmonicDrive(cosine, sine), speed) <= MAX_ARC_TIME
    return base_settling_time(p, HarmonicDrive(-cosine, -sine), speed, math.inf) <= MAX_ARC_TIME


@njit(**INTERNAL)
def request_at_event(s, i, p):
    """Return the request of a lane that may have arrived: the end of its leg, a march alone, or nothing."""
    if s.stage[i] != AT_EVENT:
        return NO_REQUEST
    return END_LEG if leg_done(s, i) else TO_SCALAR if settles(s, i, p) else NO_REQUEST


@njit(**INTERNAL)
def find_event(s, i, p):
    """Find the coming event that a lane could not determine with certainty; return the next request of the lane."""
    coming, _ = next_event(p, FLIGHT, arc_of(s, i, p), NONE_YET)
    hits, speed = coming.event == BRACE, abs(coming.velocity)
    returned = (p.block.brace_restitution if hits else p.block.restitution) * speed
    if not ((hits or coming.event == IMPACT) and returned >= SLOWEST):
        return TO_SCALAR
    s.wait[i] = coming.wait
    s.speed[i] = speed
    s.at_brace[i] = hits
    s.next_cosine[i] = coming.drive.cosine
    s.next_sine[i] = coming.drive.sine
    s.next_sinh[i] = coming.sinh
    s.next_versinh[i] = coming.versinh
    s.stage[i] = AT_EVENT
    request = request_at_event(s, i, p)
    if request != NO_REQUEST:
        return request
    return FLUSH_LOG if log_is_full(s, i) else UPDATE_PEAK


@njit(**INTERNAL_INLINE)
def resolve_alone(s, i, p):
    """Fulfil the requests that need the functions for one block, and return the request that is left."""
    if s.request[i] == FIND_EVENT:
        return find_event(s, i, p)
    return request_at_event(s, i, p) if s.request[i] == CHECK_ZENO else s.request[i]


@njit(**INTERNAL_INLINE)
def request_of_leg(s, i, p):
    """Return the request of a lane at the start of its leg, where a newly loaded block may need its first event."""
    return find_event(s, i, p) if s.stage[i] == FAILED else request_at_event(s, i, p)


@njit(**INTERNAL_INLINE)
def update_peak(s, i, p):
    """Update the largest angle up to the coming impact, if the arc may exceed it."""
    if s.stage[i] == AT_EVENT and s.exceeds[i] > 0.0:
        s.peak[i] = largest_on(p, arc_of(s, i, p), s.wait[i], s.peak[i])
