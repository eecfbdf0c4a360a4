"""COSMOS V1 and V2 (format v01.20): text lines, 100 integers, 100 reals, comments, data in the format that the file gives."""

from __future__ import annotations

import re

from rocking.records.channel import Channel
from rocking.records.text_file import TextFile

INTEGERS = r"^\s*(\d+)\s+Integer-header values follow"
REALS = r"^\s*(\d+)\s+Real-header values follow on\s+(\d+)\s+lines,\s*Format\s*=\s*\((\d+)[EF](\d+)\.\d+\)"
DATA = (
    r"^\s*(\d+)\s+acceleration pts,.*units\s*=\s*([^,(]+)(?:\(\d*\))?\s*,"
    r"\s*Format\s*=\s*\((?:1P)?(\d+)[EF](\d+)\.\d+\)"
)
STEP_AT = 61
"""Place of the time step in ms among the reals, counted from 0. Real 33 is that of the raw record."""
PEAK_AT = 63
UNKNOWN = -999.0
HEADER_LINES = 120


def recognises(file: TextFile) -> bool:
    """Return whether the header has its integers announced as in this format."""
    return file.find(INTEGERS, 0, HEADER_LINES) is not None


def read(file: TextFile) -> list[Channel]:
    """Read all channels."""
    channels: list[Channel] = []
    first = 0
    while first < len(file.lines) and (not channels or file.find(INTEGERS, first)):
        channel, first = _channel(file, first)
        channels.append(channel)
    return channels


def _channel(file: TextFile, first: int) -> tuple[Channel, int]:
    """Read a channel, and return it with the line after it."""
    header = file.find(REALS, first)
    data = file.find(DATA, first)
    if header is None or data is None:
        missing = "the real-header values" if header is None else "acceleration, its unit and its format"
        raise file.error(len(file.lines) - 1, f"no line announces {missing}")
    begin, columns = header[0] + 1, file.layout(header[0], header[1].group(3), header[1].group(4))
    line, match = data
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
    stage = "V1" if file.find(r"^\s*(Raw|Uncorrected) acceleration", first, first + 1) else "V2"
    component = file.found(r"^Sta Cha[^(]*:\s*([^(:]+?)\s*\(", first, header[0])
    return Channel(
        samples,
        unit,
        step,
        f"COSMOS {stage}",
        file.found(r"Code:\s*\S+\s*(.*)", first, header[0]),
        re.sub(r"\s*deg$", "°", component),
        file.peak(at, text, unit) if known else None,
    ), after
