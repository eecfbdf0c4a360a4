"""Simulating one block, and what it did."""

from rocking.motion.motion import Motion
from rocking.motion.simulate import simulate
from rocking.motion.validity import Validity, validity

__all__ = ["Motion", "Validity", "simulate", "validity"]
