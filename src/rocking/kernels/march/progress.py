"""Progress of a march, and the recording of it."""

from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.arc.solution import Arc
from rocking.kernels.compile_options import KERNEL_INLINE
from rocking.kernels.march.event_rows import EVENT_ROW
from rocking.kernels.numerics.replace_fields import replacing


class Progress(NamedTuple):
    """State of a march: mode, clock, arc and the numbers of events so far."""

    mode: int
    cycle: int
    arc: Arc
    pending: bool  # the section of this cycle is still ahead
    crowd: int  # events in this cycle
    impacts: int
    brace_hits: int
    peak: float
    no_return: float  # time within the cycle at which overturning was proved; infinite before
    # Guesses of two times between events: how long the last arc took, and how long the present arc takes from
    # its entry. The second is usually that of the last arc on the same side. 0 if unknown.
    last_wait: float
    wait_before: float
    strain: float  # logarithm of the tangent growth at the last start of rest or brace contact


class Recording(NamedTuple):
    """Recording of a march; arrays without rows record nothing."""

    section_time: float = 0.0  # within each cycle
    # (n, 2): states at that time, just after any event there, in order and up to the proof of overturning.
    # (n, 4): with the numbers of impacts and brace impacts so far.
    section: np.ndarray = np.empty((0, 2))
    events: np.ndarray = np.empty(0, EVENT_ROW)  # one row per event
    peak: bool = False
    releases: bool = False  # stop after each lift-off and each departure from a brace


with_clock = replacing(Progress, "cycle", "arc", "pending", "crowd", "no_return")
with_arc = replacing(Progress, "arc")
with_pending = replacing(Progress, "pending")
with_no_return = replacing(Progress, "no_return")
with_peak = replacing(Progress, "peak")
with_strain = replacing(Progress, "strain")
with_waits = replacing(Progress, "last_wait", "wait_before")


@njit(**KERNEL_INLINE)
def to_tuple(progress):
    """Return a progress as nested tuples, for Python.

    A named tuple is created by a call of its class. An interrupt (Ctrl-C) during that call, on the return
    from compiled code, would end the whole process.
    """
    arc = progress.arc
    return (
        progress.mode,
        progress.cycle,
        (arc.side, arc.start, arc.angle, arc.velocity, arc.cosine, arc.sine, arc.psi, arc.acceleration),
        progress.pending,
        progress.crowd,
        progress.impacts,
        progress.brace_hits,
        progress.peak,
        progress.no_return,
        progress.last_wait,
        progress.wait_before,
        progress.strain,
    )


def from_tuple(fields):
    """Return the progress that ``to_tuple`` converted."""
    return Progress(*fields[:2], Arc(*fields[2]), *fields[3:])
