"""Progress of a march, and the recording of it."""

from typing import NamedTuple

import numpy as np

from rocking.kernels.forcing.arc import Arc
from rocking.kernels.march.event_rows import EVENT_ROW, EventRows
from rocking.kernels.numerics.replace_fields import replacing
from rocking.kernels.signature import Floats2


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
    section: Floats2 = np.empty((0, 2))
    events: EventRows = np.empty(0, EVENT_ROW)  # one row per event
    peak: bool = False
    releases: bool = False  # stop after each lift-off and each departure from a brace


with_clock = replacing(Progress, "cycle", "arc", "pending", "crowd", "no_return")
with_arc = replacing(Progress, "arc")
with_pending = replacing(Progress, "pending")
with_no_return = replacing(Progress, "no_return")
with_peak = replacing(Progress, "peak")
with_strain = replacing(Progress, "strain")
with_waits = replacing(Progress, "last_wait", "wait_before")
