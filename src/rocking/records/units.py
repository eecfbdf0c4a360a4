"""Units of acceleration: their spellings, and what the lines of a header state about them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rocking.model.block_formulas import GRAVITY
from rocking.model.validation import Refusal, WrongType

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


def header_units(lines: Sequence[str]) -> tuple[frozenset[str], frozenset[str]]:
    """Return the units of acceleration that a header states, and those that its other words mention.

    Stated are those of a line of units alone, and of a cell that speaks of acceleration or of units. Elsewhere, only what can be
    nothing else, such as m/s², counts as mentioned.

    Examples
    --------
    >>> [sorted(units) for units in header_units(["t acc_g", "recorded in G building, at most 3 m/s^2"])]
    [['g'], ['m/s²']]
    """
    stated, mentioned = [], []
    for line in lines:
        if is_line_of_units(line):
            stated += titles(line)
        for cell in SEPARATOR.split(line):
            named = IN_BRACKETS.findall(cell) + re.split(r"[\s_\"'=:()\[\]]+", cell)
            if word := SPEAKS.search(cell):
                stated += [each for each in named if not each.isalpha()] + IN_BRACKETS.findall(cell)
                stated += STATED.findall(cell[word.start() :])
            else:
                mentioned += [each for each in named if not each.isalpha()]
    return _units(stated), _units(mentioned)


def _units(texts: Sequence[str]) -> frozenset[str]:
    return frozenset(unit for unit in map(unit_of, texts) if unit is not None)


def only(named: frozenset[str]) -> str | None:
    """Return the unit that a header names; None if it names none, or several."""
    return next(iter(named)) if len(named) == 1 else None


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
