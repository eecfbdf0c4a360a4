"""COSMOS V1 and V2 (format v01.20): text lines, 100 integers, 100 reals, comments, data in the format that the file gives."""

from __future__ import annotations

import re

from rocking.records.text_file import Channel, TextFile

INTEGERS = r"^\s*(\d+)\s+Integer-header values follow"
REALS = r"^\s*(\d+)\s+Real-header values follow on\s+(\d+)\s+lines,\s*Format\s*=\s*\((\d+)[EF](\d+)\.\d+\)"
DATA = (
    r"^\s*(\d+)\s+acceleration pts,.*units\s*=([^,(=]++)(?:\(\d*\))?\s*,"
    r"\s*Format\s*=\s*\((?:1P)?(\d+)[EF](\d+)\.\d+\)"
)
ANNOUNCED = r"^\s*\S+\s+acceleration pts"
RAW = r"^\s*(Raw|Uncorrected) acceleration"
STEP_AT = 61
"""Place of the time step in ms among the reals, counted from 0. Real 33 is that of the raw record."""
PEAK_AT = 63
UNKNOWN = -999.0
HEADER_LINES = 120
TEXT_LINES = 24
"""Lines of text and integers before the real-header values."""


def recognises(file: TextFile) -> bool:
    """Return whether the header has its integers announced as in this format."""
    return file.find(INTEGERS, 0, HEADER_LINES) is not None


def read(file: TextFile) -> list[Channel]:
    """Read all channels of acceleration; blocks of velocity and displacement have headers of their own."""
    channels: list[Channel] = []
    after = 0
    while (begun := file.find(ANNOUNCED, after)) is not None:
        channel, after = _channel(file, after, begun[0])
        channels.append(channel)
    if not channels:
        raise file.error(len(file.lines) - 1, "no line announces acceleration")
    return channels


def _channel(file: TextFile, first: int, line: int) -> tuple[Channel, int]:
    """Read the channel whose samples follow a line, and return it with the line after it."""
    match = re.match(DATA, file.line(line), re.IGNORECASE)
    if match is None:
        raise file.error(line, "number of points, unit and format expected")
    header = None
    while (result := file.find(REALS, first, line)) is not None:
        header, first = result, result[0] + 1
    if header is None:
        raise file.error(line, "no line announces the real-header values before this one")
    begin, columns = header[0] + 1, file.layout(header[0], header[1].group(3), header[1].group(4))
    unit = file.unit(line, match.group(2))
    at, text = file.field(begin, STEP_AT, *columns)
    step = file.number(at, text, "the time step in ms, real-header value 62,") / 1000
    if not step > 0:
        raise file.error(
            at, f"the time step in ms, real-header value 62, must be positive; got {text.strip()}"
        )
    layout = file.layout(line, match.group(3), match.group(4))
    samples, after = file.columns(line + 1, file.count(line, match.group(1)), *layout)
    at, text = file.field(begin, PEAK_AT, *columns)
    known = file.number(at, text, "the peak acceleration") != UNKNOWN
    top = max(0, header[0] - TEXT_LINES)
    component = file.found(r"^Sta Cha[^(]*:([^(:]++)\(", top, header[0])
    return Channel(
        samples,
        unit,
        step,
        "COSMOS V1" if file.find(RAW, top, header[0]) else "COSMOS V2",
        file.found(r"Code:\s*\S+\s*(.*)", top, header[0]),
        f"{component.removesuffix('deg').rstrip()}°" if component.endswith("deg") else component,
        file.peak(at, text, unit) if known else None,
    ), after
