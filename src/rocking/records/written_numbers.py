"""Rows of numbers as spreadsheets write them: in quotes, or with a decimal comma."""

from __future__ import annotations

import re

from rocking.records.text_file import NUMBER, TextFile

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
