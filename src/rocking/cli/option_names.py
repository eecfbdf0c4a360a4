"""Option names of the arguments of public functions, error messages that use these names, and the inputs of a command."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any

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
INPUT_FILES = {"study": "the study file", "file": "the record", "sources": "a record"}
"""Parameters of commands whose values are input files, and what these are in messages."""
INPUTS: ContextVar[dict[Path, str]] = ContextVar("inputs", default={})  # noqa: B039 (replaced, never changed)
"""Input files of the command that runs, and what they are in messages."""


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
    except (ValueError, TypeError, OSError) as error:
        raise YourInput(as_typed(str(error), typed or {})) from error


@contextmanager
def computing(typed: Mapping[str, str] | None = None) -> Iterator[None]:
    """Convert errors as `your_input` does, and show on stderr the time that a long computation takes."""
    from rocking.model.progress import Bar

    with your_input(typed), Bar(what="computing"):
        yield


def as_typed(text: str, typed: Mapping[str, str]) -> str:
    """Replace arguments in a text by their names in `typed`, except inside quotation marks, which may hold a path."""
    if not typed:
        return text
    words = r"(?<!\w)(?:'[^']*'|\"[^\"]*\")|(?<![\w-])(" + "|".join(map(re.escape, typed)) + r")(?!['\w])"
    return re.sub(words, lambda found: typed[found[1]] if found[1] else found[0], text)


def set_inputs(parameters: Mapping[str, Any]) -> None:
    """Take the input files from the parameters of a command, so that the check of its outputs knows them."""
    found: dict[Path, str] = {}
    for name, what in INPUT_FILES.items():
        given = parameters.get(name) or ()
        found |= dict.fromkeys((given,) if isinstance(given, Path) else given, what)
    INPUTS.set(found)
