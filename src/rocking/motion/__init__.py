"""Simulation of one block: its motion, events and the validity of the model."""

from rocking.motion.fall import end_shown, fallen, has_cycles, sample_step, time_of_fall
from rocking.motion.march_loop import march_on, monodromy, start_march
from rocking.motion.model_warnings import (
    block_warnings,
    height_warnings,
    proportion_warnings,
    slender_errors,
)
from rocking.motion.motion import Motion
from rocking.motion.simulate import kept_events, simulate
from rocking.motion.validity import Validity, validity

__all__ = [
    "Motion",
    "Validity",
    "block_warnings",
    "end_shown",
    "fallen",
    "has_cycles",
    "height_warnings",
    "kept_events",
    "march_on",
    "monodromy",
    "proportion_warnings",
    "sample_step",
    "simulate",
    "slender_errors",
    "start_march",
    "time_of_fall",
    "validity",
]
