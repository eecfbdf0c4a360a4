"""Options whose value may be an axis, START:STOP:COUNT."""

from __future__ import annotations

from contextlib import suppress
from typing import Any, NamedTuple

import typer

from rocking.cli.input.options import number, number_option
from rocking.cli.option_names import AXIS_FORM

DEFAULT_COUNT = 200
MAX_POINTS = 1_000_000


class Axis(NamedTuple):
    """Evenly spaced values, both ends included."""

    start: float
    stop: float
    points: int


def number_or_axis(text: str) -> float | Axis:
    """Return the number or the axis START:STOP:COUNT in a text; COUNT is optional."""
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
        f"must be a number or {AXIS_FORM} with START ≠ STOP and a whole COUNT in [2, {MAX_POINTS}]; got {text!r} (example: 1:3:60)"
    )


def axis_option(name: str, text: str) -> Any:
    """Declare an option whose value is an axis."""
    return typer.Option(name, parser=number_or_axis, metavar="AXIS", help=text)


def value_option(name: str, text: str) -> Any:
    """Declare an option whose value is a number or an axis; height and width of the block are numbers."""
    if name in ("--height", "--width"):
        return number_option(name, text)
    return typer.Option(name, parser=number_or_axis, metavar="NUMBER|AXIS", help=text)


# SI option → the normalised quantity that it varies.
VARIES = {
    "acceleration": "amplitude",
    "acceleration_g": "amplitude",
    "displacement": "amplitude",
    "frequency_hz": "frequency",
    "period_s": "period",
}
