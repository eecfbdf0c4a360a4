"""GeoNet V1A and V2A: 16 lines of text, 10 of numbers, then acceleration in mm/s², 10 numbers a line."""

from __future__ import annotations

from rocking.records.text_file import Channel, TextFile

TEXT, NUMBERS = 16, 10
WIDTH, PER_LINE = 8, 10
STEP_AT = 45
"""Place of the sampling interval among the reals, counted from 0."""


def recognises(file: TextFile) -> bool:
    """Return whether the header is of this network."""
    return (
        file.find(r"GNS Science", 0, 1) is not None and file.find(r"corrected accelerogram", 0, 1) is not None
    )


def read(file: TextFile) -> list[Channel]:
    """Read all components."""
    channels: list[Channel] = []
    first = 0
    while first + TEXT < len(file.lines) and file.find(r"accelerogram", first, first + 1):
        points = file.find(r"Number of points\s+(\S+)", first, first + TEXT)
        spaced = file.find(r"data at\s+(\S+)\s+sec intervals", first, first + TEXT)
        if points is None or spaced is None:
            raise file.error(first, "number of points and sampling interval expected in the header")
        count, step = file.count(points[0], points[1].group(1)), file.step(spaced[0], spaced[1].group(1))
        samples, after = file.numbers(first + TEXT + NUMBERS, count, WIDTH, PER_LINE)
        component = file.find(r"Component\s+(\S+)", first, first + TEXT)
        peak = file.find(r"Acceleration:\s+peak\s+([-+.\d]+)\s*mm/s/s", first, first + TEXT)
        name = file.line(first + 2).strip()
        channels.append(
            Channel(
                samples,
                "mm/s²",
                step,
                "GeoNet",
                name,
                component[1].group(1) if component else "",
                file.number(peak[0], peak[1].group(1), "the peak") if peak else None,
            )
        )
        following = file.find(r"accelerogram .*GNS Science", after)
        if following is None:
            break
        first = following[0]
    return channels
