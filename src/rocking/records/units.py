"""Units of acceleration: their spellings, and what the lines of a header state about them."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any, NamedTuple

from rocking.model.block_formulas import GRAVITY
from rocking.model.validation import RecordError, Refusal, WrongType

UNITS = {"m/s²": 1.0, "cm/s²": 0.01, "mm/s²": 0.001, "g": GRAVITY, "g/10": GRAVITY / 10}
"""Size of each unit of acceleration, in m/s²."""
SPELLINGS = {
    "m/s2": "m/s²",
    "ms-2": "m/s²",
    "cm/s2": "cm/s²",
    "cms-2": "cm/s²",
    "gal": "cm/s²",
    "gals": "cm/s²",
    "mm/s2": "mm/s²",
    "mms-2": "mm/s²",
    "g": "g",
    "g/10": "g/10",
}
"""Spellings of the units, in lower case and after `_plain`."""
OTHER_UNITS = {
    "m/s",
    "cm/s",
    "mm/s",
    "m",
    "cm",
    "mm",
    "counts",
    "v",
    "mv",
    "mg",
    "%g",
    "ft/s2",
    "in/s2",
    "nm/s2",
    "um/s2",
}
"""Units of other quantities, and of acceleration in units that are not read, after `_plain`."""
TIMES = {"s", "sec", "secs", "second", "seconds"}
OTHER_TIMES = {
    "ms",
    "msec",
    "millisec",
    "millisecs",
    "millisecond",
    "milliseconds",
    "min",
    "minutes",
    "h",
    "hours",
    "us",
    "µs",
}
SEPARATOR = re.compile(r"[,;\t|]")
IN_BRACKETS = re.compile(r"[\[(]([^\[\]()]++)[\])]")
BETWEEN_BLANKS = re.compile(r"[^\s\[(]++(?:\s*+[\[(][^\[\]()]*+[\])])?+|\S")
WORD = re.compile(r"\S+")
SPEAKS = re.compile(
    r"(?<![^\W_])(?:acc(?:el(?:erations?)?)?(?![^\W_])|units?(?![^\W_])|a(?=[\s_]*(?:[\[(]|in\b)))",
    re.IGNORECASE,
)
"""Word of a cell of a header that speaks of acceleration, or of units."""
STATED = re.compile(
    r"(?:^[a-z]+[\s_.:=]+|\bin\s+|\bunits?(?:\s+(?:is|are|of|in)\b|\s*[:=])+\s*)([^\s()\[\]\"]{1,20})[\s)\]\"]*$",
    re.IGNORECASE,
)
"""Unit at the end of such a cell: acc g, acceleration in g, units of g."""
SIZE = r"[-+]?\d[\d.]*+(?:e[-+]?\d+)?\s++([^\s()\[\],;]++)"
QUANTITY = re.compile(rf"(?<![\w.]){SIZE}", re.IGNORECASE)
"""Number and the word after it, a unit perhaps."""
SIZE_OF_G = re.compile(
    r"[(\[]?(?:(?:\b1?\s*+g\s*+[=:]|=)\s*+)?(?<![\d.])(?P<size>9(?:\.8\d*|8[01](?:\.\d*)?))\s*([^\s()\[\],;\d.]+\d?)[)\]]?",
    re.IGNORECASE,
)
"""Size of g with its unit, as in (1 g = 9.81 m/s2)."""
FACTOR = re.compile(
    r"(?:[(\[]|\bin)\s*+(?:[x×*]\s*+\d[\d.]*+|10\^[-+]?\d+|0?\.0*1|10+|1e[-+]?\d+)\s++([^\s()\[\],;]++)",
    re.IGNORECASE,
)
"""Factor in the place of a unit, with the unit after it, as in (0.01 m/s2)."""
CONVERSION = re.compile(
    r"[(\[]?\b(?:(?:multiply|divide|be multiplied|be divided) by|to convert|factor to|original units?)\b"
    r"(?:(?!\. |: | - )[^()\[\],;])*+",
    re.IGNORECASE,
)
"""Words on other units than those of the samples."""
OTHER_SAMPLES = re.compile(
    r"\b(?:from|(?:range|trigger|threshold|sensitivity|resolution)(?: level)?\s*[:=]?\s*[-+]?[\d.]++)\s+([^\s,;]++)",
    re.IGNORECASE,
)
"""Unit of the samples before a conversion, or of a number of the instrument."""
LABEL = re.compile(r"[\[(][^\[\]()]*[\])]\s*[=:]\s*[-+]?[\d.]++(?:e[-+]?\d+)?(?:\s+at\b|\s*$)", re.IGNORECASE)
"""Unit and value of a quantity of the header, as in Peak acceleration (g): 0.35."""
CHOICES = "be one of 'm/s²', 'cm/s²', 'mm/s²', 'g', 'gal'"


def _plain(text: str) -> str:
    """Return a spelling without blanks, powers and long seconds: CM/SEC/SEC → cm/s2."""
    text = re.sub(r"[\s^*]", "", text.lower()).rstrip(".").replace("²", "2").replace("−", "-")
    return text.replace("sec", "s").replace("cms/", "cm/").replace("/s/s", "/s2")


def unit_of(text: str) -> str | None:
    """Return the unit of acceleration that a text names; None if it is unknown.

    Examples
    --------
    >>> unit_of("CM/SEC/SEC"), unit_of("Gal"), unit_of("m/s**2"), unit_of("cm/s")
    ('cm/s²', 'cm/s²', 'm/s²', None)
    """
    return SPELLINGS.get(_plain(text))


class HeaderUnits(NamedTuple):
    """Units of acceleration in a header that has no fixed place for the unit."""

    named: frozenset[str] = frozenset()
    """Units that the header states, also where several leave the unit open."""
    mentioned: frozenset[str] = frozenset()
    """Units that its other words mention."""
    lacking: str = ""
    """Sentence on the missing line that would state the unit; empty if no line is missing."""

    def only(self) -> str | None:
        """Return the unit that the header states or, if it states none, mentions; None if there is none, or several."""
        units = self.named or self.mentioned
        return next(iter(units)) if len(units) == 1 else None


def header_units(lines: Sequence[str]) -> HeaderUnits:
    """Return the units of acceleration in the lines of a header.

    Stated are those of a line of units alone, and of a cell that speaks of acceleration or of units. Elsewhere, only what can be
    nothing else, such as m/s², counts as mentioned. The unit of a factor, of a conversion, of an instrument, of a number after one
    in g, and in g = 9.81 m/s2 is not that of the samples.

    Examples
    --------
    >>> units = header_units(["t acc_g", "recorded in G building, at most 3 m/s^2"])
    >>> sorted(units.named), sorted(units.mentioned)
    (['g'], ['m/s²'])
    """
    stated, mentioned = [], []
    for line in lines:
        if is_line_of_units(line):
            stated += titles(line)
        other = QUANTITY if _begins_in_g(line) else FACTOR
        own = CONVERSION.sub(" ", OTHER_SAMPLES.sub(_without_unit, SIZE_OF_G.sub(_without_g, line)))
        for cell in SEPARATOR.split(other.sub(_without_unit, own)):
            named = IN_BRACKETS.findall(cell) + re.split(r"[\s_\"'=:()\[\]]+", cell)
            if LABEL.search(cell):
                mentioned += IN_BRACKETS.findall(cell)
            elif word := SPEAKS.search(cell):
                stated += [each for each in named if not each.isalpha()] + IN_BRACKETS.findall(cell)
                stated += STATED.findall(cell[word.start() :])
            else:
                mentioned += [each for each in named if not each.isalpha()]
    return HeaderUnits(_units(stated), _units(mentioned))


def _begins_in_g(line: str) -> bool:
    """Return whether the first number of a line with a unit of acceleration is one in g."""
    units = filter(None, (unit_of(quantity[1]) for quantity in QUANTITY.finditer(line)))
    return next(units, "") == "g"


def _without_unit(quantity: re.Match[str]) -> str:
    """Return a match of `QUANTITY`, `FACTOR` or `OTHER_SAMPLES` as it is, or a blank if its word is a unit."""
    return quantity[0] if unit_of(quantity[1]) is None else " "


def _without_g(size: re.Match[str]) -> str:
    """Return a blank for the size of g, and a match of `SIZE_OF_G` in another unit as it is."""
    unit = unit_of(size[2])
    is_g = unit is not None and math.isclose(float(size["size"]) * UNITS[unit], GRAVITY, rel_tol=2e-3)
    return " " if is_g else size[0]


def _units(texts: Sequence[str]) -> frozenset[str]:
    return frozenset(unit for unit in map(unit_of, texts) if unit is not None)


def titles(line: str) -> list[str]:
    """Return what the cells of a header line hold in brackets, or all of a cell without brackets.

    Examples
    --------
    >>> titles("# time (s); acceleration (m/s²)"), titles("s  g")
    (['s', 'm/s²'], ['s', 'g'])
    """
    return [(IN_BRACKETS.findall(cell) or [cell])[-1].strip() for cell in _split(line, WORD)]


def is_other(text: str) -> bool:
    """Return whether a text is a unit in which acceleration is not read, such as cm/s."""
    return _plain(text) in OTHER_UNITS


def is_line_of_units(line: str) -> bool:
    """Return whether a line holds units alone, such as "s,g"."""
    return all(
        unit_of(text) or is_other(text) or text.lower() in (*TIMES, *OTHER_TIMES) for text in titles(line)
    )


def cells(line: str) -> list[str]:
    """Return the cells of a line of titles: between separators or, without one, between blanks outside brackets.

    Examples
    --------
    >>> cells("time (s), NS (g)"), cells("# t [s]  NS [g]")
    (['time (s)', 'NS (g)'], ['t [s]', 'NS [g]'])
    """
    return _split(line, BETWEEN_BLANKS)


def _split(line: str, word: re.Pattern[str]) -> list[str]:
    plain = line.strip().lstrip("#%!/").replace('"', "")
    result = SEPARATOR.split(plain) if SEPARATOR.search(plain) else word.findall(plain)
    return [cell.strip() for cell in result]


def given_unit(units: str) -> str:
    """Return the unit that the argument `units` names; TypeError or ValueError for anything else."""
    if not isinstance(units, str):
        raise WrongType("units", CHOICES, units)
    result = unit_of(units)
    if result is None:
        raise Refusal("units", CHOICES, units)
    return result


def unit_of_samples(
    place: str, unit: str | None, header: HeaderUnits, given: str | None
) -> tuple[str, list[str]]:
    """Return the unit of the samples of a channel, and a sentence on each doubt about it.

    It is the unit that the file states, or the argument `units`, `given`; `RecordError`, which begins with `place`, if they contradict
    each other, or if there is none.
    """
    named, mentioned = (" and ".join(sorted(units)) for units in (header.named, header.mentioned))
    messages = []
    if given not in header.named:
        if len(header.named) > 1:
            rejected = f", not {given}" if given else ""
            raise RecordError(
                f"{place}: the header names the units {named}{rejected}; give one of them as units"
            )
        if given and header.named:
            raise RecordError(
                f"{place}: the header names {named}; omit units, or correct the header", "units"
            )
    elif len(header.named) > 1:
        messages.append(f"units={given!r} is used; the header names {named}")
    if given and header.mentioned and not header.named:
        unit = None
        if given not in header.mentioned:
            messages.append(f"units={given!r} is used, though the header mentions {mentioned}")
    where, example = (f"{place}: {header.lacking}", "g") if header.lacking else (place, "m/s²")
    return stated_once(where, "units", unit, given, "the unit of its samples", example), messages


def stated_once(place: str, argument: str, stated: Any, value: Any, what: str, example: str) -> Any:
    """Return what the file states or the argument gives; `RecordError` unless exactly one does."""
    if stated is None and value is None:
        example_text = repr(example) if argument == "units" else example
        raise RecordError(
            f"{place}: the file does not state {what}; give it, for example {argument}={example_text}",
            argument,
        )
    if stated is not None and value is not None:
        raise RecordError(f"{place}: the file states {what}, {stated}; do not give {argument}", argument)
    return value if stated is None else stated
