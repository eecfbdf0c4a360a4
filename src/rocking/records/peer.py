"""PEER NGA AT2: four lines of header, acceleration in g."""

from __future__ import annotations

from rocking.records.text_file import Channel, TextFile

NEW = r"NPTS\s*=\s*([^,\s]+)\s*,?\s*DT\s*=\s*([^\s,]+)"
OLD = r"^\s*(\S+)\s+(\S+)\s+NPTS\s*,\s*DT"


def recognises(file: TextFile) -> bool:
    """Return whether the third line names the unit as this format does."""
    return file.find(r"ACCELERATION\s+TIME\s+(?:SERIES|HISTORY)\s+IN\s+UNITS\s+OF", 2, 3) is not None


def read(file: TextFile) -> list[Channel]:
    """Read the only channel."""
    if not file.line(2).rstrip().upper().endswith("OF G"):
        raise file.error(2, "acceleration in units of g expected")
    header = file.find(NEW, 3, 4) or file.find(OLD, 3, 4)
    if header is None:
        raise file.error(
            min(3, len(file.lines) - 1), "number of samples and time step expected: NPTS= ..., DT= ..."
        )
    count, step = file.count(3, header[1].group(1)), file.step(3, header[1].group(2))
    samples, _ = file.numbers(4, count)
    name, _, component = file.line(1).strip().rpartition(",")
    return [Channel(samples, "g", step, "PEER AT2", name.strip(), component.strip())]
