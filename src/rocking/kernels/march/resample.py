"""Dense output and extrema of a recorded motion, from the arcs of its event rows."""

import math

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.event_kinds import FLIGHT
from rocking.kernels.forcing.arc import CROSSING, within_reach
from rocking.kernels.forcing.contract import acceleration, arc_at, evaluate, next_turn
from rocking.kernels.forcing.extrema import first_turn_sign
from rocking.kernels.forcing.parameters import SystemParameters
from rocking.kernels.march.event_rows import EventRows
from rocking.kernels.signature import Floats1, Floats2, Integers1


@njit(**INTERNAL)
def arc_of(p, row):
    """Return the arc that starts with an event row (``event_rows.note``)."""
    return arc_at(p, int(row.side), int(row.cycle), row.time, row.angle, row.velocity)


@entry_point(**KERNEL)
def sample(p: SystemParameters, rows: EventRows, index: Integers1, elapsed: Floats1, out: Floats2) -> None:
    """Write (Theta, Theta', Theta'') into ``out`` (n, 3) at given times.

    Row k is taken a time ``elapsed[k]`` after the event of row ``index[k]``.
    """
    for k in range(index.shape[0]):
        row = rows[index[k]]
        side = row.side
        out[k, 0], out[k, 1], out[k, 2] = side * row.angle, 0.0, 0.0
        if row.mode == FLIGHT:
            arc = arc_of(p, row)
            now = evaluate(p, arc, elapsed[k])
            out[k, 0] = side * within_reach(p, now.angle)
            out[k, 1] = side * now.velocity
            out[k, 2] = side * acceleration(p, arc.side, now.angle, now.drive)
            if not math.isfinite(now.angle):  # overturned long before: the angle has overflowed
                out[k, :] = side * math.inf


@entry_point(**KERNEL)
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
