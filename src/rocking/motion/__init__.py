"""Simulating one block, and what it did."""

from rocking.motion.motion import Motion
from rocking.motion.run import begin, march_on
from rocking.motion.simulate import kept_events, simulate
from rocking.motion.slender import block_warnings
from rocking.motion.validity import Validity, validity

__all__ = ["Motion", "Validity", "begin", "block_warnings", "kept_events", "march_on", "simulate", "validity"]
