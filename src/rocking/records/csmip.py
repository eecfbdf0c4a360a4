"""CSMIP/CDMG V1 and V2, and USC V2: several channels, each with text lines, numbers and blocks of data."""

from __future__ import annotations

import re

from rocking.records.text_file import Channel, TextFile, unit_of

CORRECTED = (
    r"^\s*(\d+)\s+POINTS OF ACC(?:EL)? DATA EQUALLY SPACED AT\s+(\S+)\s+SEC\.?\s+"
    r"(?:\(UNITS:\s*([^)]+)\)|IN UNITS\s+(\S+))"
)
UNCORRECTED = r"^\s*(\d+)\s+Accelerogram points at\s+(\S+)\s+pts/sec in units of\s+([^.\s]+)\.?\s+Format:\s*\((\d+)f(\d+)\.\d+\)"
PEAK = r"PEAK\s+ACCELERATION\s*=\s*([-+.\d]+)\s*CMS?/SEC/SEC"
RAW_PEAK = r"Max\s*=\s*([-+.\d]+)\s*g"
CHANNEL = r"CHAN\s+\d+:\s*(.+?)(?:\s{2,}|$)|COMP\s+(\S+)"


def recognises(file: TextFile) -> bool:
    """Return whether a line begins a block of acceleration as these formats do."""
    return file.find(CORRECTED) is not None or file.find(UNCORRECTED) is not None


def read(file: TextFile) -> list[Channel]:
    """Read all channels."""
    channels: list[Channel] = []
    after = 0
    while (begun := file.find(CORRECTED, after) or file.find(UNCORRECTED, after)) is not None:
        line, match = begun
        raw = "pts/sec" in match.group(0)
        count, step = file.count(line, match.group(1)), file.step(line, match.group(2), rate=raw)
        named = match.group(3) or match.group(4)
        unit = unit_of(named)
        if unit is None:
            raise file.error(line, f"unknown unit of acceleration {named!r}")
        per_line, width = (int(match.group(4)), int(match.group(5))) if raw else (8, 10)
        samples, following = file.numbers(line + 1, count, width, per_line)
        peak = file.find(RAW_PEAK if raw else PEAK, after, line)
        channel = file.find(CHANNEL, after, line)
        component = "" if channel is None else (channel[1].group(1) or channel[1].group(2)).strip()
        channels.append(
            Channel(
                samples,
                unit,
                step,
                f"CSMIP V{1 if raw else 2}" if "IN UNITS" not in match.group(0).upper() or raw else "USC V2",
                _station(file, after),
                re.sub(r"\s*DEG.*", "°", component, flags=re.IGNORECASE),
                None if peak is None else file.number(peak[0], peak[1].group(1), "the peak acceleration"),
            )
        )
        after = following
    return channels


def _station(file: TextFile, first: int) -> str:
    """Return the name of the station: the seventh line of text."""
    return re.sub(r"\s{2,}.*", "", file.line(min(first + 6, len(file.lines) - 1)).strip())
