"""Report of an overturning set, in SI units, as text or JSON."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.output.files import write_result
from rocking.cli.output.survey_run import MAX_ROWS
from rocking.cli.reports.motion import size_of
from rocking.cli.reports.validity import equation_line, survey_warnings, warned
from rocking.model.block import block_attributes
from rocking.model.record_results import OverturningSet
from rocking.model.text import percent


def write(found: OverturningSet, files: Mapping[str, Path]) -> None:
    """Write the plot, the switches and the dataset."""
    write_result(
        files,
        figure=lambda plot: plot.overturning_set(found),
        tables=lambda: [switches(found)],
        data=lambda: found.dataset.assign_attrs(block_attributes(found.block)),
    )


def switches(found: OverturningSet) -> dict[str, Any]:
    """Return the columns of the switches, with units in the headings of levels."""
    import numpy as np

    unit, rows = found.measure.unit or "1", found.switches
    levels = {"level", "certified_below", "certified_above"}
    names = np.array(found.records.names)[rows["record"]]
    columns = {f"{name} [{unit}]" if name in levels else name: rows[name] for name in rows.dtype.names or ()}
    return {"name": names} | columns


def show(found: OverturningSet, doubts: Sequence[str], files: Sequence[Path], *, as_json: bool) -> None:
    """Print the overturning levels of each record, the warnings `doubts` of the reader, and the paths of the files."""
    model = found.dataset.attrs["model"]
    doubts = [*doubts, *undecided(found), *survey_warnings(found.block, model)]
    if as_json:
        print_json(record(found, doubts, files))
    else:
        print_table(str(found), rows(found), files, [equation_line(found.block, model), *warned(doubts)])


def undecided(found: OverturningSet) -> Iterator[str]:
    """Yield a warning if rounding may have made a switch."""
    count = found.undecided.size
    if count:
        yield f"{count:,} of {found.switches.size:,} switches are undecided in double precision"


def rows(found: OverturningSet) -> Iterator[Row]:
    """Yield one row per record."""
    unit = "" if found.measure.unit in ("", "1") else f", {found.measure.unit}"
    yield (
        "record",
        f"lowest found{unit}",
        "intervals",
        "overturning share of the range",
        f"first intervals{unit}",
    )
    for number, name in list(enumerate(found.records.names))[:MAX_ROWS]:
        intervals = found.intervals(number)
        lowest = found.lowest[number]
        first = ", ".join(f"{low:.5g} to {high:.5g}" for low, high in intervals[:3].tolist())
        yield (
            name,
            "none" if math.isnan(lowest) else f"{lowest:.6g}",
            str(len(intervals)),
            percent(float(found.share[number])),
            first + ", …" * (len(intervals) > 3),
        )
    left = len(found.records) - MAX_ROWS
    if left > 0:
        yield (f"and {left} more (all of them with --json, --netcdf or --plot)", "", "", "", "")


def record(found: OverturningSet, doubts: Sequence[str], files: Sequence[Path]) -> dict[str, Any]:
    """Return the result as a JSON object."""
    block, data, rows = found.block, found.dataset, found.switches
    return {
        "intensity": data.attrs["intensity"],
        "unit": found.measure.unit,
        "levels": {
            "start": float(found.scales[0]),
            "stop": float(found.scales[-1]),
            "count": int(found.scales.size),
        },
        "spacing": found.spacing,
        "block": size_of(block) | {"restitution": block.restitution, "inertia_ratio": block.inertia_ratio},
        "model": data.attrs["model"],
        "angle": data.attrs["angle"],
        "polarity": data.attrs["polarity"],
        "records_sha256": data.attrs["records_sha256"],
        "records": [
            {
                "name": name,
                "lowest": float(found.lowest[number]),
                "share": float(found.share[number]),
                "intervals": found.intervals(number).tolist(),
                "switches": [
                    dict(zip(rows.dtype.names or (), each, strict=True))
                    for each in rows[rows["record"] == number].tolist()
                ],
            }
            for number, name in enumerate(found.records.names)
        ],
        "warnings": list(doubts),
        "files": [str(path) for path in files],
    }
