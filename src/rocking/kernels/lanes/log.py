"""Log of each lane: arcs from which section states may be needed, and the arcs of an undamped motion."""

import numpy as np

from rocking.kernels.compile_options import INTERNAL, INTERNAL_INLINE
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT
from rocking.kernels.forcing.harmonic.acceleration import clock
from rocking.kernels.lanes.state import BRACKET, LANES
from rocking.kernels.lanes.workspace import prefetch_for_write
from rocking.kernels.march.march import RESYNCHRONISE
from rocking.kernels.numerics.simd import choose

# A 64-byte cache line holds four entries; the prefetch is two lines ahead.
AHEAD = 8


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL_INLINE)
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


@njit(**INTERNAL)
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
