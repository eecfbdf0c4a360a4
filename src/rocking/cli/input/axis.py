"""Options whose value may be an axis, START:STOP:COUNT, or a range, START:STOP."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from typing import Any, NamedTuple

import typer

from rocking.cli.input.options import number, number_option
from rocking.cli.option_names import AXIS_FORM, RANGE_FORM, YourInput, option

DEFAULT_COUNT = 200
MAX_POINTS = 1_000_000
AMPLITUDES = ("amplitude", "acceleration", "acceleration_g", "displacement")
"""Options of the amplitude of the base motion."""


class Axis(NamedTuple):
    """Evenly spaced values, both ends included."""

    start: float
    stop: float
    points: int


class Range(NamedTuple):
    """Values from one end to the other, in the order typed."""

    start: float
    stop: float


AXIS_ALLOWED = f"{AXIS_FORM} with finite START ≠ STOP and a whole COUNT in [2, {MAX_POINTS}]"
RANGE_ALLOWED = f"{RANGE_FORM} with finite START ≠ STOP"


def number_or_axis(text: str) -> float | Axis:
    """Return the number or the axis START:STOP:COUNT in a text; COUNT is optional."""
    if not isinstance(text, str):  # a default
        return text
    with suppress(typer.BadParameter):
        return number(text)
    with suppress(ValueError):
        start, stop, count = (text if text.count(":") == 2 else f"{text}:{DEFAULT_COUNT}").split(":")
        axis = Axis(float(start), float(stop), int(count))
        if _differ(axis.start, axis.stop) and 2 <= axis.points <= MAX_POINTS:
            return axis
    raise _refused(f"must be a number or {AXIS_ALLOWED}", text, "example: 1:3:60")


def _differ(start: float, stop: float) -> bool:
    """Return whether two ends differ and are finite, so that values lie between them."""
    return math.isfinite(stop - start) and start != stop


def _refused(allowed: str, text: str, example: str) -> typer.BadParameter:
    """Return the error for a text that is not what is allowed."""
    from rocking.model.text import shown

    return typer.BadParameter(f"{allowed}; got {shown(text)} ({example})")


def number_or_range(text: str) -> float | Range:
    """Return the number or the range START:STOP in a text."""
    if not isinstance(text, str):  # a default
        return text
    with suppress(typer.BadParameter):
        return number(text)
    with suppress(ValueError):
        start, stop = text.split(":")
        ends = Range(float(start), float(stop))
        if _differ(ends.start, ends.stop):
            return ends
    raise _refused(f"must be a number or {RANGE_ALLOWED}", text, "example: 1:3")


def only_axis(text: str) -> Axis:
    """Return the axis START:STOP:COUNT in a text; COUNT is optional."""
    with suppress(typer.BadParameter):
        found = number_or_axis(text)
        if isinstance(found, Axis):
            return found
    raise _refused(f"must be an axis, {AXIS_ALLOWED}", text, "example: 1:3:60")


def only_range(text: str) -> Range:
    """Return the range START:STOP in a text."""
    with suppress(typer.BadParameter):
        found = number_or_range(text)
        if isinstance(found, Range):
            return found
    raise _refused(f"must be a range, {RANGE_ALLOWED}", text, "example: -1:1")


def axis_option(name: str, text: str) -> Any:
    """Declare an option whose value is an axis."""
    return typer.Option(name, parser=number_or_axis, metavar="AXIS", help=text)


def value_option(name: str, text: str) -> Any:
    """Declare an option whose value is a number or an axis; height and width of the block are numbers."""
    if name in ("--height", "--width"):
        return number_option(name, text)
    return typer.Option(name, parser=number_or_axis, metavar="NUMBER|AXIS", help=text)


def range_option(name: str, text: str) -> Any:
    """Declare an option whose value is a number or a range; phase, height and width are numbers."""
    if name in ("--height", "--width", "--phase"):
        return number_option(name, text)
    return typer.Option(name, parser=number_or_range, metavar="NUMBER|RANGE", help=text)


def forcing_axis_option(name: str, text: str) -> Any:
    """Declare an option whose value is an axis if it is a period or a frequency, else a number."""
    if name.startswith(("--period", "--frequency")):
        return typer.Option(name, parser=only_axis, metavar="AXIS", help=text)
    return number_option(name, text)


def amplitude_axis_option(name: str, text: str) -> Any:
    """Declare an option whose value is an axis if it is an amplitude of the base motion, else a number."""
    if name.removeprefix("--").replace("-", "_") in AMPLITUDES:
        return typer.Option(name, parser=only_axis, metavar="AXIS", help=text)
    return number_option(name, text)


def check_displacement(given: Mapping[str, Any], varied: str) -> None:
    """Raise YourInput if the displacement is fixed and the frequency varies: the amplitude then varies, too."""
    if given["displacement"] is not None and varied in ("frequency_hz", "period_s"):
        raise YourInput(
            f"--displacement with {'an axis' if isinstance(given[varied], Axis) else 'a range'} of {option(varied)} varies "
            "amplitude and frequency: use --acceleration instead"
        )


# SI option → the normalised quantity that it varies.
VARIES = {
    "acceleration": "amplitude",
    "acceleration_g": "amplitude",
    "displacement": "amplitude",
    "frequency_hz": "frequency",
    "period_s": "period",
}
