"""How the arguments of public functions are typed as options, and refusals that name them so."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import typer

NORMALISED = ("amplitude", "period", "frequency")
SI = ("height", "width", "acceleration", "acceleration_g", "displacement", "frequency_hz", "period_s")
FORCED = (*NORMALISED, *SI, "restitution")
SYSTEM = (*FORCED, "phase", "brace_angle", "brace_restitution")
START = ("angle", "velocity")
TOLD = tuple(name for name in (*SYSTEM, *START) if name not in SI)
"""Quantities of a survey, in the order in which they are listed."""
COUNTS = ("max_cycles", "max_period")


class YourInput(typer.TyperException):
    """What was typed cannot be done; the message says why in one line."""


def option(name: str) -> str:
    """How the argument `name` is typed."""
    return "--" + name.replace("_", "-")


def options(*names: str) -> dict[str, str]:
    """How arguments are typed whose options are named like them."""
    return {name: option(name) for name in names}


ARGUMENTS = options(*FORCED, "phase", *START, "cycles", *COUNTS)


@contextmanager
def your_input(typed: Mapping[str, str] | None = None) -> Iterator[None]:
    """Turn a refusal inside the block into one of yours, the arguments in it named as they are `typed`."""
    try:
        yield
    except (ValueError, TypeError, OSError) as error:
        raise YourInput(as_typed(str(error), typed or {})) from error


def as_typed(text: str, typed: Mapping[str, str]) -> str:
    """The same with arguments named as they are `typed`, but for what stands in quotes: a path, say."""
    if not typed:
        return text
    words = r"(?<!\w)(?:'[^']*'|\"[^\"]*\")|(?<![\w-])(" + "|".join(typed) + r")(?!['\w])"
    return re.sub(words, lambda found: typed[found[1]] if found[1] else found[0], text)
