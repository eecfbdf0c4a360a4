"""PEER NGA AT2: four lines of header, acceleration in g."""

from __future__ import annotations

import re

from rocking.records.text_file import Channel, TextFile
from rocking.records.units import header_units

TITLE = r"(ACCELERATION|VELOCITY|DISPLACEMENT)\s+TIME\s+(?:SERIES|HISTORY)\s+IN\s+UNITS\s+OF\s+(\S+)"
OTHER = r"\b(VELOCITY|DISPLACEMENT)\b"
NEW = r"NPTS\s*=\s*([^,\s=]+)\s*(?:,\s*)?DT\s*=\s*([^\s,]+)"
OLD = r"^\s*(\S+)\s+(\S+)\s+NPTS\s*,\s*DT"
NO_COMPONENT = re.compile(r":|\bunits?\b|\bacceleration\b", re.IGNORECASE)
"""What a component does not hold, unlike a sentence of another program in its place."""
NO_TITLE = "line 3, 'ACCELERATION TIME SERIES IN UNITS OF G', is missing"


def recognises(file: TextFile) -> bool:
    """Return whether the third line names quantity and unit, or the third or fourth counts samples, as this format does."""
    return file.find(TITLE, 2, 3) is not None or _counts(file, 2) is not None


def read(file: TextFile) -> list[Channel]:
    """Read the only channel; its unit is open if the third line is missing."""
    other = file.found(OTHER, 2, 3)
    if other:
        raise file.error(2, f"acceleration expected, but the file holds {other.lower()}; give the .AT2 file")
    title = file.find(TITLE, 2, 3)
    stated = header_units([] if title else file.lines[:4])
    unit = stated.only() if title is None else file.unit(2, title[1].group(2))
    if title is not None:
        file.line(3)
    header = _counts(file, 2 if title is None else 3)
    if header is None:
        raise file.error(3, "number of samples and time step expected, as in NPTS= 4000, DT= .0050 SEC")
    place, (count, step) = header[0], header[1].groups()
    samples, _ = file.separated(place + 1, file.count(place, count))
    station = file.line(1).strip()
    name, comma, component = station.rpartition(",")
    if not comma or NO_COMPONENT.search(component):
        name, component = station, ""
    return [
        Channel(
            samples,
            unit,
            file.step(place, step),
            "PEER AT2",
            name.strip(),
            component.strip(),
            header=stated._replace(lacking="" if unit else NO_TITLE),
        )
    ]


def _counts(file: TextFile, first: int) -> tuple[int, re.Match[str]] | None:
    """Return the line, from `first` to the fourth, with the number of samples and the time step."""
    return file.find(NEW, first, 4) or file.find(OLD, first, 4)
