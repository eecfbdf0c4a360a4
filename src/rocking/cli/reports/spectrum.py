"""Report of a rocking spectrum, as text, JSON, CSV and netCDF."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.output.files import write_result
from rocking.cli.reports.validity import equation, shape_warnings, warned
from rocking.model.block import PHYSICAL
from rocking.model.record_set import RecordSet
from rocking.model.text import counted, percent

if TYPE_CHECKING:
    import xarray as xr

QUANTITIES = ("size", "slenderness", "restitution", "scale")
MOST_NAMES = 3


def write(found: xr.Dataset, files: Mapping[str, Path]) -> None:
    """Write the plot, one row per run as CSV, and the dataset."""
    write_result(
        files,
        figure=lambda plot: plot.rocking_spectrum(found),
        tables=lambda: tables(found),
        data=found.load,
    )


def tables(found: xr.Dataset) -> Iterator[dict[str, np.ndarray]]:
    """Yield columns by heading, with units: the record, the quantities that vary, and the results."""
    from rocking.survey.export import tables as rows_of

    for table in rows_of(found.drop_vars(["pga", "frequency_parameter"], errors="ignore")):
        columns: dict[str, np.ndarray] = {}
        if "record" in table:
            number = table.pop("record").astype(int)
            columns = {"record": number, "name": found["name"].values[number]}
        for name, column in table.items():
            unit = PHYSICAL[name].normalised if name in PHYSICAL else found[name].attrs.get("units", "1")
            columns[name if unit in ("1", "") else f"{name} [{unit}]"] = column
        slenderness = table["slenderness"] if "slenderness" in table else found.attrs["slenderness"]
        columns["peak [deg]"] = table["peak"] * np.degrees(slenderness)
        yield columns


def show(
    found: xr.Dataset, records: RecordSet, doubts: Sequence[str], files: Sequence[Path], *, as_json: bool
) -> None:
    """Print the fractions of the outcomes on stdout, with the warnings `doubts` of the reader, and the paths of the files."""
    from rocking.survey.export import counts

    outcomes = counts(found, "outcome")
    doubtful = counts(found, "certified")["undecided"]
    doubts = [*doubts, *undecided(doubtful), *_warnings(found)]
    if as_json:
        print_json(
            record(found, records, outcomes, doubtful) | {"warnings": doubts, "files": list(map(str, files))}
        )
        return
    total = sum(outcomes.values())
    rows = [*_asked(found, records), *_outcomes(outcomes, total), *_results(found)]
    print_table(f"rocking spectrum, {counted(total, 'run')}", rows, list(files), warned(doubts))


def _warnings(found: xr.Dataset) -> Iterator[str]:
    size, slenderness = values(found, "size").max(), values(found, "slenderness")
    height = float(2.0 * size * np.cos(slenderness.min()))
    yield from shape_warnings(height, float(slenderness.max()), full=found.attrs["model"] == "full")


def undecided(count: int) -> Iterator[str]:
    """Yield a warning if outcomes are undecided."""
    if count:
        yield f"{counted(count, 'outcome')} undecided in double precision: the rounding error may exceed what decides"


def values(found: xr.Dataset, name: str) -> np.ndarray:
    """Return the values of a quantity as an array."""
    return np.atleast_1d(found[name].values if name in found.dims else found.attrs[name])


def _asked(found: xr.Dataset, records: RecordSet) -> Iterator[Row]:
    names = (
        ", ".join(records.names)
        if len(records) <= MOST_NAMES
        else f"{records.names[0]}, …, {records.names[-1]}"
    )
    yield "records", f"{len(records)}: {names}"
    if found.attrs["intensity"] == "pga-g":
        yield "scaled to", f"PGA {_range(values(found, 'scale'))} g"
    else:
        pga = np.array([motion.pga for motion in records])
        yield "PGA", f"{_range(pga)} m/s², times {_range(values(found, 'scale'))}"
    yield "size R", f"{_range(values(found, 'size'))} m"
    yield "critical angle", f"{_range(np.degrees(values(found, 'slenderness')))}°"
    widest, full = float(values(found, "slenderness").max()), found.attrs["model"] == "full"
    yield "equation of motion", equation(widest, full=full)
    given = "restitution" in (*found.dims, *found.attrs)
    yield "restitution", _range(values(found, "restitution")) if given else "Housner's for each slenderness"


def _range(numbers: Any) -> str:
    """Return the smallest and the largest number, with their count if there are several."""
    low, high = float(np.min(numbers)), float(np.max(numbers))
    if np.size(numbers) == 1 or low == high:
        return f"{low:.6g}"
    return f"{low:.6g} to {high:.6g} ({np.size(numbers):,})"


def _outcomes(outcomes: dict[str, int], total: int) -> Iterator[Row]:
    for outcome, count in outcomes.items():
        if count:
            yield outcome, f"{percent(count / total)}, {counted(count, 'run')}"


def _results(found: xr.Dataset) -> Iterator[Row]:
    summary = results(found)
    if summary["largest_angle_deg"] is not None:
        yield (
            "largest |θ| of blocks that stand",
            f"{summary['largest_angle_deg']:.4g}°, {summary['largest_angle']:.4g} θcr",
        )
    if summary["largest_overturned_size_m"] is not None:
        yield "largest R that overturns", f"{summary['largest_overturned_size_m']:.6g} m"


def results(found: xr.Dataset) -> dict[str, Any]:
    """Return the largest angles of blocks that stand, and the largest size that overturns; None if there is none."""
    peak = found.peak
    degrees = peak * np.degrees(
        found["slenderness"] if "slenderness" in found.dims else found.attrs["slenderness"]
    )
    stands = np.isfinite(peak.values)
    fell = None
    if "size" in found.dims and not stands.all():
        over = np.isinf(peak).any([name for name in peak.dims if name != "size"])
        fell = float(found["size"].values[over.values].max())
    return {
        "largest_angle": float(peak.values[stands].max()) if stands.any() else None,
        "largest_angle_deg": float(degrees.values[stands].max()) if stands.any() else None,
        "largest_overturned_size_m": fell,
    }


def axes_of(variable: xr.DataArray) -> dict[str, Any]:
    """Return the axes of a variable as a JSON object, without that of the records."""
    return {
        str(name): {
            "start": float(variable[name][0]),
            "stop": float(variable[name][-1]),
            "count": variable.sizes[name],
        }
        for name in variable.dims
        if name != "record"
    }


def record(found: xr.Dataset, records: RecordSet, outcomes: dict[str, int], undecided: int) -> dict[str, Any]:
    """Return the result as a JSON object."""
    return {
        "records": [
            {
                "name": name,
                "pga_m_per_s2": motion.pga,
                "sha256": None if motion.file is None else motion.file.sha256,
            }
            for name, motion in zip(records.names, records, strict=True)
        ],
        "axes": axes_of(found.peak),
        **{
            name: found.attrs[name]
            for name in (*QUANTITIES, "inertia_ratio", "model", "intensity")
            if name in found.attrs
        },
        "runs": math.prod(found.peak.shape),
        "outcomes": outcomes,
        "undecided": undecided,
        **results(found),
    }
