"""Traces of ObsPy, an optional package: its formats, and its Stream and Trace."""

from __future__ import annotations

import io
import warnings
from typing import Any

import numpy as np

from rocking.model.package import missing_extra
from rocking.model.validation import RecordError
from rocking.records.text_file import TEXTS, Channel, Content

FORMATS = ("MSEED", "SAC", "SACXY", "KINEMETRICS_EVT", "GSE2")
"""Formats of ObsPy that are tried. Each is named, because its search for the format also unpickles a file."""


def is_stream(source: object) -> bool:
    """Return whether a value is a Stream or a Trace, or looks like one."""
    return hasattr(source, "traces") or (hasattr(source, "stats") and hasattr(source, "data"))


def read(content: Content, doubt: str) -> list[Channel]:
    """Read the traces of a file in one of the formats; `RecordError`, with the doubt about its text, if it has none."""
    if message := missing_extra("obspy"):
        more = "" if doubt.startswith(", line") else f"; {TEXTS}; {message}"
        raise RecordError(f"{content.name}{doubt}{more}")
    import obspy

    for name in FORMATS:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # most concern a format that the file does not have
                stream = obspy.read(io.BytesIO(content.data), format=name)
        except Exception:  # noqa: BLE001 - readers of other formats fail in any way
            continue
        return channels_of(stream, content.name, name)
    raise RecordError(f"{content.name}{doubt}; {TEXTS}, {', '.join(FORMATS)}")


def channels_of(source: Any, name: str, form: str) -> list[Channel]:
    """Return the channels of a Stream or of a Trace; their unit is unknown."""
    traces = list(getattr(source, "traces", [source]))
    if not traces:
        raise RecordError(f"{name}: no trace")
    return [_channel(trace, f"{name}, trace {number}", form) for number, trace in enumerate(traces, 1)]


def _channel(trace: Any, place: str, form: str) -> Channel:
    data = trace.data
    if np.ma.is_masked(data):
        raise RecordError(f"{place}: samples are missing; fill the gaps first, or cut the trace")
    samples = np.asarray(data)
    if samples.dtype.kind in "iu":
        remedy = "make an acceleration of them first: trace.remove_response(output='ACC')"
        raise RecordError(f"{place}: the samples are integers, that is, counts of the recorder ({remedy})")
    if samples.dtype.kind != "f" or samples.ndim != 1 or samples.size == 0:
        raise RecordError(f"{place}: a row of real numbers expected")
    stats = trace.stats
    station = ".".join(filter(None, (getattr(stats, key, "") for key in ("network", "station"))))
    step = float(stats.delta)
    return Channel(samples.astype(float), None, step, form, station, str(getattr(stats, "channel", "")))
