"""SMC, the format of the USGS: fixed columns, acceleration in cm/s²."""

from __future__ import annotations

import re

from rocking.records.text_file import Channel, TextFile

TEXT, INTEGERS, REALS = 11, 6, 10
"""Number of lines of each part of the header."""
NO_REAL = 1.7e38
PEAK_AT = 41
"""Place of the peak acceleration among the reals, counted from 0."""
WIDTH, PER_LINE = 10, 8


def recognises(file: TextFile) -> bool:
    """Return whether the first line names a stage of processing, and the second is a line of the header."""
    return (
        bool(re.match(r"\s*[123]\s+(UN)?CORRECTED ACCELEROGRAM", file.line(0), re.IGNORECASE))
        and len(file.lines) > 1
    )


def read(file: TextFile) -> list[Channel]:
    """Read the only channel."""
    integers, after = file.numbers(TEXT, 48, 10, 8)
    reals, after = file.numbers(after, 50, 15, 5)
    comments = integers[15]
    count = file.count(TEXT + 2, str(integers[16]))
    step = file.step(TEXT + INTEGERS, str(reals[1]), rate=True)
    if not 0 <= comments <= len(file.lines):
        raise file.error(TEXT + 1, f"the number of lines of comment must not be negative; got {comments:g}")
    samples, _ = file.numbers(after + int(comments), count, WIDTH, PER_LINE)
    station = re.match(r"station\s*=\s*(.*?)\s*component=\s*(\S+)", file.line(5))
    name, component = (station.group(1).rstrip(" ,F"), station.group(2) + "°") if station else ("", "")
    peak = None if reals[PEAK_AT] >= NO_REAL * 0.9 else float(reals[PEAK_AT])
    return [Channel(samples, "cm/s²", step, "SMC", name, component, peak)]
