"""Fields as text, in the form and in links: reading, validation and writing."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any
from urllib.parse import parse_qsl, urlencode

import attrs

from rocking.explorer.view_state import DEFAULT, Span, ViewState, closest
from rocking.model import (
    BRACE_ANGLES,
    MAX_AMPLITUDE,
    MAX_PHASE,
    MAX_START,
    PERIODS,
    Block,
    check_start,
    refusal,
    refuse_if,
)
from rocking.plot.parts import theory_curves

VERSION = 1
"""Version of links; increased when an earlier link would show a different view."""
MAX_LENGTH = 40
"""Maximum number of characters of a number."""
MAX_ADDRESS = 2000
"""Maximum number of characters of a link."""
LATEST, MAX_SHOWN = 100_000, 200
"""Largest first cycle, and largest number of cycles, of the time history."""
WORDS = {
    "brace_angle": "brace angle",
    "brace_restitution": "brace restitution",
    "first": "first cycle",
    "acceleration_g": "acceleration",
    "frequency_hz": "frequency",
}
"""Labels of fields, in the form and in error messages, if they differ from the names."""


class Refused(ValueError):
    """Invalid input: `fields` holds one error message per field."""

    def __init__(self, fields: Mapping[str, str]) -> None:
        super().__init__("; ".join(fields.values()))
        self.fields = dict(fields)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.fields,), self.__dict__


def _given(name: str, text: str) -> str:
    """Return the text without surrounding spaces; raise ValueError if it is empty."""
    if not text.strip():
        raise ValueError(f"give the {name}")
    return text.strip()


def _number(low: float, high: float) -> Callable[[str, str], float]:
    def read(name: str, text: str) -> float:
        _given(name, text)
        allowed = f"be a number in [{low:.6g}, {high:.6g}]"
        try:
            value = float(text) if len(text) <= MAX_LENGTH else math.nan
        except ValueError:
            value = math.nan
        refuse_if(not low <= value <= high, name, allowed, text)
        return value + 0.0  # no negative zero

    return read


def _count(low: int, high: int) -> Callable[[str, str], int]:
    def read(name: str, text: str) -> int:
        value = _given(name, text)
        if not (value.isascii() and value.isdigit() and len(value) < 10 and low <= int(value) <= high):
            raise ValueError(refusal(name, f"be a whole number in [{low}, {high}]", text))
        return int(value)

    return read


def _span(low: float, high: float) -> Callable[[str, str], Span]:
    number = _number(low, high)

    def read(name: str, text: str) -> Span:
        first, _, last = text.partition(":")
        span = Span(number(name, first), number(name, last))
        # tolerance for rounding, so that the narrowest range itself is valid
        if not span.width >= closest(span) * (1.0 - 1e-3):
            raise ValueError(
                refusal(name, "be LOW:HIGH, with LOW < HIGH and a range that double precision resolves", text)
            )
        return span

    return read


def _optional(read: Callable[[str, str], Any]) -> Callable[[str, str], Any]:
    return lambda name, text: None if not text.strip() else read(name, text)


def _word(*allowed: str) -> Callable[[str, str], str]:
    def read(name: str, text: str) -> str:
        refuse_if(text not in allowed, name, f"be one of {', '.join(allowed)}", text)
        return text

    return read


def _words(*allowed: str) -> Callable[[str, str], tuple[str, ...]]:
    one = _word(*allowed)

    def read(name: str, text: str) -> tuple[str, ...]:
        chosen = {one(name, each) for each in text.split(",") if each}
        return tuple(each for each in allowed if each in chosen)

    return read


START = -MAX_START, MAX_START
READ: dict[str, Callable[[str, str], Any]] = {
    "amplitude": _number(0.0, MAX_AMPLITUDE),
    "period": _number(*PERIODS),
    "restitution": _number(0.0, 1.0),
    "phase": _number(-MAX_PHASE, MAX_PHASE),
    "angle": _number(*START),
    "velocity": _number(*START),
    "brace_angle": _optional(_number(*BRACE_ANGLES)),
    "brace_restitution": _number(0.0, 1.0),
    "amplitudes": _span(0.0, MAX_AMPLITUDE),
    "periods": _span(*PERIODS),
    "angles": _span(*START),
    "velocities": _span(*START),
    "vary": _word("amplitude", "period"),
    "first": _count(0, LATEST),
    "cycles": _count(1, MAX_SHOWN),
    "curves": _words(*theory_curves.CURVES),
    "height": _optional(_number(1e-3, 1e3)),
    "width": _optional(_number(1e-3, 1e3)),
}
"""Reader of each field, for the form and for links."""
PHYSICAL = {
    "height": _number(1e-3, 1e3),
    "width": _number(1e-3, 1e3),
    "acceleration": _number(0.0, 1e6),
    "frequency_hz": _number(1e-6, 1e6),
}


def changed(shown: ViewState, typed: Mapping[str, str]) -> ViewState:
    """Return the view with new values of some fields.

    Parameters
    ----------
    shown : ViewState
        Current view.
    typed : mapping of str to str
        Field names and their text.

    Returns
    -------
    ViewState
        New view.

    Raises
    ------
    Refused
        If a field is invalid, with one message per field.
    """
    read, refused = _read(READ, typed)
    if refused:
        raise Refused(refused)
    wanted = attrs.evolve(shown, **read)
    try:
        check_start(wanted.system, wanted.start)
    except ValueError as error:
        raise Refused({"angle": str(error)}) from None
    return wanted


def in_metres(shown: ViewState, typed: Mapping[str, str]) -> ViewState:
    """Return the view with a block and its forcing in SI units.

    Parameters
    ----------
    shown : ViewState
        Current view.
    typed : mapping of str to str
        Text of `height` and `width` in m, `acceleration` in the `unit` "g" or "m/s²", and `frequency_hz` in Hz.

    Returns
    -------
    ViewState
        New view, with Housner's coefficient of restitution. Its map includes the new system.

    Raises
    ------
    Refused
        If a field is invalid, with one message per field.
    """
    read, refused = _read(PHYSICAL, {name: typed.get(name, "") for name in PHYSICAL})
    if refused:
        raise Refused(refused)
    size = "acceleration_g" if typed.get("unit") == "g" else "acceleration"
    try:
        block = Block(read["height"], read["width"])
        system = block.system(**{size: read["acceleration"]}, frequency_hz=read["frequency_hz"])
    except ValueError as error:
        raise Refused(_at_its_field(str(error))) from None
    forcing = system.harmonic
    return attrs.evolve(
        shown,
        amplitude=forcing.amplitude,
        period=forcing.period,
        restitution=system.restitution,
        height=block.height,
        width=block.width,
        amplitudes=_reaching(shown.amplitudes, forcing.amplitude, MAX_AMPLITUDE),
        periods=_reaching(shown.periods, forcing.period, PERIODS[1]),
    )


def _at_its_field(sentence: str) -> dict[str, str]:
    """Assign an error message of the package to its field, with the label of the field."""
    name, _, rest = sentence.partition(" ")
    if name == "restitution":  # Housner's value, which follows from height and width
        return {"width": f"{sentence.partition(':')[0]}: make the block narrower or taller"}
    return {name.removesuffix("_g"): f"{WORDS.get(name, name)} {rest}"}


def _reaching(span: Span, value: float, most: float) -> Span:
    """Return the range, extended if necessary to contain a value."""
    if span.low <= value <= span.high:
        return span
    return Span(min(span.low, value * 0.8), min(max(span.high, value * 1.25), most))


def _read(
    how: Mapping[str, Callable[[str, str], Any]], typed: Mapping[str, str]
) -> tuple[dict[str, Any], dict[str, str]]:
    """Read fields.

    Returns
    -------
    tuple of (dict, dict)
        Values by name, and error messages by name.
    """
    read, refused = {}, {}
    for name, text in typed.items():
        if name not in how:
            refused["page"] = refusal("field", f"be one of {', '.join(how)}", name)
            continue
        try:
            read[name] = how[name](WORDS.get(name, name), text)
        except ValueError as error:
            refused[name] = str(error)
    return read, refused


def address(shown: ViewState) -> str:
    """Return the query string of a view: the system, and all other fields that differ from their defaults."""
    system = ("amplitude", "period", "restitution")
    parts = {
        each.name: written(getattr(shown, each.name))
        for each in attrs.fields(ViewState)
        if each.name in system or getattr(shown, each.name) != each.default
    }
    return urlencode({"version": str(VERSION)} | parts, safe=":,")


def written(value: Any) -> str:
    """Write a field as text, with the fewest digits that give the value back."""
    if value is None:
        return ""
    if isinstance(value, Span):
        return f"{written(value.low)}:{written(value.high)}"
    if isinstance(value, tuple):
        return ",".join(value)
    return repr(value).removesuffix(".0") if isinstance(value, float) else str(value)


def from_address(text: str) -> tuple[ViewState, dict[str, str]]:
    """Return the view of a query string; invalid parameters keep their defaults.

    Returns
    -------
    tuple of (ViewState, dict of str)
        View, and an error message for each invalid parameter.
    """
    if len(text) > MAX_ADDRESS:
        return DEFAULT, {"page": f"link must have at most {MAX_ADDRESS} characters; got {len(text)}"}
    typed = dict(parse_qsl(text.removeprefix("?"), keep_blank_values=True, max_num_fields=None))
    version = typed.pop("version", str(VERSION))
    if version != str(VERSION):
        return DEFAULT, {
            "page": refusal("version", f"be {VERSION}, the version of the links of this explorer", version)
        }
    read, refused = _read(READ, typed)
    shown = attrs.evolve(DEFAULT, **read)
    try:
        check_start(shown.system, shown.start)
    except ValueError as error:
        return DEFAULT, refused | {"angle": str(error)}
    return shown, refused
