"""Parameters of a system that every forcing shares: those of the block and of the clock.

The parameters of a system are a named tuple (block, forcing, clock). The second field is a tuple of its forcing.
"""

from typing import NamedTuple


class BlockParameters(NamedTuple):
    """Block and its braces; the angle is infinite if there are no braces."""

    restitution: float
    brace_angle: float
    brace_restitution: float


class Clock(NamedTuple):
    """Division of time into cycles of equal length: a time is an integer cycle and the time within it."""

    cycle_length: float
