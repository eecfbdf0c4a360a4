"""Report of a safe basin, as text, JSON, CSV and netCDF."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.option_names import QUANTITIES, START
from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.output.files import columns, with_block, with_fixed, write_result
from rocking.cli.output.survey_run import MAX_ROWS, share_record
from rocking.cli.reports.motion import asked_in_si, in_si
from rocking.cli.reports.validity import warned, warnings
from rocking.model.block import PHYSICAL, Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.survey_results import SafeBasin
from rocking.model.text import percent

if TYPE_CHECKING:
    import xarray as xr

KEY = PHYSICAL["amplitude"].key
THRESHOLDS = {"heteroclinic": "exact tangency A*", "melnikov": "Melnikov's A_M"}


def write(found: SafeBasin, block: Block | None, files: Mapping[str, Path]) -> None:
    """Write the plot, one row per amplitude as CSV, and the dataset; with a block also in SI."""
    from rocking.survey.export import tables

    data = found.dataset
    write_result(
        files,
        figure=lambda plot: plot.safe_basin(found, block=block),
        tables=lambda: (
            columns(with_fixed(table, ["amplitude"], data.attrs) | _drawn(table, data), block)
            for table in tables(data)
        ),
        data=lambda: _dataset(found, block),
    )


def _drawn(table: Mapping[str, Any], data: xr.Dataset) -> dict[str, Any]:
    """Return the columns of the random initial states: their ranges, number and seed."""
    import numpy as np

    ranges = {
        f"{name}_{end}": bound
        for name in START
        for end, bound in zip(("low", "high"), data.attrs[f"{name}_range"], strict=True)
    }
    drawn = ranges | {name: data.attrs[name] for name in ("samples", "seed")}
    return {name: np.full(len(table["amplitude"]), value) for name, value in drawn.items()}


def _dataset(found: SafeBasin, block: Block | None) -> xr.Dataset:
    return with_block(found.dataset, block).assign_attrs(_thresholds_in_si(found, block))


def _thresholds_in_si(found: SafeBasin, block: Block | None) -> dict[str, float]:
    """Return the thresholds of the amplitude in SI, by name; none without a block."""
    if block is None:
        return {}
    return {
        f"{name}_{KEY}": float(block.acceleration(getattr(found, f"{name}_amplitude"))) for name in THRESHOLDS
    }


def show(found: SafeBasin, block: Block | None, files: Sequence[Path], *, as_json: bool) -> None:
    """Print the safe fraction at each amplitude, and the paths of the files."""
    data = found.dataset
    full = "critical_angle" in data.attrs
    doubts = warnings(block, data.amplitude.values, data.attrs["restitution"], full=full)
    if as_json:
        in_units = {} if block is None else {"block": asked_in_si(data, block), "warnings": doubts}
        print_json(record(found, block, files) | in_units)
        return
    print_table(str(found), rows(found, block), files, [*_tangencies(found, block), *warned(doubts)])


def rows(found: SafeBasin, block: Block | None) -> Iterator[Row]:
    """Yield one row per amplitude; with a block, also in SI."""
    in_units = () if block is None else ("m/s²", "g")
    yield ("amplitude A", "safe fraction", "undetermined", *in_units)
    amplitudes = found.dataset.amplitude.values
    places = list(zip(amplitudes, found.shares, found.dataset.undetermined.values, strict=True))
    for amplitude, share, unknown in places[:MAX_ROWS]:
        accelerations = () if block is None else _accelerations(float(block.acceleration(amplitude)))
        yield (f"{amplitude:.6g}", str(share), percent(float(unknown)), *accelerations)
    if len(places) > MAX_ROWS:
        left = f"and {len(places) - MAX_ROWS} more (all of them with --json, --csv, --netcdf or --plot)"
        yield (left, "", "", *[""] * len(in_units))


def _accelerations(acceleration: float) -> Row:
    return f"{acceleration:.4g}", f"{acceleration / GRAVITY:.4g}"


def _tangencies(found: SafeBasin, block: Block | None) -> Iterator[str]:
    """Yield the thresholds in SI, if there are any."""
    if block is None or math.isnan(found.heteroclinic_amplitude):
        return
    for name, text in THRESHOLDS.items():
        yield f"{text} = {in_si('amplitude', getattr(found, f'{name}_amplitude'), block)}"


def record(found: SafeBasin, block: Block | None, files: Sequence[Path]) -> dict[str, Any]:
    """Return the result as a JSON object."""
    data = found.dataset
    fractions = [
        {
            "amplitude": float(amplitude),
            **({} if block is None else {KEY: PHYSICAL["amplitude"].turn(block, amplitude)}),
            "safe": share_record(share),
            "undetermined": float(unknown),
        }
        for amplitude, share, unknown in zip(
            data.amplitude.values, found.shares, data.undetermined.values, strict=True
        )
    ]
    return {
        **{name: data.attrs[name] for name in QUANTITIES if name in data.attrs},
        "angle": data.attrs["angle_range"],
        "velocity": data.attrs["velocity_range"],
        "samples": data.attrs["samples"],
        "seed": data.attrs["seed"],
        "heteroclinic_amplitude": found.heteroclinic_amplitude,
        "melnikov_amplitude": found.melnikov_amplitude,
        **_thresholds_in_si(found, block),
        "fractions": fractions,
        "files": [str(path) for path in files],
    }
