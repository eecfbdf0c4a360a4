"""What is done for one lane at a time: uncertain events, maxima of the angle, chattering, and the log of arcs.

The log holds arcs from which section states may be needed, and the arcs of an undamped motion.
"""

import math

import numpy as np

from rocking.kernels.arc.arc import MAX_ARC_TIME
from rocking.kernels.arc.extrema_cosine import largest_on
from rocking.kernels.arc.first_zero_cosine import next_event
from rocking.kernels.arc.slender_cosine import NONE_YET
from rocking.kernels.base.cosine import HarmonicDrive, clock
from rocking.kernels.block.chattering import base_settling_time, brace_settling_within
from rocking.kernels.block.impact import SLOW
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT
from rocking.kernels.lanes.state import (
    AT_EVENT,
    BRACKET,
    CHECK_ZENO,
    END_LEG,
    FAILED,
    FIND_EVENT,
    FLUSH_LOG,
    LANES,
    NO_REQUEST,
    SLOWEST,
    TO_SCALAR,
    UPDATE_PEAK,
    arc_of,
    log_is_full,
    prefetch_for_write,
)
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.march import RESYNCHRONISE
from rocking.kernels.numerics.elementary import choose


@kernel
def leg_done(s, i):
    """Return whether the coming event lies beyond the end of the leg."""
    left = (s.target[i] - s.cycle[i]) * s.period[i]
    return s.start[i] + s.wait[i] > left


@kernel
def settles(s, i, p):
    """Return whether chattering certainly follows the coming event, as in ``block.impact``."""
    hits, cosine, sine = s.at_brace[i] > 0.0, s.next_cosine[i], s.next_sine[i]
    restitution = p.block.brace_restitution if hits else p.block.restitution
    speed = restitution * s.speed[i]
    if not (restitution < 1.0 and speed < SLOW):
        return False
    if hits:
        return brace_settling_within(p, int(s.side[i]), HarmonicDrive(cosine, sine), speed) <= MAX_ARC_TIME
    return base_settling_time(p, 1, HarmonicDrive(-cosine, -sine), speed, math.inf) <= MAX_ARC_TIME


@kernel
def request_at_event(s, i, p):
    """Return the request of a lane that may have arrived: the end of its leg, a march alone, or nothing."""
    if s.stage[i] != AT_EVENT:
        return NO_REQUEST
    return END_LEG if leg_done(s, i) else TO_SCALAR if settles(s, i, p) else NO_REQUEST


@kernel
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


@kernel(inline=True)
def resolve_alone(s, i, p):
    """Fulfil the requests that need the functions for one block, and return the request that is left."""
    if s.request[i] == FIND_EVENT:
        return find_event(s, i, p)
    return request_at_event(s, i, p) if s.request[i] == CHECK_ZENO else s.request[i]


@kernel(inline=True)
def request_of_leg(s, i, p):
    """Return the request of a lane at the start of its leg, where a newly loaded block may need its first event."""
    return find_event(s, i, p) if s.stage[i] == FAILED else request_at_event(s, i, p)


@kernel(inline=True)
def update_peak(s, i, p):
    """Update the largest angle up to the coming impact, if the arc may exceed it."""
    if s.stage[i] == AT_EVENT and s.exceeds[i] > 0.0:
        s.peak[i] = largest_on(p, arc_of(s, i, p), s.wait[i], s.peak[i])


# A 64-byte cache line holds four entries; the prefetch is two lines ahead.
AHEAD = 8


@kernel(inline=True)
def mark_pending(s, i, most):
    """Compute the log slot of a lane (-1: none), the squared impact speed, and whether ``log_arc`` is due.

    It is due in the first pass of an arc, in the stage BRACKET.
    """
    slot, rounds = s.events[i] - s.uncollected[i] - 1.0, s.events[i] * (1.0 / (RESYNCHRONISE + 1))
    kept = (s.events[i] > s.counted[i]) & (slot >= 0.0) & (slot < most)
    # at regular numbers of events as in ``log_arc``, exactly: RESYNCHRONISE + 1 is a power of two
    due = ((s.log_on[i] > 0.0) | (np.floor(rounds) == rounds)) & (s.stage[i] == BRACKET)
    s.slot[i] = choose(kept, slot, -1.0)
    s.square[i] = s.velocity[i] * s.velocity[i]
    s.due[i] = choose(due, 1.0, 0.0)


@kernel(inline=True)
def log_arc(s, i, log):
    """Write the present arc into the log of a lane, if that is kept.

    At regular numbers of events compute the forcing from the clock.
    """
    events, start, side, angle = int(s.events[i]), s.start[i], s.side[i], s.angle[i]
    if s.log_on[i] > 0.0:
        row = log[i, events - int(s.counted[i])]
        row.cycle = s.cycle[i]
        row.time = start
        row.event = BRACE if angle > 0.0 else IMPACT
        row.mode = FLIGHT
        row.side = side
        row.angle = angle
        row.velocity = s.velocity[i]
    if events & RESYNCHRONISE == 0:
        s.cosine[i], s.sine[i], _, _, _ = clock(s.frequency[i], s.phase[i], side, start)


@kernel
def log_arcs(s, flights, log):
    """Write the last arc of each undamped lane: its duration and squared speed; and ``log_arc`` if due.

    The entry is written again at every pass until the next impact.
    """
    for i in range(LANES):
        mark_pending(s, i, flights.shape[1])
    for i in range(LANES):
        slot = int(s.slot[i])
        if slot >= 0:
            flights[i, slot, 0], flights[i, slot, 1] = s.wait[i], s.square[i]
            # Hardware prefetchers do not predict the addresses of this many write streams.
            prefetch_for_write(
                flights.ctypes.data + flights.itemsize * 2 * (i * flights.shape[1] + slot + AHEAD)
            )
        if s.due[i] > 0.0:
            log_arc(s, i, log)
