"""Report of the sensitivity of verdicts, as text, JSON, CSV and netCDF."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.output.files import write_csv, write_dataset
from rocking.cli.reports.fragility import few_records
from rocking.cli.reports.motion import size_of
from rocking.cli.reports.validity import equation_line, survey_warnings, warned
from rocking.model.block import block_attributes
from rocking.model.record_results import Sensitivity
from rocking.model.text import counted, percent_with_ends

COLUMNS = ("change", "share", "share_low", "share_high", "flipped", "runs", "undecided")


def write(found: Sensitivity, files: Mapping[str, Path]) -> None:
    """Write one row per change as CSV, and the dataset."""
    if "csv" in files:
        write_csv([{name: found.dataset[name].values for name in COLUMNS}], files["csv"])
    if "netcdf" in files:
        write_dataset(found.dataset.assign_attrs(block_attributes(found.block)), files["netcdf"])


def show(found: Sensitivity, doubts: Sequence[str], files: Sequence[Path], *, as_json: bool) -> None:
    """Print the fraction of the verdicts that each change reverses, with warnings, and the paths of the files."""
    data = found.dataset
    model = data.attrs["model"]
    few = few_records(data.sizes["record"])
    doubts = [*doubts, *few, *_undecided(found), *survey_warnings(found.block, model)]
    if as_json:
        print_json(record(found) | {"warnings": doubts, "files": [str(path) for path in files]})
        return
    title = f"verdicts that small changes reverse, of {counted(data.overturned.size, 'run')} of {counted(data.sizes['record'], 'record')}"
    print_table(title, rows(found), files, [equation_line(found.block, model), *warned(doubts)])


def _undecided(found: Sensitivity) -> Iterator[str]:
    count = int(found.dataset.undecided.max())
    if count:
        yield f"{counted(count, 'run')} undecided in double precision; the intervals cover both outcomes"


def rows(found: Sensitivity) -> Iterator[Row]:
    """Yield one row per change."""
    yield "change", "fraction reversed", "runs"
    for change, share, low, high, flipped, *_ in _values(found):
        yield change, percent_with_ends(share, low, high), f"{flipped:,}"


def _values(found: Sensitivity) -> Iterator[tuple[Any, ...]]:
    return zip(*(found.dataset[name].values.tolist() for name in COLUMNS), strict=True)


def record(found: Sensitivity) -> dict[str, Any]:
    """Return the result as a JSON object."""
    data = found.dataset
    return {
        "block": size_of(found.block) | {"restitution": found.block.restitution},
        "model": data.attrs["model"],
        "intensity": data.attrs["intensity"],
        "levels": data.scale.values.tolist(),
        "records": data.name.values.tolist(),
        "records_sha256": data.attrs["records_sha256"],
        "overturned": int(data.overturned.sum()),
        "changes": [dict(zip(COLUMNS, each, strict=True)) for each in _values(found)],
    }
