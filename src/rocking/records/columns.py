"""Text in one column of acceleration, in two of time and acceleration, or in more under a line of titles."""

from __future__ import annotations

import re
from decimal import Decimal
from typing import NamedTuple

import numpy as np

from rocking.model import counted, shown
from rocking.records.channel import Channel
from rocking.records.text_file import MAX_SAMPLES, NUMBER, TextFile
from rocking.records.units import (
    IN_BRACKETS,
    OTHER_TIMES,
    SEPARATOR,
    TIMES,
    are_units,
    cells,
    header_units,
    is_line_of_units,
    is_other,
    only,
    titles,
    unit_of,
)

ROW = re.compile(rf"\s*+{NUMBER.pattern}(?:(?:\s*+[,;]\s*+|\s++){NUMBER.pattern})*+\s*+", re.ASCII)
COMMENT = re.compile(r"\s*(?:[#%!]|//|$)")
TIME = re.compile(r"(?:t|times?|s|sec|secs|seconds?)(?![^\W_])", re.IGNORECASE)
NO_ACCELERATION = re.compile(r"(?:vel|disp)", re.IGNORECASE)
"""Beginning of the title of a column that is left out."""
HEADER_LINES = 100
MAX_DIGITS = 17
DRIFT = 1e-2
"""Allowed deviation of a time, in steps, in addition to its rounding."""


class Title(NamedTuple):
    """Title of a column of acceleration."""

    place: int
    """Number of the column, counted from 0."""
    name: str
    unit: str | None


def recognises(file: TextFile) -> bool:
    """Return whether the first row after at most `HEADER_LINES` lines of header has one or two numbers, or titles."""
    return not unlike(file)


def unlike(file: TextFile) -> str:
    """Return what a text without readable columns has instead, with the line; empty for columns."""
    first = _first_row(file)
    if first is None:
        found = next((index for index, line in enumerate(file.lines) if line.strip()), 0)
        got = shown(file.lines[found].strip())
        if ";" in got and re.search(r"\d,\d", got):
            return f", line {found + 1}: numbers with a decimal point expected; got {got}"
        return f": neither a record nor a table with a column 'file'; it begins with {got}"
    width = len(_parts(file.lines[first]))
    if width <= 2 or _heads(file, first, width):
        return ""
    rule = "more than two need a line of titles that begins with the time, such as time,NS,EW"
    return f", line {first + 1}: {width} numbers in a line; {rule}"


def read(file: TextFile) -> list[Channel]:
    """Read the only channel, or one for each title."""
    first = _first_row(file)
    if first is None:
        raise file.error(0, "one or two numbers in a line expected")
    width = len(_parts(file.lines[first]))
    places, rows = _rows(file, first, width)
    named, mentioned = header_units(file.lines[:first])
    if width <= 2:
        _check_titles(file, first, width)
        columns = [Title(width - 1, "", None)]
    else:
        columns = _titles(file, first, width)
    step = None if width == 1 else _step(file, places, [row[0] for row in rows])
    found = []
    for column in columns:
        samples = file.numbers(places, [row[column.place] for row in rows], "a sample")
        stated = frozenset([column.unit]) if column.unit else named
        channel = Channel(samples, only(stated or mentioned), step, "text", component=column.name)
        found.append(channel._replace(named=stated, mentioned=mentioned))
    return found


def _rows(file: TextFile, first: int, width: int) -> tuple[list[int], list[list[str]]]:
    """Return the lines with numbers, and their numbers as text."""
    places, rows = [], []
    for index in range(first, len(file.lines)):
        row = _parts(file.lines[index])
        if len(row) == width:
            places.append(index)
            rows.append(row)
        elif not COMMENT.match(file.lines[index]):
            raise file.error(
                index, f"{counted(width, 'number')} expected; got {shown(file.lines[index].strip())}"
            )
    if len(rows) > MAX_SAMPLES:
        raise file.error(places[MAX_SAMPLES], f"more than {MAX_SAMPLES:,} samples")
    return places, rows


def _first_row(file: TextFile) -> int | None:
    return next((index for index, line in enumerate(file.lines[: HEADER_LINES + 1]) if _parts(line)), None)


