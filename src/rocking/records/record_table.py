"""Table of record files: one row per file, with channel, factor, unit and data about each."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from rocking.model import shown
from rocking.records.channel import RecordError
from rocking.records.content import Content
from rocking.records.text_file import TextFile

FILE = "file"
OWN = (FILE, "channel", "scale", "units", "step", "name")
"""Columns with a meaning of their own. Each other column holds a number per row."""
DELIMITERS = ",;\t"


class Row(NamedTuple):
    """Row of a table; None for an empty cell."""

    place: str
    """Name of the table and line, for messages."""
    path: Path
    channel: int | None
    scale: float | None
    units: str | None
    step: float | None
    name: str
    numbers: dict[str, float]
    """Values of the other columns; NaN for an empty cell."""


def is_table(path: Path) -> bool:
    """Return whether the first line of a file names a column `file`."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        first = file.readline(10_000).decode("utf-8-sig", "replace")
    return _delimiter(first) is not None


def rows(path: Path) -> list[Row]:
    """Return the rows of a table; `RecordError` with the line of the first wrong cell."""
    text = TextFile(Content(path))
    lines = csv.reader(text.lines, delimiter=_delimiter(text.lines[0]) or ",")
    heads = [cell.strip() for cell in next(_cells(lines, text.name))]
    heads = [head.lower() if head.lower() in OWN else head for head in heads]
    for number, head in enumerate(heads):
        if not head or head in heads[:number]:
            raise RecordError(
                f"{text.name}: columns must have distinct names; got {shown(head)} in column {number + 1}"
            )
    found = []
    for cells in _cells(lines, text.name):
        if any(cell.strip() for cell in cells):
            place = f"{text.name}, line {lines.line_num}"
            if len(cells) > len(heads):
                raise RecordError(
                    f"{place}: {len(cells)} cells under {len(heads)} columns; put a text with commas in quotes"
                )
            given = dict.fromkeys(heads, "") | {
                head: cell.strip() for head, cell in zip(heads, cells, strict=False)
            }
            found.append(_row(place, path.parent, given))
    if not found:
        raise RecordError(f"{text.name}: the table has no rows")
    return found


def _cells(lines: Any, name: str) -> Iterator[list[str]]:
    """Yield the cells of each row; `RecordError` for one that the CSV format forbids, such as a quote without its end."""
    try:
        yield from lines
    except csv.Error as error:
        raise RecordError(f"{name}, line {lines.line_num}: {error}; check the quotes") from error


def _delimiter(first: str) -> str | None:
    """Return the delimiter of a first line with a cell `file`; None without one."""
    cells = {each: [cell.strip(' "\r\n').lower() for cell in first.split(each)] for each in DELIMITERS}
    return next(
        (each for each in DELIMITERS if len(cells[each]) > 1 and FILE in cells[each]),
        "," if cells[","] == [FILE] else None,
    )


def _row(place: str, folder: Path, cells: dict[str, str]) -> Row:
    if not cells[FILE]:
        raise RecordError(f"{place}: the column 'file' is empty; give the path of a record file")
    channel = _number(place, "channel", cells.get("channel", ""))
    if not math.isnan(channel) and not (channel >= 1 and channel == int(channel)):
        raise RecordError(f"{place}: channel must be a whole number from 1; got {cells['channel']}")
    scale = _number(place, "scale", cells.get("scale", ""))
    if scale == 0.0:
        raise RecordError(f"{place}: scale must not be 0; leave the cell empty for the record as it is")
    step = _number(place, "step", cells.get("step", ""))
    return Row(
        place,
        folder / cells[FILE],
        None if math.isnan(channel) else int(channel),
        None if math.isnan(scale) else scale,
        cells.get("units") or None,
        None if math.isnan(step) else step,
        " ".join(cells.get("name", "").split()),
        {head: _number(place, head, cell) for head, cell in cells.items() if head not in OWN},
    )


def _number(place: str, head: str, cell: str) -> float:
    """Return the finite number in a cell, or NaN for an empty one."""
    if not cell:
        return math.nan
    try:
        value = float(cell)
    except ValueError:
        value = math.inf
    if not np.isfinite(value):
        way_out = "" if head in OWN else "; remove the column if it is no number of each record"
        raise RecordError(f"{place}: column {head!r} must hold numbers; got {shown(cell)}{way_out}")
    return value
