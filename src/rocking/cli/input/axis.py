"""Options that may be an axis, START:STOP:COUNT, and what that asks for."""

from __future__ import annotations

from contextlib import suppress
from typing import Any, NamedTuple

import typer

from rocking.cli.input.options import number, number_option

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
