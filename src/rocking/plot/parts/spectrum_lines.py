"""Lines of a rocking spectrum: one per record and slenderness."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import xarray as xr


class Line(NamedTuple):
    """Line of a spectrum, of one record and one slenderness, whose number counts from 0."""

    name: str
    slenderness_number: int
    slenderness: str
    peak: np.ndarray
    overturned: np.ndarray
    certified: np.ndarray


def overturned_runs(found: xr.Dataset) -> Any:
    """Return which runs overturned, as an array with the dimensions of the spectrum."""
    meanings = found.outcome.attrs["flag_meanings"].split()
    return found.outcome == meanings.index("overturned")


def value(found: xr.Dataset, name: str) -> Any:
    """Return a quantity of the survey, whether it varies or not."""
    return found[name].values if name in found.coords else found.attrs[name]


def lines_of(found: xr.Dataset, name: str, unit: str) -> Iterator[Line]:
    """Yield the lines, the slendernesses of each record.

    `name` is the quantity of the horizontal axis, "size" or "slenderness". `unit` is that of the angle, "critical" or "degrees".
    """
    degrees = np.degrees(np.asarray(value(found, "slenderness"), float))
    fell = overturned_runs(found)
    peaks = found.peak * (np.degrees(found["slenderness"]) if "slenderness" in found.peak.dims else degrees)
    shown = found.peak if unit == "critical" else peaks
    records = range(found.sizes["record"]) if "record" in found.dims else [None]
    angles = range(found.sizes["slenderness"]) if name == "size" and "slenderness" in found.dims else [None]
    for record in records:
        for angle in angles:
            at = {key: k for key, k in (("record", record), ("slenderness", angle)) if k is not None}
            slenderness = ""
            if name != "slenderness" and (angle is not None or record is None):
                slenderness = rf"$\theta_\mathrm{{cr}}$ = {degrees.flat[angle or 0]:.3g}°"
            parts = ["" if record is None else str(found.name.values[record]), slenderness]
            yield Line(
                ", ".join(filter(None, parts)) or "peak",
                angle or 0,
                slenderness,
                np.where(fell.isel(at), np.nan, shown.isel(at)),
                fell.isel(at).values,
                found.certified.isel(at).values != 0,
            )