def _parts(line: str) -> list[str]:
    """Return the numbers of a line as text; none if it has anything else, or a decimal comma."""
    return [] if ("," in line and ";" in line) or not ROW.fullmatch(line) else NUMBER.findall(line)


def _heads(file: TextFile, first: int, width: int) -> list[list[str]]:
    """Return the cells of the last line of titles that begins with the time, and those of a line of units; none without titles."""
    lines = [found for line in file.lines[:first] if len(found := cells(line)) == width]
    units = [[cell.strip("[]() ") for cell in each] for each in lines]
    heads = [
        each for each, plain in zip(lines, units, strict=True) if TIME.match(each[0]) and not are_units(plain)
    ]
    return [heads[-1], next(filter(are_units, units), heads[-1])] if heads else []


def _titles(file: TextFile, first: int, width: int) -> list[Title]:
    """Return the titles of the columns of acceleration."""
    head, below = _heads(file, first, width)
    units = [(IN_BRACKETS.findall(cell) or [cell])[-1].strip() for cell in below]
    found = [
        Title(place, IN_BRACKETS.sub("", head[place]).strip(), unit_of(units[place]))
        for place in range(1, width)
        if not (is_other(units[place]) or NO_ACCELERATION.match(head[place]))
    ]
    if not found:
        raise file.error(first, "no column of acceleration")
    if units[0].lower() in OTHER_TIMES:
        raise file.error(first, f"times in s expected; the header gives {shown(units[0])}")
    return found


def _check_titles(file: TextFile, first: int, width: int) -> None:
    """Refuse columns whose titles or unit line state another quantity than acceleration, or times that are not in s."""
    for index in range(first):
        line = file.lines[index]
        found = bracketed = IN_BRACKETS.findall(line)
        if not (width > 1 and len(bracketed) == width and bracketed[0].strip().lower() in TIMES):
            found = titles(line)
            if len(found) != width or not (SEPARATOR.search(line) or is_line_of_units(line)):
                continue  # words
        if is_other(found[-1]):
            units = "m/s², cm/s², mm/s², g or gal"
            raise file.error(index, f"acceleration in {units} expected; the header gives {shown(found[-1])}")
        if width > 1 and found[0].lower() in OTHER_TIMES:
            raise file.error(index, f"times in s expected; the header gives {shown(found[0])}")


def _step(file: TextFile, places: list[int], texts: list[str]) -> float:
    """Return the step of equidistant times, as the shortest decimal number that agrees with the printed times."""
    if len(texts) < 2:
        raise file.error(places[-1], "at least two times expected")
    times = file.numbers(places, texts, "a time")
    rounding = _rounding(texts)
    step = float(times[-1] - times[0]) / (len(times) - 1)
    if not step > 0:
        raise file.error(places[-1], "the times must increase")
    even = times[0] + step * np.arange(len(times))
    tolerance = np.minimum(2 * rounding + DRIFT * step, step / 5)
    wrong = np.abs(times - even) > tolerance
    if wrong.any():
        steps = np.diff(times)
        most = float(np.median(steps))
        uneven = np.abs(steps - most) > 2 * tolerance[1:]
        at = int(np.argmax(uneven if uneven.any() else wrong[1:])) + 1
        raise file.error(
            places[at],
            f"the times are not equidistant: {texts[at]} s follows {texts[at - 1]} s, and most steps are {most:.6g} s",
        )
    allowed = float(rounding.max()) / (len(times) - 1)
    shorter = (float(f"{step:.{digits}g}") for digits in range(1, MAX_DIGITS))
    return next((value for value in shorter if abs(value - step) <= allowed), step)


def _rounding(texts: list[str]) -> np.ndarray:
    """Return half a unit of the last digit of each time.

    Programs leave out the last zeros of a decimal number, but not of one with an exponent.
    """
    plain = [
        len(text.partition(".")[2])
        for text in texts
        if text.isascii() and text.lstrip("+-").replace(".", "").isdigit()
    ]
    finest = 0.5 * 10.0 ** -max(plain, default=0)
    if len(plain) == len(texts):
        return np.full(len(texts), finest)
    exponents = [int(Decimal(re.sub("[Dd]", "e", text)).as_tuple().exponent) for text in texts]
    return np.array([0.5 * 10.0 ** min(exponent, 0) for exponent in exponents])
