"""Text in one column of acceleration, or in two of time and acceleration, with or without a header."""

from __future__ import annotations

import re
from decimal import Decimal

import numpy as np

from rocking.model import counted, shown
from rocking.records.channel import Channel
from rocking.records.text_file import MAX_SAMPLES, NUMBER, TextFile
from rocking.records.units import unit_of

SEPARATORS = re.compile(r"\s*[,;]\s*|\s+")
COMMENT = re.compile(r"\s*(?:[#%!]|//|$)")
IN_BRACKETS = re.compile(r"[\[(]\s*([^\[\]()]+?)\s*[\])]")
AFTER_UNIT = re.compile(r"\bunits?\b(?:\s+(?:is|are|of|in)\b|\s*[:=])*\s*([^\s,;()\[\]]+)", re.IGNORECASE)
HEADER_LINES = 100
MAX_DIGITS = 17
DRIFT = 1e-3
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
    rows, places = [], []
    for index in range(first, len(file.lines)):
        if COMMENT.match(file.lines[index]):
            continue
        row = _parts(file.lines[index])
        if len(row) != width:
            raise file.error(
                index, f"{counted(width, 'number')} expected; got {shown(file.lines[index].strip())}"
            )
        rows.append(row)
        places.append(index)
    if len(rows) > MAX_SAMPLES:
        raise file.error(places[MAX_SAMPLES], f"more than {MAX_SAMPLES:,} samples")
    samples = np.array(
        [file.number(place, row[-1], "a sample") for place, row in zip(places, rows, strict=True)]
    )
    step = None if width == 1 else _step(file, places, [row[0] for row in rows])
    return [Channel(samples, _unit(file, first), step, "text")]


def _first_row(file: TextFile) -> int | None:
    for index, line in enumerate(file.lines[: HEADER_LINES + 1]):
        if not COMMENT.match(line) and len(_parts(line)) in (1, 2):
            return index
    return None


def _parts(line: str) -> list[str]:
    """Return the numbers of a line as text; none if it has anything else."""
    parts = SEPARATORS.split(line.strip())
    return parts if all(map(NUMBER.fullmatch, parts)) else []


def _unit(file: TextFile, first: int) -> str | None:
    """Return the only unit of acceleration that the header names in brackets, or after the word unit; None otherwise."""
    named = {
        unit_of(text)
        for line in file.lines[:first]
        for text in IN_BRACKETS.findall(line) + AFTER_UNIT.findall(line)
    }
    named.discard(None)
    return named.pop() if len(named) == 1 else None


def _step(file: TextFile, places: list[int], texts: list[str]) -> float:
    """Return the step of equidistant times, as the shortest decimal number that agrees with the printed times."""
    if len(texts) < 2:
        raise file.error(places[-1], "at least two times expected")
    times = np.array([file.number(place, text, "a time") for place, text in zip(places, texts, strict=True)])
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
