"""Report of a fragility, as text, JSON, CSV and netCDF."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import attrs

from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.output.files import write_result
from rocking.cli.reports.validity import equation_line, survey_warnings, warned
from rocking.model.record_results import Fragility, limit_name
from rocking.model.text import counted, percent_with_ends

COLUMNS = ("fraction", "fraction_low", "fraction_high", "fit", "fit_low", "fit_high")
FEW = 10
"""Number of records below which the report warns."""


def write(found: Fragility, files: Mapping[str, Path]) -> None:
    """Write the plot, the table and the dataset."""
    write_result(
        files,
        figure=lambda plot: plot.fragility(found),
        tables=lambda: tables(found),
        data=lambda: found.dataset,
    )


def tables(found: Fragility) -> Iterator[dict[str, Any]]:
    """Yield one table for each limit."""
    import numpy as np

    data = found.dataset
    for number, limit in enumerate(data.limit.values.tolist()):
        yield {
            "limit [theta_cr]": np.full(data.sizes["scale"], limit),
            "limit [deg]": np.full(data.sizes["scale"], found.block.degrees(limit)),
            heading(found, "[", "]"): data.scale.values,
        } | {name: data[name].values[number] for name in COLUMNS}


def show(found: Fragility, doubts: Sequence[str], files: list[Path], *, as_json: bool) -> None:
    """Print the fits and the probabilities, with warnings, and the paths of the files."""
    model = found.dataset.attrs["model"]
    doubts = [*doubts, *_warnings(found), *survey_warnings(found.block, model)]
    if as_json:
        print_json(record(found, files) | {"warnings": list(doubts)})
    else:
        print_table(str(found), rows(found), files, [equation_line(found.block, model), *warned(doubts)])


def few_records(count: int) -> Iterator[str]:
    """Yield a warning if the records are too few for intervals."""
    if count < FEW:
        yield f"{counted(count, 'record')} can hardly say how much records differ: use {FEW} or more"


def _warnings(found: Fragility) -> Iterator[str]:
    data = found.dataset
    yield from few_records(data.sizes["record"])
    undecided = int((data.certified == 0).sum())
    if undecided:
        yield f"{undecided:,} of {data.peak.size:,} runs are undecided in double precision; the intervals cover both outcomes"


def heading(found: Fragility, *brackets: str) -> str:
    """Return symbol and unit of the levels."""
    attributes = found.dataset.scale.attrs
    unit = "" if attributes["units"] in ("", "1") else f" {brackets[0]}{attributes['units']}{brackets[1]}"
    return f"{attributes['symbol']}{unit}"


def rows(found: Fragility) -> Iterator[Row]:
    """Yield the probabilities of each limit and the fits."""
    data = found.dataset
    limits = data.limit.values.tolist()
    yield (heading(found, "(", ")"), *(_heading(found, limit) for limit in limits))
    for place, level in enumerate(data.scale.values.tolist()):
        yield (
            f"{level:.4g}",
            *(
                percent_with_ends(value, low, high)
                for value, low, high in zip(
                    *(data[name].values[:, place].tolist() for name in COLUMNS[:3]), strict=True
                )
            ),
        )
    yield ("median", *(_number(fit.median, fit.median_low, fit.median_high) for fit in found.fits))
    yield (
        "dispersion",
        *(_number(fit.dispersion, fit.dispersion_low, fit.dispersion_high) for fit in found.fits),
    )


def _heading(found: Fragility, limit: float) -> str:
    return (
        limit_name(limit) if math.isinf(limit) else f"|θ| > {found.block.degrees(limit):.3g}° = {limit:g} θcr"
    )


def _number(value: float, low: float, high: float) -> str:
    if math.isnan(value):
        return "–"
    return f"{value:.3g} ({low:.3g}–{'∞' if math.isinf(high) else f'{high:.3g}'})"


def record(found: Fragility, files: list[Path]) -> dict[str, Any]:
    """Return the result as a JSON object; an infinite limit is null."""
    data = found.dataset
    curves = [
        attrs.asdict(fit)
        | {"limit_degrees": float(found.block.degrees(fit.limit))}
        | {name: data[name].values[number].tolist() for name in COLUMNS}
        for number, fit in enumerate(found.fits)
    ]
    return {
        "block": {
            "height_m": found.block.height,
            "width_m": found.block.width,
            "restitution": found.block.restitution,
        },
        "records": data.name.values.tolist(),
        "records_sha256": data.attrs["records_sha256"],
        "samples": data.sizes.get("sample", 1),
        "undecided": int((data.certified == 0).sum()),
        "model": data.attrs["model"],
        "intensity": data.attrs["intensity"],
        "unit": data.scale.attrs["units"],
        "levels": data.scale.values.tolist(),
        "rocking": data.rocking.values.tolist(),
        "curves": curves,
        "files": [str(path) for path in files],
    }
