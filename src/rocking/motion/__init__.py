"""Simulation of one block: its motion, events and the validity of the model."""

from rocking.motion.fall import FALLEN, end_shown, has_cycles, sample_step, time_of_fall
from rocking.motion.march_loop import march_on, start_march
from rocking.motion.model_warnings import block_warnings
from rocking.motion.motion import Motion
from rocking.motion.simulate import kept_events, simulate
from rocking.motion.validity import Validity, validity

__all__ = [
    "FALLEN",
    "Motion",
    "Validity",
    "block_warnings",
    "end_shown",
    "has_cycles",
    "kept_events",
    "march_on",
    "sample_step",
    "simulate",
    "start_march",
    "time_of_fall",
    "validity",
]
