"""Row layout of sections and events, and the functions that write rows."""

from typing import Annotated

import numpy as np

from rocking.kernels.compile_options import INTERNAL
from rocking.kernels.deferred import njit
from rocking.kernels.event_kinds import FLIGHT, LEAN, LEANS, REST, RESTS
from rocking.kernels.forcing.arc import within_reach
from rocking.kernels.forcing.contract import evaluate

# An event: its cycle and the time within it; its kind; mode, side, u and u' of the arc that follows; Theta'
# just before.
NAMES = "cycle", "time", "event", "mode", "side", "angle", "velocity", "before"
EVENT_ROW = np.dtype([(name, np.float64) for name in NAMES], align=True)
EventRows = Annotated[np.ndarray, EVENT_ROW, 1]


@njit(**INTERNAL)
def state_at(p, mode, arc, t):
    """Return Theta and Theta' a time t into an arc, a rest or a contact with a brace."""
    if mode == REST:
        return 0.0, 0.0
    if mode == LEAN:
        return arc.side * p.block.brace_angle, 0.0
    now = evaluate(p, arc, t)
    return arc.side * within_reach(p, now.angle), arc.side * now.velocity


@njit(**INTERNAL)
def note_state(p, row, progress, t):
    """Write a row of the section, a time t into an arc, a rest or a contact with a brace."""
    row[0], row[1] = state_at(p, progress.mode, progress.arc, t)
    if row.shape[0] > 2:
        row[2], row[3] = progress.impacts, progress.brace_hits


@njit(**INTERNAL)
def note(events, count, progress, event, before):
    """Write one event, with the arc after it and the velocity before it; return the number of events."""
    row, arc = events[count], progress.arc
    row.cycle = progress.cycle
    row.time = arc.start
    row.event = event
    row.mode = progress.mode
    row.side = arc.side
    row.angle = arc.angle
    row.velocity = arc.velocity
    row.before = before
    return count + 1


@njit(**INTERNAL)
def note_event(events, count, progress, event, before):
    """Write an event, and any rest or sustained contact that begins with it; return the number of events."""
    count = note(events, count, progress, event, before)
    if progress.mode == FLIGHT:
        return count
    return note(events, count, progress, RESTS if progress.mode == REST else LEANS, 0.0)
