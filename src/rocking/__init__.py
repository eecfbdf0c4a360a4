"""Exact simulation and nonlinear dynamics of free-standing blocks on a shaking base.

Every public name is imported when it is first used, so that `import rocking` itself costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rocking import plot
    from rocking.model import VERSION as __version__
    from rocking.model import (
        Block,
        Braces,
        Harmonic,
        Outcome,
        Overturning,
        State,
        System,
        TooManyEvents,
        cite,
    )
    from rocking.motion import Motion, simulate

__all__ = [
    "Block",
    "Braces",
    "Harmonic",
    "Motion",
    "Outcome",
    "Overturning",
    "State",
    "System",
    "TooManyEvents",
    "__version__",
    "cite",
    "plot",
    "simulate",
]

_ROOM = {"Motion": "rocking.motion", "simulate": "rocking.motion"}
_NAME = {"__version__": "VERSION"}


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    pictures = import_module("rocking.model.pictures")
    pictures.fill_at_first_use(lambda: import_module("rocking.plot"))
    if name == "plot":
        value = import_module("rocking.plot")
    else:
        value = getattr(import_module(_ROOM.get(name, "rocking.model")), _NAME.get(name, name))
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
