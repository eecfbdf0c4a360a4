"""Working memory of the cascade: made once, for one system after another."""

from typing import NamedTuple

import numpy as np

# Cycles between looks at a motion that loses nothing.
LEG = 128
# The last states are moved to the front once in so many looks.
SPARE = 3
# Over so many equal parts of the second half of the budget the exponent is measured.
BATCHES = 64


class NoRecording(NamedTuple):
    """Arrays without rows, for what is not recorded: made once, since to make one costs as much as half an impact."""

    section: np.ndarray  # (0, 4)
    events: np.ndarray  # (0, 8)
    columns: np.ndarray  # (0, 2)
    growth: np.ndarray  # (0,)


class Workspace(NamedTuple):
    """Working memory, for one system after another."""

    section: np.ndarray  # (n, 8), the last cycles: ``note_state``, then ``quasi_periodicity.sketch``
    scratch: np.ndarray  # (n, 4), a trial orbit's; as many of the last cycles are looked at
    events: np.ndarray  # (n, 8)
    flights: np.ndarray  # (n, 2)
    weights: np.ndarray  # (n/4 + 1,)
    batches: np.ndarray
    columns: np.ndarray  # (2, 2)
    trial: np.ndarray  # (2, 2)
    growth: np.ndarray  # (1,)
    nothing: NoRecording


def padded_row_length(count):
    """So many numbers, or a few more, that of rows of them not all begin on the same line of the fast memory's pages.

    Lanes write into all their rows in turn; where those compete for a few lines each write waits.
    """
    return count + (8 - count) % 512


def make_workspace(max_cycles, max_period):
    """Working memory for runs of up to ``max_cycles`` and orbits of up to ``max_period``."""
    rows = max(4 * max_period, LEG) + 1
    flights = padded_row_length(min(max(4 * max_cycles, 1024), 1 << 18))
    return Workspace(
        np.empty((rows + SPARE * LEG, 8)),
        np.empty((rows, 4)),
        np.empty((512, 8)),
        np.empty((flights, 2)),
        np.empty(flights // 4 + 1),
        np.empty(BATCHES),
        np.empty((2, 2)),
        np.empty((2, 2)),
        np.empty(1),
        NoRecording(np.empty((0, 4)), np.empty((0, 8)), np.empty((0, 2)), np.empty(0)),
    )
