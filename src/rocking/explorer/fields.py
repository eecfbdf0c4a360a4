"""Fields of a view: their readers, labels and messages, and the link that holds them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any, ClassVar, Self
from urllib.parse import parse_qsl, urlencode

import attrs
from attrs import frozen

from rocking.model.quantity import Quantity
from rocking.model.validation import Refusal, refuse_if

VERSION = 1
"""Version of links; increased when an earlier link would show a different view."""
MAX_LENGTH = 40
"""Maximum number of characters of a number."""
ALONE = "write the number alone, in the unit beside the field"
MAX_ADDRESS = 2000
"""Maximum number of characters of a link."""

Reader = Callable[[str, str], Any]
"""Function of the name and the text of a field that returns its value, or raises Refusal."""


class Refused(ValueError):
    """Invalid input: `fields` holds one error message per field."""

    def __init__(self, fields: Mapping[str, str]) -> None:
        super().__init__("; ".join(fields.values()))
        self.fields = dict(fields)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.fields,), self.__dict__


class Missing(Refusal):
    """Empty field that needs a value."""

    def _sentence(self, argument: str) -> str:
        return f"give the {argument}"


@frozen
class Span:
    """Range of an axis, from `low` to `high`."""

    low: float
    high: float

    @property
    def width(self) -> float:
        """Length of the range."""
        return self.high - self.low


# ---- readers


def _text(name: str, text: str) -> str:
    """Return the text without surrounding spaces; raise Missing if it is empty."""
    if not text.strip():
        raise Missing(name, "")
    return text.strip()


def number(low: float, high: float) -> Reader:
    """Return the reader of a number in a range."""

    def read(name: str, text: str) -> float:
        _text(name, text)
        allowed = f"be a number in [{low:.6g}, {high:.6g}]"
        try:
            value = float(text) if len(text) <= MAX_LENGTH else math.nan
        except ValueError:
            value = math.nan
        remedy = ALONE if text.strip()[0].isdigit() and text.strip()[-1].isalpha() else ""
        refuse_if(not low <= value <= high, name, allowed, text, remedy)
        return value + 0.0  # no negative zero

    return read


def count(low: int, high: int) -> Reader:
    """Return the reader of a whole number in a range."""

    def read(name: str, text: str) -> int:
        value = _text(name, text)
        if not (value.isascii() and value.isdigit() and len(value) < 10 and low <= int(value) <= high):
            raise Refusal(name, f"be a whole number in [{low}, {high}]", text)
        return int(value)

    return read


def optional(read: Reader) -> Reader:
    """Return the reader of a field that may be empty, which is None."""
    return lambda name, text: None if not text.strip() else read(name, text)


def word(*allowed: str) -> Reader:
    """Return the reader of one of some words."""

    def read(name: str, text: str) -> str:
        refuse_if(text not in allowed, name, f"be one of {', '.join(allowed)}", text)
        return text

    return read


def words(*allowed: str) -> Reader:
    """Return the reader of any of some words, which are returned in this order."""
    one = word(*allowed)

    def read(name: str, text: str) -> tuple[str, ...]:
        chosen = {one(name, each) for each in text.split(",") if each}
        return tuple(each for each in allowed if each in chosen)

    return read


def span(low: float, high: float, fits: Callable[[Span], bool], ends: str) -> Reader:
    """Return the reader of a range LOW:HIGH whose ends fit; `ends` describes them in the message."""
    end = number(low, high)

    def read(name: str, text: str) -> Span:
        first, _, last = text.partition(":")
        value = Span(end(name, first), end(name, last))
        refuse_if(not fits(value), name, f"be LOW:HIGH, with {ends}", text)
        return value

    return read


def read_fields(
    readers: Mapping[str, Reader], typed: Mapping[str, str], labels: Mapping[str, str]
) -> tuple[dict[str, Any], dict[str, str]]:
    """Read fields.

    Returns
    -------
    tuple of (dict, dict)
        Values by name, and error messages by name.
    """
    read, refused = {}, {}
    for name, text in typed.items():
        if name not in readers:
            refused["page"] = str(Refusal("field", f"be one of {', '.join(readers)}", name))
            continue
        try:
            read[name] = readers[name](name, text)
        except Refusal as error:
            refused[name] = str(error.of(labels))
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


# ---- fields of a view


@frozen
class Field:
    """Field of a view: its reader, its label in messages, and what the page says: symbol, words, unit, description, group.

    `only` names the units in which the page shows it, if not in all: "normalised" or "si". `si` is what it says in SI, if that differs.
    """

    read: Reader
    label: str = ""
    symbol: str = ""
    words: str = ""
    unit: str = ""
    title: str = ""
    group: str = ""
    only: str = ""
    si: Field | None = None


def entry(default: Any, read: Reader, label: str = "", **shown: Any) -> Any:
    """Return an attribute of a view that is a field."""
    return attrs.field(default=default, metadata={"field": Field(read, label, **shown)})


IN_SI = str.maketrans({"Θ": "θ", "A": "a", "′": "̇"})
"""Characters of the symbols of quantities in SI, in place of those of normalised quantities."""


def quantity(of: Quantity, default: Any, read: Reader | None = None, **shown: str) -> Any:
    """Return an attribute of a view that is a field of a quantity, with its range, label, symbol, unit and description."""
    label = of.name.replace("_", " ")
    described = {
        "symbol": of.symbol,
        "words": label,
        "unit": of.unit.replace("theta_cr", "θcr").replace("alpha", "α"),
        "title": of.help.partition(" Default:")[0].rstrip("."),
    }
    described |= shown
    read = read or number(*of.range)
    si = None
    if of.si is not None:
        words = described["words"].replace("amplitude", of.si.name)
        symbol = described["symbol"].translate(IN_SI)
        title = f"{words[0].upper()}{words[1:]}, in {of.si.drawn_unit}"
        si = Field(read, symbol=symbol, words=words, unit=of.si.drawn_unit, title=title)
    return entry(default, read, label, si=si, **described)


def axis(default: Span, low: float, high: float, fits: Callable[[Span], bool], ends: str) -> Any:
    """Return an attribute of a view that is a field of the range of an axis, as in `span`."""
    return entry(default, span(low, high, fits, ends))


@frozen
class View:
    """View of a session as one frozen value. Its attributes made by `entry` and `quantity` are fields of the page."""

    LINKED: ClassVar[tuple[str, ...]] = ()
    """Fields that a link always holds; it holds others if they differ from their defaults."""
    GROUPS: ClassVar[tuple[str, ...]] = ()
    """Headings of the groups of fields, from top to bottom."""
    EXTRA: ClassVar[Mapping[str, Field]] = {}
    """Fields of the page that are no attributes."""
    LABELS: ClassVar[Mapping[str, str]] = {}
    """Labels of arguments that are not fields, in messages."""

    def checked(self) -> Self:
        """Return the view, or one that it stands for; raise Refused if its fields do not fit each other."""
        return self

    @classmethod
    @cache
    def declared(cls) -> dict[str, Field]:
        """Return the fields by name."""
        metadata = {each.name: each.metadata for each in attrs.fields(cls)}
        return {name: each["field"] for name, each in metadata.items() if "field" in each}

    @classmethod
    @cache
    def groups(cls) -> dict[str, dict[str, Field]]:
        """Return the fields that the page shows, by group and name."""
        declared = cls.declared().items()
        first = sorted((*declared, *cls.EXTRA.items()), key=lambda each: each[1].only != "si")
        return {group: {name: each for name, each in first if each.group == group} for group in cls.GROUPS}

    @classmethod
    @cache
    def readers(cls) -> dict[str, Reader]:
        """Return the reader of each field."""
        return {name: each.read for name, each in cls.declared().items()}

    @classmethod
    @cache
    def labels(cls) -> dict[str, str]:
        """Return the labels of fields in messages, where they differ from the names."""
        return {name: each.label for name, each in cls.declared().items() if each.label} | dict(cls.LABELS)

    @classmethod
    def refused(cls, error: Refusal) -> Refused:
        """Return the refusal of an argument as that of its field, with the label of the field."""
        if error.argument == "restitution":  # Housner's value, which follows from height and width
            remedy = "make the block narrower or taller"
            return Refused({"width": str(Refusal(error.argument, error.allowed, error.value, remedy))})
        return Refused({error.argument.removesuffix("_g"): str(error.of(cls.labels()))})

    @property
    def fields(self) -> dict[str, str]:
        """Text of each field in a link."""
        return {name: written(getattr(self, name)) for name in self.declared()}

    @property
    def shown(self) -> dict[str, str]:
        """Text of each field on the page."""
        return self.fields

    def changed(self, typed: Mapping[str, str]) -> Self:
        """Return the view with new values of some fields.

        Parameters
        ----------
        typed : mapping of str to str
            Field names and their text.

        Raises
        ------
        Refused
            If a field is invalid, with one message per field.
        """
        read, refused = read_fields(self.readers(), typed, self.labels())
        if refused:
            raise Refused(refused)
        return attrs.evolve(self, **read).checked()

    @property
    def address(self) -> str:
        """Query string of the view."""
        start = type(self)()
        parts = {
            name: text
            for name, text in self.fields.items()
            if name in self.LINKED or getattr(self, name) != getattr(start, name)
        }
        return urlencode({"version": str(VERSION)} | parts, safe=":,/")

    @classmethod
    def from_address(cls, text: str) -> tuple[Self, dict[str, str]]:
        """Return the view of a query string; invalid parameters keep their defaults.

        Returns
        -------
        tuple of (View, dict of str)
            View, and an error message for each invalid parameter.
        """
        try:
            read, refused = read_fields(cls.readers(), _parameters(text), cls.labels())
        except Refused as unread:
            return cls(), unread.fields
        while True:
            try:
                return cls(**read).checked(), refused
            except Refused as unfit:
                refused |= unfit.fields
                rest = {name: value for name, value in read.items() if name not in unfit.fields}
                read = rest if len(rest) < len(read) else {}


def _parameters(text: str) -> dict[str, str]:
    """Return the parameters of a query string, without its version; raise Refused if the version is another."""
    if len(text) > MAX_ADDRESS:
        raise Refused({"page": f"link must have at most {MAX_ADDRESS} characters; got {len(text)}"})
    typed = dict(parse_qsl(text.removeprefix("?"), keep_blank_values=True, max_num_fields=None))
    version = typed.pop("version", str(VERSION))
    if version != str(VERSION):
        allowed = f"be {VERSION}, the version of the links of this explorer"
        raise Refused({"page": str(Refusal("version", allowed, version))})
    return typed
