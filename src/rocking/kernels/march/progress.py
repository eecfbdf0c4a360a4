"""A block under way, and what a march records of it."""

from typing import NamedTuple

import numpy as np
from numba import njit

from rocking.kernels.arc.solution import Arc
from rocking.kernels.compile_options import KERNEL_INLINE
from rocking.kernels.march.event_rows import EVENT_ROW
from rocking.kernels.numerics.replace_fields import replacing


class Progress(NamedTuple):
    """A block under way, and what it has met so far."""

    mode: int
    cycle: int
    arc: Arc
    pending: bool  # this cycle's section is still to come
    crowd: int  # events in this cycle
    impacts: int
    brace_hits: int
    peak: float
    no_return: float  # time within the cycle at which overturning was proved; infinite before
    # about how long the last arc took, and how long the one under way will take from where it is entered, which is
    # most often what the last on its side took; 0 where that is not known
    last_wait: float
    wait_before: float
    strain: float  # logarithm of what differences had grown to when the block last came to rest or leaned


class Recording(NamedTuple):
    """What a march records; arrays without rows record nothing."""

    section_time: float = 0.0  # within each cycle
    # (n, 2), the states at that time, just after any event there, in order and as long as no overturning is proved; (n, 4)
    # with the impacts and brace hits so far
    section: np.ndarray = np.empty((0, 2))
    events: np.ndarray = np.empty(0, EVENT_ROW)  # one row an event
    peak: bool = False
    releases: bool = False  # stop after each lift-off, and each time the block leaves a brace


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

    A named tuple is made by calling its class, and an interrupt (Ctrl-C) that strikes there, on the way out of compiled code,
    ends the whole process.
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
    """Return the progress that ``to_tuple`` took apart."""
    return Progress(*fields[:2], Arc(*fields[2]), *fields[3:])
