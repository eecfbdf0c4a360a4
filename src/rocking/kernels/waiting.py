"""Report of how far the machine code is that this process waits for."""

from collections.abc import Callable

LISTENERS: list[Callable[[str, float], None]] = []
"""Functions that are called several times a second, with the name of an entry point and the fraction that is done."""


def report(name: str, fraction: float) -> None:
    """Tell all listeners how far an entry point is; 1 ends the wait."""
    for listener in LISTENERS:
        listener(name, fraction)
