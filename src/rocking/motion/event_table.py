"""Table of events of a motion, from the event rows of the kernels."""

from __future__ import annotations

import math

import numpy as np

from rocking.kernels import event_kinds as kernel
from rocking.model import Harmonic, System

EVENT = np.dtype(
    [
        ("time", "f8"),
        ("cycle", "i8"),
        ("phase", "f8"),
        ("angle", "f8"),
        ("before", "f8"),
        ("after", "f8"),
        ("kind", "U8"),
    ]
)
KINDS = np.array(["impact", "brace", "rest", "lift-off", "lean", "leave"])


def events_of(system: System, rows: np.ndarray, cycle_length: float, duration: float) -> np.ndarray:
    """Return event rows of the kernel as the structured array of `Motion.events`."""
    rows = rows[rows["event"] != kernel.NONE]
    forcing = system.forcing
    events = np.empty(len(rows), EVENT)
    events["time"] = absolute(rows, cycle_length, duration)
    if isinstance(forcing, Harmonic):
        events["cycle"] = rows["cycle"]
        events["phase"] = np.mod(forcing.frequency * rows["time"] + forcing.phase, 2.0 * math.pi)
    else:
        events["cycle"], events["phase"] = -1, math.nan
    events["angle"] = rows["side"] * rows["angle"] + 0.0
    events["before"] = rows["before"] + 0.0
    events["after"] = rows["side"] * rows["velocity"] + 0.0
    events["kind"] = KINDS[rows["event"].astype(int)]
    return events


def absolute(rows: np.ndarray, cycle_length: float, duration: float) -> np.ndarray:
    """Return the times of event rows, in τ from the start."""
    # Rounding could place the last event after the end of the run.
    return np.minimum(rows["cycle"] * cycle_length + rows["time"], duration)
