"""ESM ASCII (DYNA 1.2): a header of `KEY: value`, then one sample a line."""

from __future__ import annotations

from rocking.records.text_file import Channel, TextFile

NEEDED = ("SAMPLING_INTERVAL_S", "NDATA", "UNITS")


def recognises(file: TextFile) -> bool:
    """Return whether the first line has the key of this format."""
    return file.line(0).startswith("EVENT_NAME:")


def read(file: TextFile) -> list[Channel]:
    """Read the only channel."""
    header: dict[str, tuple[int, str]] = {}
    first = 0
    while first < len(file.lines) and ":" in file.lines[first]:
        key, _, value = file.lines[first].partition(":")
        header[key.strip()] = first, value.strip()
        first += 1
    missing = [key for key in NEEDED if not header.get(key, (0, ""))[1]]
    if missing:
        raise file.error(first - 1, f"the header ends here and lacks {', '.join(missing)}")
    samples, _ = file.separated(first, file.count(*header["NDATA"]))
    line, peak = header.get("PGA_CM/S^2", (0, ""))
    return [
        Channel(
            samples,
            file.unit(*header["UNITS"]),
            file.step(*header["SAMPLING_INTERVAL_S"]),
            "ESM",
            header.get("STATION_NAME", (0, ""))[1],
            header.get("STREAM", (0, ""))[1],
            file.peak(line, peak, "cm/s²") if peak else None,
        )
    ]
