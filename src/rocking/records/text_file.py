"""Lines of a record file and the numbers in them, also as spreadsheets write them; channels, and errors that name file and line."""

from __future__ import annotations

import hashlib
import math
import os
import re
import stat
from contextlib import suppress
from copy import copy
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rocking.model.text import both_ends, counted, formatted
from rocking.model.validation import RecordError, WrongType
from rocking.records.units import UNITS, HeaderUnits, unit_of

if TYPE_CHECKING:
    from rocking.records.times import PrintedTimes

TEXTS = "formats: PEER AT2, COSMOS, CSMIP, USC, SMC, K-NET, ESM, GeoNet, text in columns"


def with_exponent_e(text: str) -> str:
    """Return a number with the exponent E of all languages in place of Fortran's D."""
    return text.upper().replace("D", "E")


class Peak(NamedTuple):
    """Peak acceleration as a header prints it, without its sign, in m/s²."""

    size: float
    rounding: float
    """Half a unit of the last printed digit."""


class Channel(NamedTuple):
    """One channel of a record file, as the file gives it."""

    samples: np.ndarray
    unit: str | None
    """One of `UNITS`; None if the file does not state it."""
    step: float | None
    """Time step in s; None if the file does not state it."""
    format: str
    name: str = ""
    component: str = ""
    peak: Peak | None = None
    header: HeaderUnits = HeaderUnits()
    """What a header without a fixed place for the unit states about it."""
    times: PrintedTimes | None = None
    """Times of the samples, which state the step, if the file has a column of them."""


MAX_BYTES = 300_000_000


class Content:
    """Bytes of a regular file of limited size, or bytes in memory with a name."""

    def __init__(self, source: str | os.PathLike[str] | bytes, name: str | None = None) -> None:
        if isinstance(source, bytes):
            self._keep(source, "bytes" if name is None else name)
        elif name is not None:
            raise WrongType("name", "be omitted for a source that is not bytes", name)
        elif isinstance(source, str | os.PathLike):
            self._read(Path(source))
        else:
            raise WrongType("source", "be a path, bytes, or a Stream or Trace of ObsPy", source)

    def _keep(self, data: bytes, name: str) -> None:
        """Take over bytes in memory."""
        if not isinstance(name, str):
            raise WrongType("name", "be a str", name)
        self.name = name
        label = both_ends(name)
        if len(data) > MAX_BYTES:
            raise RecordError(f"{label}: larger than {MAX_BYTES // 1_000_000} MB")
        self._take(data, label)

    def _read(self, place: Path) -> None:
        """Read a file."""
        self.name = place.name
        label = both_ends(os.fspath(place))
        try:
            about = place.stat()
            if stat.S_ISDIR(about.st_mode):
                raise RecordError(f"{label}: a folder; give the path of one file")
            if not stat.S_ISREG(about.st_mode):
                raise RecordError(f"{label}: not a regular file")
            if about.st_size > MAX_BYTES:
                raise RecordError(f"{label}: larger than {MAX_BYTES // 1_000_000} MB")
            data = place.read_bytes()
        except (OSError, ValueError) as error:
            if isinstance(error, RecordError):
                raise
            reason = getattr(error, "strerror", None) or error
            advice = "; check the path" if isinstance(error, FileNotFoundError) else ""
            raise RecordError(f"{label}: cannot be read: {reason}{advice}") from error
        self._take(data, label)

    def _take(self, data: bytes, label: str) -> None:
        if not data.strip():
            raise RecordError(f"{label}: the file is empty")
        self.data = data
        self.sha256 = hashlib.sha256(self.data).hexdigest()

    @property
    def is_text(self) -> bool:
        """True unless a byte is 0 where no text has one."""
        return bool(encodings(self.data))


MARKS = {
    b"\xff\xfe\0\0": "utf-32",
    b"\0\0\xfe\xff": "utf-32",
    b"\xff\xfe": "utf-16",
    b"\xfe\xff": "utf-16",
}
"""First bytes of texts of two or four bytes a character."""
MOSTLY = 0.9
"""Least share of characters of UTF-16 without a mark that are those of Latin-1, whose other byte is 0."""


