"""ESM ASCII (DYNA 1.2): a header of `KEY: value`, then one sample a line."""

from __future__ import annotations

from rocking.records.text_file import Channel, TextFile, unit_of

HEADER = 64


def recognises(file: TextFile) -> bool:
    """Return whether the first line has the key of this format."""
    return file.line(0).startswith("EVENT_NAME:")


def read(file: TextFile) -> list[Channel]:
    """Read the only channel."""
    found: dict[str, tuple[int, str]] = {}
    for index, line in enumerate(file.lines[:HEADER]):
        key, colon, value = line.partition(":")
        if colon:
            found[key.strip()] = index, value.strip()
    missing = [key for key in ("SAMPLING_INTERVAL_S", "NDATA", "UNITS") if not found.get(key, (0, ""))[1]]
    if missing:
        raise file.error(len(found) - 1, f"the header lacks {', '.join(missing)}")
    unit = unit_of(found["UNITS"][1])
    if unit is None:
        raise file.error(found["UNITS"][0], f"unknown unit of acceleration {found['UNITS'][1]!r}")
    samples, _ = file.numbers(HEADER, file.count(*found["NDATA"]))
    peak = found.get("PGA_CM/S^2", (0, ""))
    return [
        Channel(
            samples,
            unit,
            file.step(*found["SAMPLING_INTERVAL_S"]),
            "ESM",
            found.get("STATION_NAME", (0, ""))[1],
            found.get("STREAM", (0, ""))[1],
            file.number(*peak, "the peak") if peak[1] else None,
        )
    ]
