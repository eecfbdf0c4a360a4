"""Fields as they are typed and as they stand in an address: read, refused in a sentence each, and written."""

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
"""Of an address: raised when one of before would show something else."""
MAX_LENGTH = 40
"""Signs in a number that is typed."""
MAX_ADDRESS = 2000
LATEST, MAX_SHOWN = 100_000, 200
WORDS = {
    "brace_angle": "brace angle",
    "brace_restitution": "brace restitution",
    "first": "first cycle",
    "acceleration_g": "acceleration",
    "frequency_hz": "frequency",
}
"""What a field is called where it is not called by its name: at the field, and where what is typed there is refused."""


class Refused(ValueError):
    """What was typed cannot be shown: a sentence for each field."""

    def __init__(self, fields: Mapping[str, str]) -> None:
        super().__init__("; ".join(fields.values()))
        self.fields = dict(fields)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.fields,), self.__dict__


def _given(name: str, text: str) -> str:
    """What was typed, if anything was."""
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
        # a hair: the narrowest one itself must survive rounding
        if not span.width >= closest(span) * (1.0 - 1e-3):
            raise ValueError(
                refusal(name, "be LOW:HIGH, LOW below HIGH, no closer than doubles can tell", text)
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
"""How what is typed for a field, or stands in an address, is read."""
PHYSICAL = {
    "height": _number(1e-3, 1e3),
    "width": _number(1e-3, 1e3),
    "acceleration": _number(0.0, 1e6),
    "frequency_hz": _number(1e-6, 1e6),
}


def changed(shown: ViewState, typed: Mapping[str, str]) -> ViewState:
    """The same with some fields as they are typed.

    Raises
    ------
    Refused
        With a sentence for each field that cannot be as it is typed.
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
    """The same with the block and the shaking in SI: height, width, acceleration (`unit` "g" or "m/s²"), frequency_hz.

    Raises Refused as `changed` does.
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
    forcing = system.forcing
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
    """What the package refuses of a block or its shaking, at the field that it is about and in that field's words."""
    name, _, rest = sentence.partition(" ")
    if name == "restitution":  # Housner's, which follows from the sizes
        return {"width": f"{sentence.partition(':')[0]}: make the block narrower or taller"}
    return {name.removesuffix("_g"): f"{WORDS.get(name, name)} {rest}"}


def _reaching(span: Span, value: float, most: float) -> Span:
    """A stretch that holds a value: as it is, or longer."""
    if span.low <= value <= span.high:
        return span
    return Span(min(span.low, value * 0.8), min(max(span.high, value * 1.25), most))


def _read(
    how: Mapping[str, Callable[[str, str], Any]], typed: Mapping[str, str]
) -> tuple[dict[str, Any], dict[str, str]]:
    """What was read, and what was refused."""
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
    """The parameters of an address that shows the same: the system, and whatever is not as at the beginning."""
    system = ("amplitude", "period", "restitution")
    parts = {
        each.name: written(getattr(shown, each.name))
        for each in attrs.fields(ViewState)
        if each.name in system or getattr(shown, each.name) != each.default
    }
    return urlencode({"version": str(VERSION)} | parts, safe=":,")


def written(value: Any) -> str:
    """A field as it is typed: every digit that a double has, and no more."""
    if value is None:
        return ""
    if isinstance(value, Span):
        return f"{written(value.low)}:{written(value.high)}"
    if isinstance(value, tuple):
        return ",".join(value)
    return repr(value).removesuffix(".0") if isinstance(value, float) else str(value)


def from_address(text: str) -> tuple[ViewState, dict[str, str]]:
    """What the parameters of an address show, and a sentence for each that cannot be: it is left as at the beginning."""
    if len(text) > MAX_ADDRESS:
        return DEFAULT, {"page": f"address must have at most {MAX_ADDRESS} signs; got {len(text)}"}
    typed = dict(parse_qsl(text.removeprefix("?"), keep_blank_values=True, max_num_fields=None))
    version = typed.pop("version", str(VERSION))
    if version != str(VERSION):
        return DEFAULT, {"page": refusal("version", f"be {VERSION}, of addresses made here", version)}
    read, refused = _read(READ, typed)
    shown = attrs.evolve(DEFAULT, **read)
    try:
        check_start(shown.system, shown.start)
    except ValueError as error:
        return DEFAULT, refused | {"angle": str(error)}
    return shown, refused
