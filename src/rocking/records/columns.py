"""Text in one column of acceleration, or in two of time and acceleration, with or without a header."""

from __future__ import annotations

import re
from decimal import Decimal

import numpy as np

from rocking.model import counted, shown
from rocking.records.channel import Channel
from rocking.records.text_file import MAX_SAMPLES, NUMBER, TextFile
from rocking.records.units import (
    IN_BRACKETS,
    OTHER_TIMES,
    SEPARATOR,
    TIMES,
    header_units,
    is_line_of_units,
    is_other,
    only,
    titles,
)

ROW = re.compile(rf"\s*({NUMBER.pattern})(?:(?:\s*[,;]\s*|\s+)({NUMBER.pattern}))?\s*", re.ASCII)
COMMENT = re.compile(r"\s*(?:[#%!]|//|$)")
HEADER_LINES = 100
MAX_DIGITS = 17
DRIFT = 1e-2
"""Allowed deviation of a time, in steps, in addition to its rounding."""


def recognises(file: TextFile) -> bool:
    """Return whether one or two numbers follow at most `HEADER_LINES` lines of header."""
    return _first_row(file) is not None


def read(file: TextFile) -> list[Channel]:
    """Read the only channel."""
    first = _first_row(file)
    if first is None:
        raise file.error(0, "one or two numbers in a line expected")
    width = len(_parts(file.lines[first]))
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
    samples = file.numbers(places, [row[-1] for row in rows], "a sample")
    named, mentioned = header_units(file.lines[:first])
    _check_titles(file, first, width)
    step = None if width == 1 else _step(file, places, [row[0] for row in rows])
    return [Channel(samples, only(named or mentioned), step, "text", named=named, mentioned=mentioned)]


def _first_row(file: TextFile) -> int | None:
    return next((index for index, line in enumerate(file.lines[: HEADER_LINES + 1]) if _parts(line)), None)


def _parts(line: str) -> tuple[str, ...]:
    """Return the one or two numbers of a line as text; none if it has anything else."""
    match = ROW.fullmatch(line)
    if match is None:
        return ()
    first, second = match.groups()
    return (first,) if second is None else (first, second)


def _check_titles(file: TextFile, first: int, width: int) -> None:
    """Refuse columns whose titles or unit line state another quantity than acceleration, or times that are not in s."""
    for index in range(first):
        line = file.lines[index]
        cells = bracketed = IN_BRACKETS.findall(line)
        if not (width > 1 and len(bracketed) == width and bracketed[0].strip().lower() in TIMES):
            cells = titles(line)
            if len(cells) != width or not (SEPARATOR.search(line) or is_line_of_units(line)):
                continue  # words
        if is_other(cells[-1]):
            units = "m/s², cm/s², mm/s², g or gal"
            raise file.error(index, f"acceleration in {units} expected; the header gives {shown(cells[-1])}")
        if width > 1 and cells[0].lower() in OTHER_TIMES:
            raise file.error(index, f"times in s expected; the header gives {shown(cells[0])}")


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
    wrong = np.abs(times - even) > np.minimum(2 * rounding + DRIFT * step, step / 5)
    if wrong.any():
        at = int(np.argmax(wrong))
        raise file.error(
            places[at],
            f"the times are not equidistant: {texts[at]} s where {even[at]:.6g} s is expected, at a mean step of {step:.6g} s",
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
