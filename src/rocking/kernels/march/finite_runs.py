"""Motions under base accelerations of finite length to their ends: one, or many under the same samples, or under many pulses."""

import math
from typing import Annotated

import numpy as np

from rocking.kernels.compile_options import KERNEL, LONG
from rocking.kernels.entry_point import entry_point
from rocking.kernels.forcing.finite import to_end, with_pulse, with_run
from rocking.kernels.forcing.parameters import (
    AnyPulseParameters,
    AnySampledParameters,
    FiniteParameters,
)
from rocking.kernels.march.ending import Ending, Endings, write_ending
from rocking.kernels.signature import Integers1

# Runs under the same samples: their scale, and the block and its angle at the start. The critical angle is that of a full block.
RUN_ROW = np.dtype(
    [("scale", "f8"), ("restitution", "f8"), ("angle", "f8"), ("critical_angle", "f8")], align=True
)
Runs = Annotated[np.ndarray, RUN_ROW, 1]

PULSE_ROW = np.dtype(
    [
        ("amplitude", "f8"),
        ("frequency", "f8"),
        ("phase", "f8"),
        ("duration", "f8"),
        ("restitution", "f8"),
        ("critical_angle", "f8"),
    ],
    align=True,
)
Pulses = Annotated[np.ndarray, PULSE_ROW, 1]


@entry_point(**KERNEL)
def run_to_end(p: FiniteParameters, angle: float, velocity: float, until: float) -> Ending:
    """Follow a motion by ``to_end``, each impact of a chattering sequence included; entry point for Python."""
    return to_end(p, angle, velocity, until, False, False)


@entry_point(**LONG)
def run_batch(p: AnySampledParameters, runs: Runs, want_peak: bool, rows: Endings, stop: Integers1) -> bool:
    """Follow the motion of each of ``runs`` under the samples of ``p``, and write its row of ``rows``.

    Chattering is cut short, so that its impacts do not count for the margin. Returns True if all were followed, False if
    ``stop[0]`` was set before the end.
    """
    for k in range(runs.shape[0]):
        if stop[0] != 0:
            return False
        q = with_run(p, runs[k])
        write_ending(rows, k, to_end(q, runs[k].angle, 0.0, math.inf, True, want_peak))
    return True


@entry_point(**LONG)
def run_pulses(
    kind: AnyPulseParameters, pulses: Pulses, want_peak: bool, rows: Endings, stop: Integers1
) -> bool:
    """Follow the motion from rest under each of ``pulses`` as ``run_batch`` does; ``kind`` only gives the kind of block."""
    for k in range(pulses.shape[0]):
        if stop[0] != 0:
            return False
        p = with_pulse(kind, pulses[k])
        write_ending(rows, k, to_end(p, 0.0, 0.0, math.inf, True, want_peak))
    return True
