"""SMC, the format of the USGS: fixed columns, acceleration in cm/s²."""

from __future__ import annotations

import re

from rocking.records.text_file import Channel, Peak, TextFile

TEXT, INTEGERS, REALS = 11, 6, 10
"""Number of lines of each part of the header."""
COMMENTS_AT, COUNT_AT = 15, 16
"""Places among the integers, counted from 0."""
RATE_AT, LARGEST_AT, SMALLEST_AT = 1, 29, 31
"""Places among the reals, counted from 0."""
UNKNOWN = 1.7e38
INTEGER, REAL, SAMPLE = (10, 8), (15, 5), (10, 8)
"""Width of a column, and columns in a line."""
TITLE = r"^\s*[1-6]\s+(?:(UN)?CORRECTED ACCELEROGRAM|VELOCITY|DISPLACEMENT)"


def recognises(file: TextFile) -> bool:
    """Return whether the first line names a stage of processing."""
    return file.find(TITLE, 0, 1) is not None


def read(file: TextFile) -> list[Channel]:
    """Read the only channel."""
    if "ACCELEROGRAM" not in file.line(0).upper():
        raise file.error(0, "acceleration expected; this file has another quantity")
    reals = TEXT + INTEGERS
    line, text = file.field(TEXT, COMMENTS_AT, *INTEGER)
    comments = file.count(line, text, "the number of lines of comment", least=0)
    count = file.count(*file.field(TEXT, COUNT_AT, *INTEGER))
    step = file.step_of_rate(*file.field(reals, RATE_AT, *REAL))
    samples, _ = file.columns(reals + REALS + comments, count, *SAMPLE)
    station = re.match(r"station\s*=(.*?)component=\s*(\S+)", file.line(5))
    name, component = (station.group(1).strip(), station.group(2)) if station else ("", "")
    component += "°" if component.isdigit() else ""
    peaks = [_peak(file, reals, place) for place in (LARGEST_AT, SMALLEST_AT)]
    largest = max((peak for peak in peaks if peak), default=None)
    return [Channel(samples, "cm/s²", step, "SMC", name, component, largest)]


def _peak(file: TextFile, reals: int, place: int) -> Peak | None:
    line, text = file.field(reals, place, *REAL)
    if file.number(line, text, "the peak acceleration") >= 0.99 * UNKNOWN:
        return None
    return file.peak(line, text, "cm/s²")
