"""COSMOS V1 and V2 (format v01.20): text lines, 100 integers, 100 reals, comments, data in the format that the file gives."""

from __future__ import annotations

import re

from rocking.records.text_file import Channel, TextFile, unit_of

INTEGERS = r"^\s*(\d+)\s+Integer-header values follow"
REALS = r"^\s*(\d+)\s+Real-header values follow"
DATA = (
    r"^\s*(\d+)\s+acceleration pts,.*units\s*=\s*([^,(]+)\(?\d*\)?\s*,\s*Format\s*=\s*\((\d+)[EF](\d+)\.\d+\)"
)
STEP_AT = 61
"""Place of the sampling interval in ms among the reals, counted from 0; real 33 is that of the instrument's parent record."""
UNKNOWN = -999.0
PEAK_AT = 63


def recognises(file: TextFile) -> bool:
    """Return whether the header has its integers announced as in this format."""
    return file.find(INTEGERS, 0, 60) is not None


def read(file: TextFile) -> list[Channel]:
    """Read all channels."""
    channels: list[Channel] = []
    after = 0
    while (head := file.find(REALS, after)) is not None:
        reals, following = file.numbers(head[0] + 1, 100, 15, 5)
        begun = file.find(DATA, following)
        if begun is None:
            raise file.error(following - 1, "no line that begins the acceleration follows the header")
        line, match = begun
        unit = unit_of(match.group(2))
        if unit is None:
            raise file.error(line, f"unknown unit of acceleration {match.group(2).strip()!r}")
        count = file.count(line, match.group(1))
        step = file.step(head[0] + 13, str(reals[STEP_AT] / 1000))
        samples, after = file.numbers(line + 1, count, int(match.group(4)), int(match.group(3)))
        station = file.find(r"Statn No:\s*\S+\s+Code:\s*(\S+)\s+\S*\s*(.*)", 0, head[0])
        channel = file.find(r"Sta Chan\s+\S+:\s*(.+?)\s{0,}\(", 0, head[0])
        peak = float(reals[PEAK_AT])
        channels.append(
            Channel(
                samples,
                unit,
                step,
                "COSMOS",
                re.sub(r"\s{2,}", " ", station[1].group(2)).strip() if station else "",
                channel[1].group(1).strip() if channel else "",
                None if peak == UNKNOWN else peak,
            )
        )
    return channels
