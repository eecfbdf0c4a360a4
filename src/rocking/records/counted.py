"""Text of other programs: lines of words, the number of samples and the time step, then the samples in lines of any length."""

from __future__ import annotations

import re
from typing import NamedTuple

from rocking.model.ground_motion import VERTICAL, is_vertical
from rocking.records.text_file import NUMBER, ROW, Channel, Peak, TextFile, in_plain_numbers
from rocking.records.units import header_units, unit_of

NAMED = re.compile(r"\bNPTS\s*=\s*([^,;\s]{1,40})[\s,;]*DT\s*=\s*([^,;\s]+)", re.IGNORECASE)
COMPONENT = re.compile(r"\bcomp(?:onent)?\b\.?\s*[:=,;\t]\s*([^,;]+)", re.IGNORECASE)
DIRECTION = re.compile(
    r"\b(?:channel|stream|direction|dir|orientation)\b\.?\s*[:=]\s*([^,;\d]+)(?![^,;])", re.IGNORECASE
)
"""Other words for a component; a value with digits names none."""
PEAK = re.compile(
    r"\b(?:pga|peak|max(?:imum)?)\b[^\d\[(:=,;]*(?:[\[(](?P<before>[^\[\]()]*)[\])])?\s*[:=,;]?\s*"
    rf"(?P<size>{NUMBER.pattern})(?:\s*(?P<after>[^\s()\[\],;]+))?",
    re.IGNORECASE,
)
"""Peak acceleration in words, as in PGA = 2.3 m/s2 or Peak acceleration (g): 0.23."""
COUNT = re.compile(r"[0-9]{1,12}")
HEADER_LINES = 100
FEWEST = 10
"""Whole numbers below it are samples, not numbers of samples."""


class _Counts(NamedTuple):
    """Place of the line after the counts, of their line, and their texts; no text of a step that the file does not state."""

    after: int
    line: int
    number: str
    step: str | None


def recognises(file: TextFile) -> bool:
    """Return whether the first numbers count those that follow them."""
    return _counts(in_plain_numbers(file)) is not None


def read(file: TextFile) -> list[Channel]:
    """Read the only channel."""
    file = in_plain_numbers(file)
    counts = _counts(file)
    assert counts is not None
    samples, _ = file.separated(counts.after, file.count(counts.line, counts.number))
    header = file.lines[: counts.after]
    units = header_units(header)
    name = next((line.strip() for line in header[: counts.line] if line.strip()), "")
    step = None if counts.step is None else file.step(counts.line, counts.step)
    component, peak = vertical_component(header), stated_peak(file, counts.after)
    return [Channel(samples, units.only(), step, "text", name, component, peak, header=units)]


def _counts(file: TextFile) -> _Counts | None:
    named: tuple[int, re.Match[str]] | None = None
    for index, line in enumerate(file.lines[: HEADER_LINES + 1]):
        if named is None and (match := NAMED.search(line)):
            named = index, match
        elif ROW.fullmatch(line):
            if named is None:
                return _unnamed(file, index)
            place, match = named
            # As many rows of several numbers as samples are columns.
            rows = [row for line in file.lines[index:] if (row := NUMBER.findall(line))]
            columns = str(len(rows)) == match.group(1) and len(rows[0]) > 1
            return None if columns else _Counts(index, place, *match.groups())
    return None


def _unnamed(file: TextFile, first: int) -> _Counts | None:
    """Return the counts in the first row of numbers, n dt or dt n, or in the first two, n and dt, or n alone."""
    head = NUMBER.findall(file.lines[first])
    if len(head) > 2 or not any(map(is_count, head)):
        return None
    rows = [NUMBER.findall(line) for line in file.lines[first + 1 :]]
    if len(head) == 2:
        pairs = ((count, step) for count, step in (head, head[::-1]) if is_count(count))
        count, step = next(pairs)
        columns = all(len(row) == 2 for row in rows if row)
        return None if columns or is_count(step) else _Counts(first + 1, first, count, step)
    total = sum(map(len, rows))
    second = next((k for k, row in enumerate(rows, 1) if row), 0)
    if total == int(head[0]) + 1 and len(rows[second - 1]) == 1:
        return _Counts(first + second + 1, first, head[0], rows[second - 1][0])
    return _Counts(first + 1, first, head[0], None) if total == int(head[0]) else None


def stated_peak(file: TextFile, after: int) -> Peak | None:
    """Return the first peak acceleration with its unit in the lines above the samples; None if they state none."""
    for index in range(after):
        for match in PEAK.finditer(file.lines[index]):
            if unit := unit_of(match["before"] or match["after"] or ""):
                return file.peak(index, match["size"], unit)
    return None


def vertical_component(lines: list[str]) -> str:
    """Return the vertical component that lines such as "Component: UP" name; empty if they name none, or another one, too.

    Lines such as "Channel: HNZ" count where there is none of these.
    """
    for pattern in (COMPONENT, DIRECTION):
        if named := [name.strip() for line in lines for name in pattern.findall(line)]:
            return named[0] if all(map(_is_vertical, named)) else ""
    return ""


def _is_vertical(name: str) -> bool:
    """Return whether a name after "Component:" is vertical: of letters alone Z only, for U and V may be anything."""
    return name.upper() == "Z" or (len(name) > 1 and is_vertical(name) and not re.search(r"\d", name))


def vertical_of(name: str) -> str:
    """Return a title that can only be that of a vertical component, and empty for others: a letter alone may be anything."""
    letters = name.replace("-", "").lower()
    return name if len(letters) > 1 and letters in VERTICAL else ""


def is_count(text: str) -> bool:
    """Return whether a text may be a number of samples."""
    return COUNT.fullmatch(text) is not None and int(text) >= FEWEST
