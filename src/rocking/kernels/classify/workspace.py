"""Workspace of the decision cascade, allocated once and used for many systems."""

from typing import NamedTuple

import numpy as np

from rocking.kernels.march.event_rows import EVENT_ROW, EventRows
from rocking.kernels.march.no_recording import NoRecording, no_recording
from rocking.kernels.march.tangent import TangentState
from rocking.kernels.signature import Floats1, Floats2

# Cycles between checkpoints of an undamped motion.
LEG = 128
# The last states are moved to the front once per this number of checkpoints.
SPARE = 3
# Number of equal parts of the second half of the budget over which the exponent is measured.
BATCHES = 64


class Workspace(NamedTuple):
    """Preallocated arrays for the classification of one system after another."""

    section: Floats2  # (n, 8), the last cycles: ``note_state``, then ``append_lazy_rows``
    scratch: Floats2  # (n, 4), states of a trial orbit; n also limits the number of last cycles used
    events: EventRows  # (n,)
    flights: Floats2  # (n, 2)
    weights: Floats1  # (n/4 + 1,)
    batches: Floats1
    tangent: TangentState  # (2, 2), (1,)
    trial: Floats2  # (2, 2), tangent vectors of a trial orbit
    nothing: NoRecording


def padded_row_length(count):
    """Return a row length of at least ``count``, padded for the cache.

    Consecutive rows start in different cache sets. Lanes write into all their rows in turn; equal alignment
    causes conflict misses.
    """
    return count + (8 - count) % 512


def make_workspace(max_cycles, max_period):
    """Allocate the workspace for runs of up to ``max_cycles`` and orbits of up to ``max_period``."""
    rows = max(4 * max_period, LEG) + 1
    flights = padded_row_length(min(max(4 * max_cycles, 1024), 1 << 18))
    return Workspace(
        np.empty((rows + SPARE * LEG, 8)),
        np.empty((rows, 4)),
        np.empty(512, EVENT_ROW),
        np.empty((flights, 2)),
        np.empty(flights // 4 + 1),
        np.empty(BATCHES),
        TangentState(np.empty((2, 2)), np.empty(1)),
        np.empty((2, 2)),
        no_recording(),
    )
