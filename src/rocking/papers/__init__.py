"""Papers reproduced with the public names alone: one folder for each report, and `report` for what they share."""

from importlib import import_module
from types import ModuleType

PAPERS = {
    "yim-lin-1991": "Yim & Lin (1991): figures and claims",
    "pulses-and-earthquakes": "Housner (1963) to Makris & Konstantinidis (2003): pulses and earthquakes",
}
"""Reports by name, with their titles. The first is the default of the command."""


def room_of(name: str) -> ModuleType:
    """Return the module of a report, with `reproduce`, `PAPER` and `PAGE`."""
    return import_module(f"{__name__}.{name.replace('-', '_')}")
