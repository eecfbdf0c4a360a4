"""What a recorded motion was at any time, and where it turned: read from the arcs that its events began."""

import math

from numba import njit

from rocking.kernels.arc.extrema import first_turn_sign, next_turn
from rocking.kernels.arc.first_zero import CROSSING
from rocking.kernels.arc.solution import arc_from, evaluate, within_reach
from rocking.kernels.compile_options import ENTRY_POINT, INTERNAL
from rocking.kernels.event_kinds import FLIGHT
from rocking.kernels.forcing.harmonic import forcing_term


@njit(**INTERNAL)
def arc_of(p, row):
    """The arc that an event row (``event_rows.note``) began."""
    return arc_from(p, int(row.side), row.time, row.angle, row.velocity)


@njit(**ENTRY_POINT)
def sample(p, rows, index, elapsed, out):
    """Write (Theta, Theta', Theta'') into ``out`` (n, 3), a time ``elapsed[k]`` into the arc, rest or lean of row ``index[k]``."""
    for k in range(index.shape[0]):
        row = rows[index[k]]
        side = row.side
        out[k, 0], out[k, 1], out[k, 2] = side * row.angle, 0.0, 0.0
        if row.mode == FLIGHT:
            now = evaluate(p, arc_of(p, row), elapsed[k])
            out[k, 0] = side * within_reach(p, now.angle)
            out[k, 1] = side * now.velocity
            out[k, 2] = side * (now.angle + forcing_term(p, now.cosine))
            if not math.isfinite(now.angle):  # overturned long ago, beyond all numbers
                out[k, :] = side * math.inf


@njit(**ENTRY_POINT)
def turns(p, rows, until, out):
    """Write (row, time into its arc, Theta) of every local extreme of the flights.

    Returns how many there are, written or not; ``until[k]`` is how long row k's arc lasts.
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
