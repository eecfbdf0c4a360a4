"""Section of a motion: its last states, evaluated only when they are needed, the lag of close returns, and their limit.

A row holds the arc on which the state lies until the state itself is needed.
"""

import math

from rocking.kernels.contract import arc_at
from rocking.kernels.event_kinds import BRACE, FLIGHT, IMPACT
from rocking.kernels.library.kernel import kernel
from rocking.kernels.motion.observers import state_at
from rocking.kernels.motion.tangent import Tangent
from rocking.kernels.numerics.elementary import size
from rocking.kernels.orbits.floquet import multipliers

# Columns of a section row after those of ``observers.note_state``: the arc on which the state lies, and the time since
# its start.
SIDE, ANGLE, VELOCITY, ELAPSED = range(4, 8)


# Returns closer than this are the orbit itself.
ARRIVED = 1e-9
# A sequence counts as linear if it predicts its own earlier difference with this relative error or less.
LINEAR = 0.2
# States that alternate around a longer orbit follow a rotation. So the states must come closer to the limit
# by this factor per lag.
NEARER = 0.95
# If the sine of the angle between two differences is at most this, they span one direction only.
ALIGNED = 1e-5


@kernel
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


@kernel
def evaluate_lazy_rows(p, section, first, count, section_time):
    """Evaluate the states of all rows from ``first`` on that hold only their arc."""
    for k in range(max(first, 0), count):
        if math.isnan(section[k, 0]):
            side, elapsed = int(section[k, SIDE]), section[k, ELAPSED]
            start = section_time - elapsed
            arc = arc_at(p, side, 0, start, section[k, ANGLE], section[k, VELOCITY])
            section[k, 0], section[k, 1] = state_at(p, FLIGHT, arc, elapsed)


@kernel
def apart(section, first, second):
    """Return the distance of two rows."""
    return size(section[first, 0] - section[second, 0], section[first, 1] - section[second, 1])


@kernel
def closest_return(section, count, most_lag):
    """Find the closest return of the last row.

    Returns
    -------
    tuple of (int, float)
        Lag and distance.
    """
    lag, closest = 0, math.inf
    for k in range(1, min(count - 1, most_lag) + 1):
        distance = apart(section, count - 1, count - 1 - k)
        if distance < closest:
            lag, closest = k, distance
    return lag, closest


@kernel
def approached(p, section, count, section_time, most_lag):
    """Find the fixed point that the last returns approach, with the least lag.

    Near a fixed point x of the map over ``lag`` cycles the differences of returns obey one matrix, d0 = M d1,
    d1 = M d2. This gives M and x = x0 + M d0 + M M d0 + …; M must also predict d2 from d3.

    Returns
    -------
    tuple of (int, float, float)
        Lag, 0 if the returns approach no point.
        Angle and velocity of the fixed point.
    """
    last = count - 1
    for lag in range(1, most_lag + 1):
        evaluate_lazy_rows(p, section, last - 4 * lag, count - 4 * (lag - 1), section_time)
        if lag < count and apart(section, last, last - lag) <= ARRIVED:
            return lag, section[last, 0], section[last, 1]
        if 4 * lag >= count:
            continue
        found, angle, velocity = limit(section, last, lag)
        if found:
            return lag, angle, velocity
    return 0, 0.0, 0.0


@kernel
def limit(section, row, lag):
    """Extrapolate the returns of a row to their limit.

    Returns
    -------
    tuple of (bool, float, float)
        Whether the returns are linear.
        Angle and velocity of the limit.
    """
    x0, y0 = difference(section, row, lag)
    x1, y1 = difference(section, row - lag, lag)
    x2, y2 = difference(section, row - 2 * lag, lag)
    x3, y3 = difference(section, row - 3 * lag, lag)
    area = x1 * y2 - x2 * y1
    long1, long2 = x1 * x1 + y1 * y1, x2 * x2 + y2 * y2
    if area * area <= ALIGNED * ALIGNED * long1 * long2:
        # one direction only
        a = d = (x0 * x1 + y0 * y1) / long1
        b = c = 0.0
    else:
        # M (d1, d2) = (d0, d1)
        a, c = (x0 * y2 - x1 * y1) / area, (x1 * x1 - x0 * x2) / area
        b, d = (y0 * y2 - y1 * y1) / area, (y1 * x1 - y0 * x2) / area
    real, imaginary, _, _ = multipliers(Tangent(a, b, c, d))
    off = size(x2 - (a * x3 + c * y3), y2 - (b * x3 + d * y3))
    linear = off * off <= LINEAR * LINEAR * long2 and size(real, imaginary) <= NEARER
    # (I - M)^-1 M d0
    determinant = (1.0 - a) * (1.0 - d) - b * c
    x, y = a * x0 + c * y0, b * x0 + d * y0
    angle = section[row, 0] + ((1.0 - d) * x + c * y) / determinant
    velocity = section[row, 1] + (b * x + (1.0 - a) * y) / determinant
    return linear, angle, velocity


@kernel
def difference(section, row, lag):
    """Return a row less the row ``lag`` cycles before."""
    return section[row, 0] - section[row - lag, 0], section[row, 1] - section[row - lag, 1]


@kernel
def deviation_and_miss(section, row, period, found):
    """Return the deviation from an orbit one period before a row, and that at the row less its linear image."""
    before, tangent = row - period, found.image.tangent
    x, y = section[before, 0] - found.angle, section[before, 1] - found.velocity
    to_x = section[row, 0] - found.angle - (tangent.a * x + tangent.c * y)
    to_y = section[row, 1] - found.velocity - (tangent.b * x + tangent.d * y)
    return (x, y), (to_x, to_y)
