"""Arrays without rows, for marches that record nothing."""

from typing import NamedTuple

import numpy as np

from rocking.kernels.march.event_rows import EVENT_ROW, EventRows
from rocking.kernels.march.tangent import TangentState
from rocking.kernels.signature import Floats2


class NoRecording(NamedTuple):
    """Empty arrays for disabled recordings, allocated once: an allocation costs as much as half an impact."""

    section: Floats2  # (0, 4)
    events: EventRows  # (0,)
    tangent: TangentState  # (0, 2), (0,)


def no_recording():
    """Allocate the arrays of ``NoRecording``."""
    return NoRecording(np.empty((0, 4)), np.empty(0, EVENT_ROW), TangentState(np.empty((0, 2)), np.empty(0)))