def encodings(data: bytes) -> tuple[str, ...]:
    """Return the encodings of a text that are to be tried, in their order; none for binary data.

    Examples
    --------
    >>> encodings("0,5".encode("utf-16-le")), encodings("g²".encode("latin-1")), encodings(bytes(4))
    (('utf-16-le',), ('utf-8-sig', 'latin-1'), ())
    """
    if b"\0" not in data:
        return ("utf-8-sig", "latin-1")
    for mark, code in MARKS.items():
        if data.startswith(mark):
            return (code,)
    first, second = data[::2].count(0), data[1::2].count(0)
    if min(first, second) == 0 and max(first, second) > MOSTLY * (len(data) // 2):
        return ("utf-16-le",) if second else ("utf-16-be",)
    return ()


def decoded(data: bytes) -> str | None:
    """Return data as text; None if they are none, or are not complete."""
    for each in encodings(data):
        with suppress(UnicodeDecodeError):
            return data.decode(each)
    return None


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
        text = decoded(content.data)
        if text is None:
            raise RecordError(f"{self.name}: no text, or an incomplete one")
        text = text.rstrip("\x1a\r\n\t ")  # DOS ends a text by the byte 1a
        if not text.strip():
            raise RecordError(f"{self.name}: the file is empty")
        self.lines = text.replace("\r\n", "\n").replace("\r", "\n").replace("−", "-").split("\n")
        for index, line in enumerate(self.lines):
            if len(line) > MAX_LINE:
                rule = f"a line must have at most {MAX_LINE:,} characters; got {len(line):,}"
                raise self.error(index, f"{rule}; put each sample on a line of its own")

    def with_lines(self, lines: list[str]) -> TextFile:
        """Return the file with other lines in the same places."""
        result = copy(self)
        result.lines = lines
        return result

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
        requested = re.compile(pattern, re.IGNORECASE)
        for index in range(first, min(len(self.lines), len(self.lines) if last is None else last)):
            match = requested.search(self.lines[index])
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
                line, f"a format such as (8F10.3) expected; got {formatted(self.lines[line].strip())}"
            )
        return int(width), int(per_line)

    def number(self, line: int, text: str, what: str) -> float:
        """Return a finite number."""
        text = text.strip()
        value = float(with_exponent_e(text)) if NUMBER.fullmatch(text) else math.nan
        if not math.isfinite(value):
            raise self.error(line, f"{what} must be a number; got {formatted(text)}")
        return value

    def numbers(self, lines: list[int], texts: list[str], what: str) -> np.ndarray:
        """Return finite numbers, each from a text in its line."""
        if all(NUMBER.fullmatch(text.strip()) for text in texts):
            with suppress(ValueError):  # Fortran's exponent D
                result = np.fromiter(map(float, texts), float, len(texts))
                if np.isfinite(result).all():
                    return result
        return np.array([self.number(line, text, what) for line, text in zip(lines, texts, strict=True)])

    def count(self, line: int, text: str, what: str = "the number of samples", least: int = 1) -> int:
        """Return a number of samples, or of other things."""
        value = self.number(line, text, what)
        if value != int(value) or not least <= value <= MAX_SAMPLES:
            allowed = f"a whole number from {least} to {MAX_SAMPLES:,}"
            raise self.error(line, f"{what} must be {allowed}; got {text.strip()}")
        return int(value)

    def step(self, line: int, text: str) -> float:
        """Return a time step in s; an error for one in ms."""
        value = self._positive(line, text, "the time step")
        unit = re.match(r"\s*(ms|msec|milli\w*)\b", self.lines[line].partition(text)[2], re.IGNORECASE)
        if unit:
            raise self.error(line, f"a time step in s expected; got {text.strip()} {unit[1]}")
        return value

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
        result = unit_of(text)
        if result is None:
            raise self.error(line, f"a unit of acceleration expected; got {formatted(text.strip())}")
        return result

    def peak(self, line: int, text: str, unit: str) -> Peak:
        """Return a peak acceleration that the header prints."""
        size = abs(self.number(line, text, "the peak acceleration"))
        exponent = int(Decimal(with_exponent_e(text.strip())).as_tuple().exponent)
        return Peak(size * UNITS[unit], 0.5 * 10.0 ** min(exponent, 300) * UNITS[unit])

    def columns(
        self, first: int, count: int, width: int, per_line: int, *, more: bool = False
    ) -> tuple[np.ndarray, int]:
        """Read numbers in columns of equal width, and return them with the line after the last.

        Numbers in that line are an error, except with `more`.
        """
        texts: list[str] = []
        places: list[int] = []
        index = first
        while len(texts) < count:
            line = self._sample_line(index, len(texts), count)
            requested = min(per_line, count - len(texts))
            if line[requested * width :].strip():
                raise self.error(index, self._too_many(count, requested))
            if len(line) <= (requested - 1) * width:
                before = f"{len(texts):,} of {count:,} were read before it"
                raise self.error(index, f"the line ends before its {counted(requested, 'sample')}; {before}")
            texts += [line[k * width : (k + 1) * width] for k in range(requested)]
            places += [index] * requested
            index += 1
        if not more:
            self.ended(index, count)
        return self.numbers(places, texts, "a sample"), index

    def separated(self, first: int, count: int) -> tuple[np.ndarray, int]:
        """Read numbers that blanks, commas or signs separate, and return them with the line after the last."""
        result: list[float] = []
        index = first
        while len(result) < count:
            line = self._sample_line(index, len(result), count)
            if SEPARATE.sub("", line).strip(" \t,"):
                raise self.error(index, f"numbers expected; got {formatted(line.strip())}")
            result += [self.number(index, part, "a sample") for part in SEPARATE.findall(line)]
            index += 1
        if len(result) > count:
            raise self.error(index - 1, self._too_many(count, count))
        self.ended(index, count)
        return np.array(result), index

    def _sample_line(self, index: int, read: int, count: int) -> str:
        if index >= len(self.lines):
            raise self.error(
                index - 1, f"the file ends after {counted(read, 'sample')} of {count:,}; {INCOMPLETE}"
            )
        return self.lines[index].rstrip()

    def ended(self, index: int, count: int) -> None:
        """Refuse numbers in the line after the last sample."""
        after = self.lines[index] if index < len(self.lines) else ""
        separators = " \t,;" if "," in self.lines[index - 1] else None
        if NUMBER.search(after) and not NUMBER.sub("", after).strip(separators):
            raise self.error(index, self._too_many(count, count))

    @staticmethod
    def _too_many(count: int, requested: int) -> str:
        where = "" if requested == count else f", or more than {counted(requested, 'number')} in a line"
        return f"more than the {counted(count, 'sample')} of the header{where}"


