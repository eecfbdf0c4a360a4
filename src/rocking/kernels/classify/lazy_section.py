"""Section of a motion whose states are evaluated from their arcs only when they are needed."""

import math

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT
from rocking.kernels.forcing.contract import arc_at
from rocking.kernels.march.event_rows import state_at

# Columns of a section row after those of ``note_state``: the arc on which the state lies, and the time since
# its start.
SIDE, ANGLE, VELOCITY, ELAPSED = range(4, 8)


@njit(**INTERNAL)
def append_lazy_rows(p, before, events, written, after, section_time, section, count):
    """Add the instants from ``before`` to ``after`` to the ``count`` rows of ``section`` (n, 8).

    Each row holds (side, angle, velocity) at the start of its arc and the time since then. Few of the states
    themselves are ever needed (``evaluate_lazy_rows``). Returns the number of rows.
    """
    mode, arc = before.mode, before.arc
    side, start, angle, velocity, begun = float(arc.side), arc.start, arc.angle, arc.velocity, before.cycle
    impacts, brace_hits, due = before.impacts, before.brace_hits, before.cycle + (not before.pending)
    for k in range(written + 1):
        if k < written:
            cycle, time = int(events[k].cycle), events[k].time
            until = cycle + (section_time < time)
        else:
            cycle, time, until = after.cycle, 0.0, after.cycle + (not after.pending)
        while due < until:
            section[count, 0] = math.nan if mode == FLIGHT else side * angle
            section[count, 1], section[count, 2], section[count, 3] = 0.0, impacts, brace_hits
            section[count, SIDE], section[count, ANGLE], section[count, VELOCITY] = side, angle, velocity
            section[count, ELAPSED] = (due - begun) * p.forcing.period + (section_time - start)
            count, due = count + 1, due + 1
        if k < written:
            impacts += events[k].event == IMPACT
            brace_hits += events[k].event == BRACE
            begun, start, mode = cycle, time, int(events[k].mode)
            side, angle, velocity = events[k].side, events[k].angle, events[k].velocity
    return count


@njit(**INTERNAL)
def evaluate_lazy_rows(p, section, first, count, section_time):
    """Evaluate the states of all rows from ``first`` on that hold only their arc."""
    for k in range(max(first, 0), count):
        if math.isnan(section[k, 0]):
            side, elapsed = int(section[k, SIDE]), section[k, ELAPSED]
            start = section_time - elapsed
            arc = arc_at(p, side, 0, start, section[k, ANGLE], section[k, VELOCITY])
            section[k, 0], section[k, 1] = state_at(p, FLIGHT, arc, elapsed)
