"""End of a motion under a base acceleration of finite length."""

from typing import Annotated, NamedTuple

import numpy as np

from rocking.kernels.compile_options import INTERNAL_INLINE
from rocking.kernels.deferred import njit


class Ending(NamedTuple):
    """End of a motion, and how close it came to another."""

    status: int
    impacts: int
    since_rest: int  # impacts since the block last rested, or since the start
    brace_hits: int
    peak: float
    margin: float  # K+ of least size over all lift-offs and impacts; NaN if the block never moves, or is not slender
    margin_time: float
    decided: bool  # whether no rounding error can have changed the outcome; False for a full block


ENDING_ROW = np.dtype(
    [
        ("status", "i8"),
        ("impacts", "i8"),
        ("since_rest", "i8"),
        ("decided", "i8"),
        ("peak", "f8"),
        ("margin", "f8"),
        ("margin_time", "f8"),
    ],
    align=True,
)
Endings = Annotated[np.ndarray, ENDING_ROW, 1]


@njit(**INTERNAL_INLINE)
def write_ending(rows, k, end):
    """Write an ``Ending`` to a row."""
    row = rows[k]
    row.status, row.impacts, row.since_rest, row.decided = (
        end.status,
        end.impacts,
        end.since_rest,
        end.decided,
    )
    row.peak, row.margin, row.margin_time = end.peak, end.margin, end.margin_time
