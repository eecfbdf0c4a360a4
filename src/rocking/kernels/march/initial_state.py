"""March at its initial state, just after any event there."""

import math

from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.event_kinds import BRACE, FLIGHT, LEAN, NONE, REST
from rocking.kernels.forcing.contract import arc_at, side_to_lift, stays_leaning
from rocking.kernels.forcing.parameters import SystemParameters
from rocking.kernels.march.event_rows import EventRows, note, note_event
from rocking.kernels.march.progress import Progress

# No guesses of the first two times between events.
UNKNOWN = (0.0, 0.0)


@njit(**INTERNAL)
def begin(p, angle, velocity, waits, start=0.0):
    """Start a march just after any event at the time ``start`` within its first cycle.

    ``waits`` guesses the time to the first event and the time from there to the second.

    Returns
    -------
    tuple of (Progress, bool)
        The march at its start.
        Whether a brace was hit there.
    """
    side = 1 if angle > 0.0 or (angle == 0.0 and velocity > 0.0) else -1
    hit = abs(angle) == p.block.brace_angle and side * velocity > 0.0
    u, v = abs(angle), side * velocity
    if hit:
        v = -p.block.brace_restitution * v
    mode = FLIGHT
    arc = arc_at(p, side, 0, start, u, v)
    if u == 0.0 and v == 0.0:
        lifting = side_to_lift(p, arc.start, arc.drive)
        mode = REST if lifting == 0 else FLIGHT
        arc = arc_at(p, side if lifting == 0 else lifting, 0, start, 0.0, 0.0)
    elif u == p.block.brace_angle and v == 0.0 and stays_leaning(p, arc):
        mode = LEAN
    return Progress(
        mode=mode,
        cycle=0,
        arc=arc,
        pending=True,
        crowd=0,
        impacts=0,
        brace_hits=1 if hit else 0,
        peak=u,
        no_return=math.inf,
        last_wait=waits[1],
        wait_before=waits[0],
        strain=-math.inf,
    ), hit


@entry_point(**KERNEL)
def begin_march(p: SystemParameters, angle: float, velocity: float) -> tuple[Progress, bool]:
    """Begin a march as ``begin`` does, without guesses of the first two waits."""
    return begin(p, angle, velocity, UNKNOWN)


@entry_point(**KERNEL)
def note_start(events: EventRows, progress: Progress, hit: bool, velocity: float) -> int:
    """Write the first rows of a motion: its first arc, after a brace impact if it starts with one.

    Returns the number of events written. A sustained contact with the brace at the start is a second event.
    """
    if hit:
        return note_event(events, 0, progress, BRACE, velocity)
    return note(events, 0, progress, NONE, velocity)
