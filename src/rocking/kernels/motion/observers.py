"""What is recorded of a motion: sections, events, dense output and extrema."""

import math
from typing import Annotated

import numpy as np

from rocking.kernels.arc.arc import CROSSING, first_turn_sign, next_turn, within_reach
from rocking.kernels.contract import acceleration, arc_at, evaluate, evaluate_onward, place_at_start
from rocking.kernels.event_kinds import FLIGHT, LEAN, LEANS, REST, RESTS
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.signature import Floats1, Floats2, Integers1
from rocking.kernels.system import SystemParameters

# An event: its cycle and the time within it; its kind; mode, side, u and u' of the arc that follows; Theta'
# just before.
NAMES = "cycle", "time", "event", "mode", "side", "angle", "velocity", "before"
EVENT_ROW = np.dtype([(name, np.float64) for name in NAMES], align=True)
EventRows = Annotated[np.ndarray, EVENT_ROW, 1]


@kernel
def state_at(p, mode, arc, t):
    """Return Theta and Theta' a time t into an arc, a rest or a contact with a brace."""
    if mode == REST:
        return 0.0, 0.0
    if mode == LEAN:
        return arc.side * p.block.brace_angle, 0.0
    now = evaluate(p, arc, t)
    return arc.side * within_reach(p, now.angle), arc.side * now.velocity


@kernel
def note_state(p, row, progress, t):
    """Write a row of the section, a time t into an arc, a rest or a contact with a brace."""
    row[0], row[1] = state_at(p, progress.mode, progress.arc, t)
    if row.shape[0] > 2:
        row[2], row[3] = progress.impacts, progress.brace_hits


@kernel
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


@kernel
def note_event(events, count, progress, event, before):
    """Write an event, and any rest or sustained contact that begins with it; return the number of events."""
    count = note(events, count, progress, event, before)
    if progress.mode == FLIGHT:
        return count
    return note(events, count, progress, RESTS if progress.mode == REST else LEANS, 0.0)


@kernel
def arc_of(p, row):
    """Return the arc that starts with an event row (``observers.note``)."""
    return arc_at(p, int(row.side), int(row.cycle), row.time, row.angle, row.velocity)


@entry_point
def sample(p: SystemParameters, rows: EventRows, index: Integers1, elapsed: Floats1, out: Floats2) -> None:
    """Write (Theta, Theta', Theta'') into ``out`` (n, 3) at given times.

    Row k is taken a time ``elapsed[k]`` after the event of row ``index[k]``. Ascending times of one arc take the least work.
    """
    if index.shape[0] == 0:
        return
    arc = arc_of(p, rows[index[0]])
    place = place_at_start(p, arc)
    for k in range(index.shape[0]):
        row = rows[index[k]]
        side = row.side
        out[k, 0], out[k, 1], out[k, 2] = side * row.angle, 0.0, 0.0
        if row.mode == FLIGHT:
            if k > 0 and (index[k] != index[k - 1] or elapsed[k] < elapsed[k - 1]):
                arc = arc_of(p, row)
                place = place_at_start(p, arc)
            now, place = evaluate_onward(p, arc, place, elapsed[k])
            out[k, 0] = side * within_reach(p, now.angle)
            out[k, 1] = side * now.velocity
            out[k, 2] = side * acceleration(p, arc.side, now.angle, now.drive)
            if not math.isfinite(now.angle):  # overturned long before: the angle has overflowed
                out[k, :] = side * math.inf


@entry_point
def turns(p: SystemParameters, rows: EventRows, until: Floats1, out: Floats2) -> int:
    """Write (row, time into its arc, Theta) of every local extremum of the angle.

    ``until[k]`` is the duration of the arc of row k. Returns the number of extrema, including those for which
    ``out`` has no row.
    """
    count = 0
    for k in range(rows.shape[0]):
        if rows[k].mode != FLIGHT:
            continue
        arc = arc_of(p, rows[k])
        sign = first_turn_sign(p, arc)
        t = 0.0
        while True:
            found, t, now = next_turn(p, arc, sign, t, until[k])
            if found != CROSSING:
                break
            if count < out.shape[0]:
                out[count, 0], out[count, 1], out[count, 2] = k, t, arc.side * now.angle
            count += 1
            sign = -sign
    return count
