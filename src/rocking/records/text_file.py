"""Lines of a record file, and the numbers in them; errors name the file and the line."""

from __future__ import annotations

import hashlib
import math
import os
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from rocking.model import counted, shown

MAX_BYTES = 1_000_000_000
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?")
STANDARD_GRAVITY = 9.80665
UNITS = {
    "m/s²": 1.0,
    "cm/s²": 0.01,
    "mm/s²": 0.001,
    "g": STANDARD_GRAVITY,
    "g/10": STANDARD_GRAVITY / 10,
}
"""Size of each unit of acceleration, in m/s²."""
SPELLINGS = {
    "m/s2": "m/s²",
    "m/s^2": "m/s²",
    "m/s/s": "m/s²",
    "cm/s2": "cm/s²",
    "cm/s^2": "cm/s²",
    "cm/s/s": "cm/s²",
    "cm/sec2": "cm/s²",
    "cm/sec/sec": "cm/s²",
    "gal": "cm/s²",
    "gals": "cm/s²",
    "mm/s2": "mm/s²",
    "mm/s^2": "mm/s²",
    "mm/s/s": "mm/s²",
    "g": "g",
    "g/10": "g/10",
}
"""Spellings of the units in files, in lower case."""


class RecordError(ValueError):
    """Record file that cannot be read. The message is one line and names the file and the place.

    Examples
    --------
    >>> import rocking as rk
    >>> str(rk.RecordError("a.at2, line 4: no step"))
    'a.at2, line 4: no step'
    """


class Channel(NamedTuple):
    """One channel of a record file, as the file gives it."""

    samples: np.ndarray
    unit: str
    step: float
    format: str
    name: str = ""
    component: str = ""
    header_peak: float | None = None
    """Peak acceleration in the header, in `unit`."""


class TextFile:
    """Lines of a file, with its name and digest."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        place = Path(path)
        try:
            if place.stat().st_size > MAX_BYTES:
                raise RecordError(f"{place.name}: larger than {MAX_BYTES // 1_000_000:,} MB")
            content = place.read_bytes()
        except OSError as error:
            raise RecordError(f"{os.fspath(path)!r} cannot be read: {error.strerror or error}") from error
        self.name, self.sha256 = place.name, hashlib.sha256(content).hexdigest()
        if b"\0" in content[:100_000]:
            raise RecordError(
                f"{self.name}: a binary file; rk.read_ground_motion reads text formats, or what ObsPy reads"
            )
        self.lines = content.decode("latin-1").replace("\r\n", "\n").replace("\r", "\n").split("\n")

    def error(self, line: int, what: str) -> RecordError:
        """Return the error for a line, counted from 0."""
        return RecordError(f"{self.name}, line {line + 1}: {what}")

    def line(self, index: int) -> str:
        """Return a line; `RecordError` beyond the last."""
        if not 0 <= index < len(self.lines):
            raise self.error(len(self.lines) - 1, "the file ends in its header")
        return self.lines[index]

    def find(self, pattern: str, first: int = 0, last: int | None = None) -> tuple[int, re.Match[str]] | None:
        """Return the first line with a pattern and the match, upper and lower case being the same."""
        for index in range(first, min(len(self.lines), len(self.lines) if last is None else last)):
            match = re.search(pattern, self.lines[index], re.IGNORECASE)
            if match:
                return index, match
        return None

    def number(self, line: int, text: str, what: str) -> float:
        """Return a finite number of a header."""
        try:
            value = float(text.replace("D", "E").replace("d", "e"))
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.error(line, f"{what} must be a number; got {shown(text.strip())}")
        return value

    def count(self, line: int, text: str) -> int:
        """Return a number of samples."""
        value = self.number(line, text, "the number of samples")
        if value != int(value) or not 1 <= value <= 10_000_000:
            raise self.error(
                line, f"the number of samples must be a whole number from 1 to 10,000,000; got {text.strip()}"
            )
        return int(value)

    def step(self, line: int, text: str, *, rate: bool = False) -> float:
        """Return a time step in s, from the text of a step or of a sampling rate in Hz."""
        value = self.number(line, text, "the sampling rate" if rate else "the time step")
        if not value > 0:
            raise self.error(
                line, f"the {'sampling rate' if rate else 'time step'} must be positive; got {text.strip()}"
            )
        return 1 / value if rate else value

    def numbers(
        self, first: int, count: int, width: int | None = None, per_line: int = 0
    ) -> tuple[np.ndarray, int]:
        """Read numbers from a line on, in columns of equal width or separated by anything.

        Returns
        -------
        tuple of (ndarray, int)
            The numbers, shape (count,), and the line after the last.
        """
        found: list[float] = []
        index = first
        while len(found) < count:
            if index >= len(self.lines):
                raise self.error(
                    len(self.lines) - 1, f"the file ends after {counted(len(found), 'number')} of {count:,}"
                )
            line = self.lines[index].rstrip()
            if width is None:
                parts = NUMBER.findall(line)
                if NUMBER.sub("", line).strip(" \t,;"):
                    raise self.error(index, f"numbers expected; got {shown(line.strip())}")
            else:
                wanted = min(per_line, count - len(found))
                parts = [line[k * width : (k + 1) * width] for k in range(wanted)]
                if len(line) < (wanted - 1) * width + 1:
                    raise self.error(
                        index, f"{counted(wanted, 'number')} expected; got {shown(line.strip())}"
                    )
            found += [self.number(index, part, "a sample") for part in parts]
            index += 1
        if len(found) > count:
            raise self.error(index - 1, f"more numbers than the {count:,} that the header gives")
        return np.array(found), index


def unit_of(text: str) -> str | None:
    """Return the unit of acceleration that a text names; None if it is unknown."""
    return SPELLINGS.get(text.strip().lower().rstrip(".").replace("²", "2"))
