"""Values: what a block, its base and its state are, frozen and validated; known to every room but the kernels.

With them goes what every room shares: the one-line refusals, files that are whole or not there, notebook pictures.
"""

from rocking.model import pictures
from rocking.model.block import GRAVITY, Block
from rocking.model.citation import cite
from rocking.model.errors import (
    TooManyEvents,
    exactly_one,
    instance,
    one_of,
    reals,
    refusal,
    shown,
    whole,
    within,
)
from rocking.model.files import check_folder, check_writable, replacing
from rocking.model.forcing import Harmonic
from rocking.model.outcome import Outcome, Overturning
from rocking.model.system import LARGEST_START, Braces, State, System, check_start
from rocking.model.version import VERSION

__all__ = [
    "GRAVITY",
    "LARGEST_START",
    "VERSION",
    "Block",
    "Braces",
    "Harmonic",
    "Outcome",
    "Overturning",
    "State",
    "System",
    "TooManyEvents",
    "check_folder",
    "check_start",
    "check_writable",
    "cite",
    "exactly_one",
    "instance",
    "one_of",
    "pictures",
    "reals",
    "refusal",
    "replacing",
    "shown",
    "whole",
    "within",
]
