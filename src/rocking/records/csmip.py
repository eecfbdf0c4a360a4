"""CSMIP/CDMG V1 and V2, and USC V2: several channels, each with text lines, numbers and blocks of data."""

from __future__ import annotations

import re

from rocking.records.text_file import Channel, Peak, TextFile
from rocking.records.units import unit_of

CORRECTED = (
    r"^\s*(\d+)\s+POINTS OF ACC\w* DATA EQUALLY SPACED AT\s+(\S+)\s+SEC\W+"
    r"(?:UNITS:|IN(?: UNITS)?)\s*([A-Z/]+\d*)"
)
UNCORRECTED = r"^\s*(\d+)\s+ACCELEROGRAM POINTS AT\s+(\S+)\s+PTS/SEC IN UNITS OF\s+([A-Z/]+\d*)"
FORMAT = r"\((\d+)F(\d+)\.\d+\)"
COLUMNS = (10, 8)
"""Width of a column and columns in a line of V2, where the file does not give them."""
ANNOUNCED = r"POINTS OF ACC(?:EL)? DATA|ACCELEROGRAM POINTS AT"
TITLE = r"^\s*(?:UN)?CORRECTED ACCEL"
PEAK = r"PEAK\s+ACCELERATION\s*=\s*([-+.\d]+)\s*([A-Z/]+\d?)"
RAW_PEAK = r"MAX\s*=\s*([-+.\d]+)\s*(G(?:/10)?)\b"
CHANNEL = r"(?:CHAN\s+\d+:|\bCOMP)\s+(.+?)(?:\s{2,}|$)"
HEADER_LINES = 200
NAME_V1, NAME_V2 = 5, 6
"""Place of the line with the name of the station."""


def recognises(file: TextFile) -> bool:
    """Return whether a line begins a block of acceleration as these formats do."""
    return file.find(ANNOUNCED, 0, HEADER_LINES) is not None


def read(file: TextFile) -> list[Channel]:
    """Read all channels."""
    channels: list[Channel] = []
    after = 0
    while (begun := file.find(ANNOUNCED, after)) is not None:
        channel, after = _channel(file, after, begun[0])
        channels.append(channel)
    return channels


def _channel(file: TextFile, first: int, line: int) -> tuple[Channel, int]:
    """Read the channel whose samples follow a line, and return it with the line after it."""
    corrected, raw = (
        re.match(pattern, file.line(line), re.IGNORECASE) for pattern in (CORRECTED, UNCORRECTED)
    )
    match = corrected or raw
    if match is None:
        raise file.error(line, "number of points, time step or rate, and unit expected")
    unit = file.unit(line, match.group(3))
    step = file.step_of_rate(line, match.group(2)) if raw else file.step(line, match.group(2))
    values = file.find(FORMAT, line, line + 1)
    if raw and values is None:
        raise file.error(line, "format of the samples expected, such as (8F9.6)")
    columns = file.layout(line, values[1].group(1), values[1].group(2)) if values else COLUMNS
    samples, after = file.columns(line + 1, file.count(line, match.group(1)), *columns)
    title = file.find(TITLE, first, line)
    begin = title[0] if title else first
    direction, *degrees = re.split(
        r"DEG\b", file.found(CHANNEL, begin, line), maxsplit=1, flags=re.IGNORECASE
    )
    channel = Channel(
        samples,
        unit,
        step,
        "CSMIP V1" if raw else "USC V2" if "IN UNITS" in match.group().upper() else "CSMIP V2",
        re.sub(r"\s{2,}.*", "", file.line(begin + (NAME_V1 if raw else NAME_V2)).strip()),
        f"{direction.rstrip()}°" if degrees else direction,
        _peak(file, RAW_PEAK if raw else PEAK, begin, line),
    )
    return channel, after


def _peak(file: TextFile, pattern: str, first: int, last: int) -> Peak | None:
    result = file.find(pattern, first, last)
    unit = unit_of(result[1].group(2)) if result else None
    return None if result is None or unit is None else file.peak(result[0], result[1].group(1), unit)
