"""Lines of a record file, and the numbers in them; errors name the file and the line."""

from __future__ import annotations

import math
import re
from decimal import Decimal

import numpy as np

from rocking.model import counted, shown
from rocking.records.channel import Peak, RecordError
from rocking.records.content import Content
from rocking.records.units import UNITS, unit_of

# No expression here or in a reader may try a blank or a digit in two places: see MAX_LINE.
NUMBER = re.compile(r"[-+]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[EeDd][-+]?\d{1,4}(?!\d))?", re.ASCII)
SEPARATE = re.compile(rf"(?:(?<![^\s,])|(?=[-+])){NUMBER.pattern}", re.ASCII)
"""A number after a blank, a comma or nothing, or with a sign."""
MAX_SAMPLES = 10_000_000
MAX_LINE = 10_000
"""Largest number of characters of a line. The time to read a line is proportional to its length."""
INCOMPLETE = "it is incomplete: download it again"
MAX_DIGITS = 3
"""Number of digits of each number in a format such as (8F10.3)."""


class TextFile:
    """Lines of a file, counted from 0; messages count them from 1."""

    def __init__(self, content: Content) -> None:
        self.name = " ".join(content.name.split())
        data = content.data.rstrip(b"\x1a\r\n\t ")  # DOS ends a text by the byte 1a
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
        self.lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        for index, line in enumerate(self.lines):
            if len(line) > MAX_LINE:
                rule = f"a line must have at most {MAX_LINE:,} characters; got {len(line):,}"
                raise self.error(index, f"{rule}; put each sample on a line of its own")

    def error(self, line: int, what: str) -> RecordError:
        """Return the error for a line."""
        return RecordError(f"{self.name}, line {line + 1}: {what}")

    def line(self, index: int) -> str:
        """Return a line; `RecordError` beyond the last."""
        if not 0 <= index < len(self.lines):
            raise self.error(len(self.lines) - 1, f"the file ends in its header; {INCOMPLETE}")
        return self.lines[index]

    def find(self, pattern: str, first: int = 0, last: int | None = None) -> tuple[int, re.Match[str]] | None:
        """Return the first line with a pattern and the match, upper and lower case being the same."""
        wanted = re.compile(pattern, re.IGNORECASE)
        for index in range(first, min(len(self.lines), len(self.lines) if last is None else last)):
            match = wanted.search(self.lines[index])
            if match:
                return index, match
        return None

    def found(self, pattern: str, first: int, last: int) -> str:
        """Return the first group of a pattern in some lines; empty if there is none."""
        match = self.find(pattern, first, last)
        return "" if match is None else match[1].group(1).strip()

    def field(self, first: int, place: int, width: int, per_line: int) -> tuple[int, str]:
        """Return the line and the text of one number in a table of columns that begins at a line."""
        index = first + place // per_line
        begin = place % per_line * width
        return index, self.line(index)[begin : begin + width]

    def layout(self, line: int, per_line: str, width: str) -> tuple[int, int]:
        """Return the width of a column and the columns in a line, from the texts in a format such as (8F10.3)."""
        if not all(len(text) <= MAX_DIGITS and int(text) for text in (per_line, width)):
            raise self.error(
                line, f"a format such as (8F10.3) expected; got {shown(self.lines[line].strip())}"
            )
        return int(width), int(per_line)

    def number(self, line: int, text: str, what: str) -> float:
        """Return a finite number."""
        text = text.strip()
        value = float(re.sub("[Dd]", "E", text)) if NUMBER.fullmatch(text) else math.nan
        if not math.isfinite(value):
            raise self.error(line, f"{what} must be a number; got {shown(text)}")
        return value

    def numbers(self, lines: list[int], texts: list[str], what: str) -> np.ndarray:
        """Return finite numbers, each from the text of a number in its line."""
        try:
            found = np.fromiter(map(float, texts), float, len(texts))
        except ValueError:  # Fortran's exponent D
            found = np.array([self.number(line, text, what) for line, text in zip(lines, texts, strict=True)])
        if not np.isfinite(found).all():
            first = int(np.argmin(np.isfinite(found)))
            self.number(lines[first], texts[first], what)
        return found

    def count(self, line: int, text: str, what: str = "the number of samples", least: int = 1) -> int:
        """Return a number of samples, or of other things."""
        value = self.number(line, text, what)
        if value != int(value) or not least <= value <= MAX_SAMPLES:
            allowed = f"a whole number from {least} to {MAX_SAMPLES:,}"
            raise self.error(line, f"{what} must be {allowed}; got {text.strip()}")
        return int(value)

    def step(self, line: int, text: str) -> float:
        """Return a time step in s."""
        return self._positive(line, text, "the time step")

    def step_of_rate(self, line: int, text: str) -> float:
        """Return the time step in s that belongs to a sampling rate in Hz."""
        return 1 / self._positive(line, text, "the sampling rate")

    def _positive(self, line: int, text: str, what: str) -> float:
        value = self.number(line, text, what)
        if not 1e-9 <= value <= 1e9:
            raise self.error(line, f"{what} must be positive, and neither tiny nor huge; got {text.strip()}")
        return value

    def unit(self, line: int, text: str) -> str:
        """Return a unit of acceleration."""
        found = unit_of(text)
        if found is None:
            raise self.error(line, f"a unit of acceleration expected; got {shown(text.strip())}")
        return found

    def peak(self, line: int, text: str, unit: str) -> Peak:
        """Return a peak acceleration that the header prints."""
        size = abs(self.number(line, text, "the peak acceleration"))
        exponent = int(Decimal(re.sub("[Dd]", "E", text.strip())).as_tuple().exponent)
        return Peak(size * UNITS[unit], 0.5 * 10.0 ** min(exponent, 300) * UNITS[unit])

    def columns(
        self, first: int, count: int, width: int, per_line: int, *, more: bool = False
    ) -> tuple[np.ndarray, int]:
        """Read numbers in columns of equal width, and return them with the line after the last.

        Numbers in that line are an error, except with `more`.
        """
        found: list[float] = []
        index = first
        while len(found) < count:
            line = self._sample_line(index, len(found), count)
            wanted = min(per_line, count - len(found))
            if line[wanted * width :].strip():
                raise self.error(index, self._too_many(count, wanted))
            if len(line) <= (wanted - 1) * width:
                before = f"{len(found):,} of {count:,} were read before it"
                raise self.error(index, f"the line ends before its {counted(wanted, 'sample')}; {before}")
            parts = [line[k * width : (k + 1) * width] for k in range(wanted)]
            found += [self.number(index, part, "a sample") for part in parts]
            index += 1
        if not more:
            self.ended(index, count)
        return np.array(found), index

    def separated(self, first: int, count: int) -> tuple[np.ndarray, int]:
        """Read numbers that blanks, commas or signs separate, and return them with the line after the last."""
        found: list[float] = []
        index = first
        while len(found) < count:
            line = self._sample_line(index, len(found), count)
            if SEPARATE.sub("", line).strip(" \t,"):
                raise self.error(index, f"numbers expected; got {shown(line.strip())}")
            found += [self.number(index, part, "a sample") for part in SEPARATE.findall(line)]
            index += 1
        if len(found) > count:
            raise self.error(index - 1, self._too_many(count, count))
        self.ended(index, count)
        return np.array(found), index

    def _sample_line(self, index: int, read: int, count: int) -> str:
        if index >= len(self.lines):
            raise self.error(
                index - 1, f"the file ends after {counted(read, 'sample')} of {count:,}; {INCOMPLETE}"
            )
        return self.lines[index].rstrip()

    def ended(self, index: int, count: int) -> None:
        """Refuse numbers in the line after the last sample."""
        after = self.lines[index] if index < len(self.lines) else ""
        if after.strip() and not NUMBER.sub("", after).strip():
            raise self.error(index, self._too_many(count, count))

    @staticmethod
    def _too_many(count: int, wanted: int) -> str:
        where = "" if wanted == count else f", or more than {counted(wanted, 'number')} in a line"
        return f"more than the {counted(count, 'sample')} of the header{where}"
