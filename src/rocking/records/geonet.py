"""GeoNet V1A and V2A: 16 lines of text, 10 of numbers, then acceleration in mm/s², 10 numbers a line."""

from __future__ import annotations

import numpy as np

from rocking.records.text_file import Channel, TextFile

TITLE = r"^\s*(Unc|C)orrected accelerogram.*GNS Science"
TEXT, NUMBERS = 16, 10
COLUMNS = (8, 10)
"""Width of a column, and columns in a line."""
RATE_AT, STEP_AT = 40, 65
"""Places of the sampling rate of V1A and of the step of V2A among the numbers, counted from 0."""
COUNT_V1_AT, COUNTS_V2_AT = 30, (33, 34, 35)
"""Places of the number of samples of acceleration; in V2A also of velocity and displacement."""


def recognises(file: TextFile) -> bool:
    """Return whether the first line is that of this network."""
    return file.find(TITLE, 0, 1) is not None


def read(file: TextFile) -> list[Channel]:
    """Read all components."""
    channels: list[Channel] = []
    first = 0
    while (begun := file.find(TITLE, first)) is not None:
        channel, first = _component(file, begun[0], raw=begun[1].group(1).upper() == "UNC")
        channels.append(channel)
    return channels


def _component(file: TextFile, first: int, *, raw: bool) -> tuple[Channel, int]:
    """Read a component, and return it with the line after it."""
    numbers = first + TEXT
    at = file.field(numbers, RATE_AT if raw else STEP_AT, *COLUMNS)
    step = file.step_of_rate(*at) if raw else file.step(*at)
    after = numbers + NUMBERS
    blocks: list[np.ndarray] = []
    for place in (COUNT_V1_AT,) if raw else COUNTS_V2_AT:
        line, text = file.field(numbers, place, *COLUMNS)
        count = file.count(line, text, least=0 if blocks else 1)
        block, after = file.columns(after, count, *COLUMNS, more=True)
        blocks.append(block)
    file.ended(after, blocks[0].size)
    peak = file.find(r"Acceleration:\s+peak\s+([-+.\d]+)\s*mm/s/s", first, numbers)
    channel = Channel(
        blocks[0],
        "mm/s²",
        step,
        "GeoNet V1A" if raw else "GeoNet V2A",
        file.line(first + 2),
        file.found(r"^Component\s+(\S+)", first, numbers),
        file.peak(peak[0], peak[1].group(1), "mm/s²") if peak else None,
    )
    return channel, after
