"""Options that may be an axis, START:STOP:COUNT, and what that asks for."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple

import typer

from rocking.cli.input.options import number, number_option, question
from rocking.cli.option_names import YourInput, option

if TYPE_CHECKING:
    import numpy as np

    from rocking.model import Block, State, System

DEFAULT_COUNT = 200
MAX_POINTS = 1_000_000
FORM = "START:STOP:COUNT"


class Axis(NamedTuple):
    """Evenly spaced values, both ends among them."""

    start: float
    stop: float
    points: int


def number_or_axis(text: str) -> float | Axis:
    """A number, or an axis START:STOP:COUNT, the count optional."""
    if not isinstance(text, str):  # a default
        return text
    with suppress(typer.BadParameter):
        return number(text)
    with suppress(ValueError):
        start, stop, count = (text if text.count(":") == 2 else f"{text}:{DEFAULT_COUNT}").split(":")
        axis = Axis(float(start), float(stop), int(count))
        if axis.start != axis.stop and 2 <= axis.points <= MAX_POINTS:
            return axis
    raise typer.BadParameter(
        f"must be a number or {FORM}, two different numbers and a whole one from 2 to {MAX_POINTS:,}; got {text!r}"
    )


def axis_option(name: str, text: str) -> Any:
    """An option that is an axis."""
    return typer.Option(name, parser=number_or_axis, metavar="AXIS", help=text)


def value_option(name: str, text: str) -> Any:
    """An option that is a number or an axis; a block has one height and one width."""
    if name in ("--height", "--width"):
        return number_option(name, text)
    return typer.Option(name, parser=number_or_axis, metavar="NUMBER|AXIS", help=text)


# What an option in SI varies.
VARIES = {
    "acceleration": "amplitude",
    "acceleration_g": "amplitude",
    "displacement": "amplitude",
    "frequency_hz": "frequency",
    "period_s": "period",
}


class Study(NamedTuple):
    """One parameter varied, all else fixed."""

    system: System
    start: State
    block: Block | None
    parameter: str
    values: np.ndarray
    typed: str


def study(given: Mapping[str, Any]) -> Study:
    """What the options ask for, exactly one of which is an axis; refused as `YourInput`."""
    import numpy as np

    axes = [name for name, value in given.items() if isinstance(value, Axis)]
    if len(axes) != 1:
        got = " and ".join(map(option, axes)) or "none"
        raise YourInput(f"give exactly one option as an axis, {FORM}; got {got}")
    name, axis = axes[0], given[axes[0]]
    if given["displacement"] is not None and name in ("frequency_hz", "period_s"):
        raise YourInput(f"--displacement with {option(name)} varies two things: give --acceleration instead")
    values = np.linspace(axis.start, axis.stop, axis.points)
    # Ranges are intervals: what both ends pass, all between them do.
    system, start, block = question({**given, name: axis.start})
    last, _, _ = question({**given, name: axis.stop})
    typed = f"{option(name)} {axis.start:.6g} to {axis.stop:.6g}"
    if name not in VARIES:
        return Study(system, start, block, name, values, typed)
    # Each is proportional to what it varies.
    varied = VARIES[name]
    first, final = (getattr(one.forcing, varied) for one in (system, last))
    return Study(system, start, block, varied, np.linspace(first, final, axis.points), typed)
