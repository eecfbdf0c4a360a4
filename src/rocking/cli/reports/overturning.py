"""Report of the lowest overturning amplitudes, as text, JSON, CSV and netCDF."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking.cli.output import survey_run
from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.output.files import with_fixed
from rocking.cli.output.survey_run import MAX_ROWS
from rocking.cli.reports.motion import asked_in_si, in_si
from rocking.cli.reports.validity import warned, warnings
from rocking.model.block import PHYSICAL, Block
from rocking.model.block_formulas import GRAVITY
from rocking.model.survey_results import OverturningCurve

if TYPE_CHECKING:
    import xarray as xr


LEVELS = ("lowest", "resolution", "survived_up_to")
"""Variables of the result that are amplitudes."""
FIXED = ("period", "frequency", "restitution", "critical_angle")
"""Quantities of a system that are attributes of the result if they do not vary; the phase of the base varies in every row."""


def write(found: OverturningCurve, files: Mapping[str, Path], block: Block | None) -> None:
    """Write the plot, one row per value as CSV, and the dataset; with a block, amplitudes also in SI."""
    data = found.dataset
    if block is not None:
        amplitude = PHYSICAL["amplitude"]
        levels = {
            _key(name): (
                data[name].dims,
                amplitude.turn(block, data[name].values),
                {"long_name": f"{data[name].attrs['long_name']}, in SI", "units": amplitude.cf},
            )
            for name in LEVELS
        }
        data = data.assign(levels)
    survey_run.write(OverturningCurve(data), "overturning", files, block, lambda: [_table(found, block)])


def _table(found: OverturningCurve, block: Block | None) -> dict[str, Any]:
    """Return columns by heading: system of each row, then all variables; amplitudes with a block also in SI."""
    import numpy as np

    data, unit = found.dataset, PHYSICAL["amplitude"]
    over = [str(name) for name in data.lowest.dims]
    grids = np.meshgrid(*(data[name].values for name in over), indexing="ij")
    levels = {name: data[name].values.ravel() for name in LEVELS}
    table: dict[str, Any] = {name: grid.ravel() for name, grid in zip(over, grids, strict=True)}
    table |= {f"{name} [{unit.normalised}]": level for name, level in levels.items()}
    table |= {name: data[name].values.ravel() for name in ("lowest_phase", "surviving_above", "undetermined")}
    table = with_fixed(table, over, {name: data.attrs[name] for name in FIXED if name in data.attrs})
    if block is None:
        return table
    return table | {f"{name}_{unit.heading}": unit.turn(block, level) for name, level in levels.items()}


def _key(level: str) -> str:
    return f"{level}_{PHYSICAL['amplitude'].key}"


def show(found: OverturningCurve, block: Block | None, files: list[Path], *, as_json: bool) -> None:
    """Print the lowest overturning amplitudes."""
    doubts = _warnings(found, block)
    if as_json:
        physical = {} if block is None else {"block": asked_in_si(found.dataset, block), "warnings": doubts}
        print_json(record(found, block, files) | physical)
    else:
        print_table(title(found, block), rows(found, block), files, warned(doubts))


def title(found: OverturningCurve, block: Block | None) -> str:
    """Return the lowest amplitude of all in one line; with a block, in SI first."""
    lowest = found.dataset.lowest
    if block is None:
        return str(found)
    if lowest.isnull().all():
        return f"{found}: {in_si('amplitude', found.dataset.amplitude.values[[0, -1]], block)}"
    where = lowest.isel({} if lowest.ndim == 0 else lowest.argmin(...))
    at = [in_si(str(name), float(where[name]), block) for name in lowest.dims]
    motion = " and ".join([in_si("amplitude", float(where), block), *filter(None, at)])
    return f"a block of {block.size} overturns from rest at {motion}; normalised: {found}"


def _warnings(found: OverturningCurve, block: Block | None) -> list[str]:
    data = found.dataset
    lowest = data.lowest.values[data.lowest.notnull().values]
    restitution = data.restitution.values if "restitution" in data.coords else data.attrs["restitution"]
    full = "critical_angle" in (*data.coords, *data.attrs)
    return warnings(block, lowest, restitution, full=full)


COLUMNS = (*LEVELS, "surviving_above")


def rows(found: OverturningCurve, block: Block | None) -> Iterator[Row]:
    """Yield one row per value of the varied quantities; with a block, also in SI."""
    data = found.dataset
    over = [str(name) for name in data.lowest.dims]
    known = [] if block is None else [name for name in over if name in PHYSICAL]
    heading = (*over, "lowest A", "scan step", "all survive up to", "survive above")
    in_units = () if block is None else ("m/s²", "g", "scan step, m/s²", "up to, m/s²")
    yield (*heading, *(PHYSICAL[name].unit for name in known), *in_units)
    for index in list(_places(data))[:MAX_ROWS]:
        at = {name: data[name].values[k] for name, k in zip(over, index, strict=True)}
        low, step, up_to, above = (float(data[name].values[index]) for name in COLUMNS)
        cells = [
            *(f"{value:.6g}" for value in at.values()),
            "none" if math.isnan(low) else f"{low:.6g}",
            _number(step),
            _number(up_to),
            "–" if math.isnan(above) else f"{100 * above:.3g} %",
        ]
        if block is not None:
            cells += [f"{PHYSICAL[name].turn(block, at[name]):.4g}" for name in known]
            levels = [block.acceleration(level) for level in (low, step, up_to)]
            cells += [_number(level, 4) for level in (levels[0], levels[0] / GRAVITY, *levels[1:])]
        yield tuple(cells)
    left = data.lowest.size - MAX_ROWS
    if left > 0:
        rest = len(heading) + len(known) + len(in_units) - 1
        yield (f"and {left} more (all of them with --json, --csv, --netcdf or --plot)", *[""] * rest)


def record(found: OverturningCurve, block: Block | None, files: list[Path]) -> dict[str, Any]:
    """Return the result as a JSON object."""
    data = found.dataset
    over = [str(name) for name in data.lowest.dims]
    amplitudes = data.amplitude.values
    rows = [
        {name: float(data[name].values[k]) for name, k in zip(over, index, strict=True)}
        | {name: float(data[name].values[index]) for name in (*COLUMNS, "lowest_phase", "undetermined")}
        for index in _places(data)
    ]
    if block is not None:
        for row in rows:
            row |= {
                PHYSICAL[name].key: float(PHYSICAL[name].turn(block, row[name]))
                for name in over
                if name in PHYSICAL
            }
            row |= {_key(name): PHYSICAL["amplitude"].turn(block, row[name]) for name in LEVELS}
    fixed = {name: data.attrs[name] for name in FIXED if name in data.attrs}
    scanned = {"start": float(amplitudes[0]), "stop": float(amplitudes[-1]), "count": int(amplitudes.size)}
    return {
        **fixed,
        "amplitude": scanned,
        "phases": int(data.phase.size),
        "curve": rows,
        "files": [str(path) for path in files],
    }


def _places(data: xr.Dataset) -> Iterator[tuple[int, ...]]:
    import numpy as np

    yield from np.ndindex(*data.lowest.shape)


def _number(number: float, digits: int = 6) -> str:
    return "–" if math.isnan(number) else f"{number:.{digits}g}"
