"""Option names of the arguments of public functions, and error messages that use these names."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import typer

NORMALISED = ("amplitude", "period", "frequency")
SI = ("height", "width", "acceleration", "acceleration_g", "displacement", "frequency_hz", "period_s")
FORCED = (*NORMALISED, *SI, "restitution")
SYSTEM = (*FORCED, "phase", "brace_angle", "brace_restitution", "critical_angle")
START = ("angle", "velocity")
QUANTITIES = tuple(name for name in (*SYSTEM, *START) if name not in SI)
"""Quantities of a survey, in the order in which they are printed."""
COUNTS = ("max_cycles", "max_period")
AXIS_FORM = "START:STOP:COUNT"
RANGE_FORM = "START:STOP"


class YourInput(typer.TyperException):
    """Invalid input; the message states the reason in one line."""


def option(name: str) -> str:
    """Return the option name of the argument `name`."""
    return "--" + name.replace("_", "-")


def options(*names: str) -> dict[str, str]:
    """Return the option names of arguments, by argument."""
    return {name: option(name) for name in names}


ARGUMENTS = options(*FORCED, "phase", *START, "critical_angle", "cycles", "pulse", "model", *COUNTS) | {
    "kind": option("pulse")
}


@contextmanager
def your_input(typed: Mapping[str, str] | None = None) -> Iterator[None]:
    """Convert errors raised in the block to `YourInput`, with arguments replaced by their names in `typed`."""
    try:
        yield
    except (ValueError, TypeError, OSError, ImportError) as error:
        raise YourInput(as_typed(str(error), typed or {})) from error


def as_typed(text: str, typed: Mapping[str, str]) -> str:
    """Replace arguments in a text by their names in `typed`, except inside quotation marks, which may hold a path."""
    if not typed:
        return text
    words = r"(?<!\w)(?:'[^']*'|\"[^\"]*\")|(?<![\w-])(" + "|".join(map(re.escape, typed)) + r")(?!['\w])"
    return re.sub(words, lambda found: typed[found[1]] if found[1] else found[0], text)
