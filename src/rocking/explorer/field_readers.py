"""Fields as text: their readers, their errors, and the parameters of a link."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any
from urllib.parse import parse_qsl

from rocking.explorer.view_state import Span
from rocking.model.validation import Refusal, refuse_if

VERSION = 1
"""Version of links; increased when an earlier link would show a different view."""
MAX_LENGTH = 40
"""Maximum number of characters of a number."""
MAX_ADDRESS = 2000
"""Maximum number of characters of a link."""
WORDS = {
    "brace_angle": "brace angle",
    "brace_restitution": "brace restitution",
    "critical_angle": "critical angle",
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


def number(low: float, high: float) -> Callable[[str, str], float]:
    """Return the reader of a number in a range."""

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


def count(low: int, high: int) -> Callable[[str, str], int]:
    """Return the reader of a whole number in a range."""

    def read(name: str, text: str) -> int:
        value = _given(name, text)
        if not (value.isascii() and value.isdigit() and len(value) < 10 and low <= int(value) <= high):
            raise Refusal(name, f"be a whole number in [{low}, {high}]", text)
        return int(value)

    return read


def optional(read: Callable[[str, str], Any]) -> Callable[[str, str], Any]:
    """Return the reader of a field that may be empty, which is None."""
    return lambda name, text: None if not text.strip() else read(name, text)


def word(*allowed: str) -> Callable[[str, str], str]:
    """Return the reader of one of some words."""

    def read(name: str, text: str) -> str:
        refuse_if(text not in allowed, name, f"be one of {', '.join(allowed)}", text)
        return text

    return read


def read_fields(
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
            refused["page"] = str(Refusal("field", f"be one of {', '.join(how)}", name))
            continue
        try:
            read[name] = how[name](WORDS.get(name, name), text)
        except ValueError as error:
            refused[name] = str(error)
    return read, refused


def written(value: Any) -> str:
    """Write a field as text, with the fewest digits that give the value back."""
    if value is None:
        return ""
    if isinstance(value, Span):
        return f"{written(value.low)}:{written(value.high)}"
    if isinstance(value, tuple):
        return ",".join(value)
    return repr(value).removesuffix(".0") if isinstance(value, float) else str(value)


def parameters(text: str) -> dict[str, str]:
    """Return the parameters of a query string, without its version; raise Refused if the version is another."""
    if len(text) > MAX_ADDRESS:
        raise Refused({"page": f"link must have at most {MAX_ADDRESS} characters; got {len(text)}"})
    typed = dict(parse_qsl(text.removeprefix("?"), keep_blank_values=True, max_num_fields=None))
    version = typed.pop("version", str(VERSION))
    if version != str(VERSION):
        allowed = f"be {VERSION}, the version of the links of this explorer"
        raise Refused({"page": str(Refusal("version", allowed, version))})
    return typed