ROW = re.compile(rf"\s*+{NUMBER.pattern}(?:(?:\s*+[,;]\s*+|\s++){NUMBER.pattern})*+\s*+[,;]?\s*+", re.ASCII)
"""Line of numbers that blanks, commas or semicolons separate."""
_COMMA = r"[-+]?(?:\d++(?:,\d++)?|,\d++)(?:[EeDd][-+]?\d{1,4}(?!\d))?"
DECIMAL_COMMAS = re.compile(rf"\s*+{_COMMA}(?:(?:\s*+;\s*+|\s++){_COMMA})++\s*+;?\s*+", re.ASCII)
"""Line of two numbers at least, with decimal commas or whole, that semicolons, tabs or blanks separate."""
LONE = re.compile(r"\s*+[-+]?\d*+,\d++\s*+", re.ASCII)
"""Line of one number with a decimal comma, or of two whole numbers."""
ZERO_AFTER_COMMA = re.compile(r",0\d")
"""No program prints a whole number that begins with 0."""
BOTH = re.compile(r"\s*+[-+]?\d++,\d++,[-+]?\d++,\d++(?:,[-+]?\d++)*+,?\s*+", re.ASCII)
SEARCHED = 2000
"""Lines in which quotes or a decimal comma must occur to be noticed."""


def in_plain_numbers(file: TextFile) -> TextFile:
    """Return the file with its rows of numbers in the usual spelling; other lines, and a usual file, stay as they are."""
    comma = has_decimal_commas(file)
    if not comma and not any('"' in line for line in file.lines[:SEARCHED]):
        return file
    return file.with_lines([_plain(line, comma) for line in file.lines])


def _plain(line: str, comma: bool) -> str:
    result = line.replace('","', '";"').replace('"', "")
    if comma and "." not in line:
        result = result.replace(",", ".")
    return result if ROW.fullmatch(result) else line


def has_decimal_commas(file: TextFile) -> bool:
    """Return whether the numbers have decimal commas: something else separates them, or 0 follows the comma."""
    lines = [line.replace('","', '";"').replace('"', "") for line in file.lines[:SEARCHED]]
    if any("," in line and DECIMAL_COMMAS.fullmatch(line) for line in lines):
        return True
    rows = [line for line in lines if re.match(r"\s*[-+]?[\d.,]*\d", line)]
    return all(map(LONE.fullmatch, rows)) and any(map(ZERO_AFTER_COMMA.search, rows))


def mixes_commas(line: str) -> bool:
    """Return whether commas both separate the numbers of a line and stand in them, as in 0,02,0,005."""
    return bool(BOTH.fullmatch(line) and ZERO_AFTER_COMMA.search(line))
