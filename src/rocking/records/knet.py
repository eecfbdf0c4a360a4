"""K-NET and KiK-net ASCII: 17 lines of header, counts with a scale factor; their mean is the zero of the instrument."""

from __future__ import annotations

import re

from rocking.records.text_file import Channel, TextFile

HEADER = 17


def recognises(file: TextFile) -> bool:
    """Return whether the header has a scale factor in gal."""
    return file.find(r"^Scale Factor\s+\S+\(gal\)/\S+", 0, HEADER) is not None


def read(file: TextFile) -> list[Channel]:
    """Read the only channel, in gal, with the mean removed as the format requires."""
    scale, rate = (
        file.find(r"^Scale Factor\s+(\S+)\(gal\)/(\S+)", 0, HEADER),
        file.find(r"^Sampling Freq\S*\s+(\S+?)Hz", 0, HEADER),
    )
    if scale is None or rate is None:
        raise file.error(HEADER - 1, "sampling frequency and scale factor expected in the header")
    line, match = scale
    divisor = file.number(line, match.group(2), "the divisor of the scale factor")
    if divisor == 0:
        raise file.error(line, "the divisor of the scale factor must not be 0")
    factor = file.number(line, match.group(1), "the scale factor") / divisor
    last = len(file.lines)
    while last > HEADER and not file.lines[last - 1].strip():
        last -= 1
    counts = sum(len(text.split()) for text in file.lines[HEADER:last])
    if counts == 0:
        raise file.error(last - 1, "the file has no samples")
    samples, _ = file.numbers(HEADER, counts)
    peak, station, direction = (
        file.find(p, 0, HEADER)
        for p in (
            r"^Max\. Acc\.\S* \S+\s+(\S+)|^Max\. Acc\.\s*\(gal\)\s+(\S+)",
            r"^Station Code\s+(\S+)",
            r"^Dir\.\s+(\S+)",
        )
    )
    return [
        Channel(
            (samples - samples.mean()) * factor,
            "cm/s²",
            file.step(rate[0], rate[1].group(1), rate=True),
            "K-NET",
            station[1].group(1) if station else "",
            direction[1].group(1) if direction else "",
            file.number(peak[0], re.split(r"\s+", file.lines[peak[0]].strip())[-1], "the peak")
            if peak
            else None,
        )
    ]
