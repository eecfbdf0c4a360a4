"""PEER NGA AT2: four lines of header, acceleration in g."""

from __future__ import annotations

from rocking.records.channel import Channel
from rocking.records.text_file import TextFile

TITLE = r"(ACCELERATION|VELOCITY|DISPLACEMENT)\s+TIME\s+(?:SERIES|HISTORY)\s+IN\s+UNITS\s+OF\s+(\S+)"
NEW = r"NPTS\s*=\s*([^,\s]+)\s*,?\s*DT\s*=\s*([^\s,]+)"
OLD = r"^\s*(\S+)\s+(\S+)\s+NPTS\s*,\s*DT"


def recognises(file: TextFile) -> bool:
    """Return whether the third line names the quantity and the unit as this format does."""
    return file.find(TITLE, 2, 3) is not None


def read(file: TextFile) -> list[Channel]:
    """Read the only channel."""
    title = file.find(TITLE, 2, 3)
    if title is None or title[1].group(1).upper() != "ACCELERATION":
        raise file.error(2, "acceleration expected; this file has another quantity")
    unit = file.unit(2, title[1].group(2))
    file.line(3)
    header = file.find(NEW, 3, 4) or file.find(OLD, 3, 4)
    if header is None:
        raise file.error(3, "number of samples and time step expected, as in NPTS= 4000, DT= .0050 SEC")
    samples, _ = file.separated(4, file.count(3, header[1].group(1)))
    name, _, component = file.line(1).strip().rpartition(",")
    step = file.step(3, header[1].group(2))
    return [Channel(samples, unit, step, "PEER AT2", name.strip(), component.strip())]
