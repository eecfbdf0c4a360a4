"""K-NET and KiK-net ASCII: 17 lines of header, counts with a scale factor; their mean is the zero of the instrument."""

from __future__ import annotations

from rocking.model.text import counted
from rocking.records.text_file import SEPARATE, Channel, TextFile

HEADER = 17
SCALE = r"^Scale Factor\s+(\S+?)\(gal\)/(\S+)"
RATE = r"^Sampling Freq\S*\s+(\S+?)\s*Hz"
DIRECTIONS = dict(zip("123456", ("N-S 1", "E-W 1", "U-D 1", "N-S 2", "E-W 2", "U-D 2"), strict=True))
"""Directions of KiK-net: 1 to 3 in the borehole, 4 to 6 at the surface."""
PEAK = r"^Max\. Acc\.\s*\(gal\)\s+(\S+)"


def recognises(file: TextFile) -> bool:
    """Return whether the header has a scale factor in gal."""
    return file.find(SCALE, 0, HEADER) is not None


def read(file: TextFile) -> list[Channel]:
    """Read the only channel, in gal, with the mean removed as the format requires."""
    scale, rate, peak = (file.find(pattern, 0, HEADER) for pattern in (SCALE, RATE, PEAK))
    if scale is None or rate is None:
        missing = "scale factor" if scale is None else "sampling frequency"
        raise file.error(min(HEADER, len(file.lines)) - 1, f"the header lacks the {missing}")
    line, match = scale
    divisor = file.number(line, match.group(2), "the divisor of the scale factor")
    if divisor == 0:
        raise file.error(line, "the divisor of the scale factor must not be 0")
    factor = file.number(line, match.group(1), "the scale factor") / divisor
    count = sum(len(SEPARATE.findall(text)) for text in file.lines[HEADER:])
    if count == 0:
        raise file.error(len(file.lines) - 1, f"{counted(HEADER, 'line')} of header, then counts expected")
    samples, _ = file.separated(HEADER, count)
    direction = file.found(r"^Dir\.\s+(\S+)", 0, HEADER)
    return [
        Channel(
            (samples - samples.mean()) * factor,
            "cm/s²",
            file.step_of_rate(rate[0], rate[1].group(1)),
            "K-NET",
            file.found(r"^Station Code\s+(\S+)", 0, HEADER),
            DIRECTIONS.get(direction, direction),
            file.peak(peak[0], peak[1].group(1), "cm/s²") if peak else None,
        )
    ]
