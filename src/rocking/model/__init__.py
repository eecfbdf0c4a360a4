"""Values: what a block, its base and its state are, frozen and validated; known to every room but the kernels."""

from rocking.model.block import GRAVITY, Block
from rocking.model.citation import cite
from rocking.model.errors import TooManyEvents
from rocking.model.forcing import Harmonic
from rocking.model.outcome import Outcome, Overturning
from rocking.model.system import Braces, State, System, check_start
from rocking.model.version import VERSION

__all__ = [
    "GRAVITY",
    "VERSION",
    "Block",
    "Braces",
    "Harmonic",
    "Outcome",
    "Overturning",
    "State",
    "System",
    "TooManyEvents",
    "check_start",
    "cite",
]
