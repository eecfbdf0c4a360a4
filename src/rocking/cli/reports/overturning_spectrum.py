"""Report of an overturning spectrum of pulses, as text, JSON, CSV and netCDF."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.output.files import columns, with_block, with_fixed, write_result
from rocking.cli.reports.motion import asked_in_si, in_si
from rocking.cli.reports.spectrum import axes_of, undecided, values
from rocking.cli.reports.validity import warned, warnings
from rocking.model.block import Block
from rocking.model.text import counted, percent
from rocking.model.verdict import Outcome

if TYPE_CHECKING:
    import xarray as xr

MODES = ("no impact", "1 impact", "2 or more impacts")


def write(found: xr.Dataset, files: Mapping[str, Path], block: Block | None) -> None:
    """Write the plot, one row per run as CSV, and the dataset; with a block also in SI."""
    from rocking.survey.export import tables

    write_result(
        files,
        figure=lambda plot: plot.overturning_spectrum(found, block=block),
        tables=lambda: (
            columns(with_fixed(table, found.outcome.dims, found.attrs), block) for table in tables(found)
        ),
        data=lambda: with_block(found.load(), block),
    )


def show(found: xr.Dataset, block: Block | None, files: Sequence[Path], *, as_json: bool) -> None:
    """Print the fractions of the outcomes and of the modes of overturning, and the paths of the files."""
    from rocking.survey.export import counts

    outcomes, doubtful = counts(found, "outcome"), counts(found, "certified")["undecided"]
    full = "critical_angle" in (*found.coords, *found.attrs)
    doubts = [
        *warnings(block, values(found, "amplitude"), values(found, "restitution"), full=full),
        *undecided(doubtful),
    ]
    if as_json:
        in_units = {} if block is None else {"block": asked_in_si(found, block)}
        paths = {"warnings": doubts, "files": [str(path) for path in files]}
        print_json(record(found, outcomes, doubtful) | in_units | paths)
        return
    title = f"overturning spectrum of {found.attrs['pulse']} pulses, {counted(sum(outcomes.values()), 'run')}"
    print_table(title, rows(found, outcomes, block), list(files), warned(doubts))


def rows(found: xr.Dataset, outcomes: Mapping[str, int], block: Block | None) -> Iterator[Row]:
    """Yield the quantities, the outcomes, the modes and the lowest amplitude that overturns."""
    for name in map(str, found.outcome.dims):
        first, last = found[name].values[[0, -1]]
        yield name, f"{first:.6g} to {last:.6g} ({found.sizes[name]:,})", in_si(name, (first, last), block)
    if "restitution" in found.attrs:
        yield "restitution", f"{found.attrs['restitution']:.6g}", ""
    total = sum(outcomes.values())
    for outcome, count in outcomes.items():
        if count:
            yield outcome, percent(count / total), counted(count, "run")
    for mode, count in modes(found).items():
        if count:
            yield f"  {mode}", percent(count / total), counted(count, "run")
    lowest = lowest_overturning(found)
    if lowest is not None:
        yield "lowest amplitude that overturns", f"{lowest:.6g}", in_si("amplitude", lowest, block)


def _overturned(found: xr.Dataset) -> xr.DataArray:
    return found.outcome == tuple(Outcome).index(Outcome.OVERTURNED)


def modes(found: xr.Dataset) -> dict[str, int]:
    """Return the number of runs that overturn, by the impacts since the block last rested."""
    impacts = np.minimum(found.impacts_since_rest.values[_overturned(found).values], len(MODES) - 1)
    return dict(zip(MODES, np.bincount(impacts.astype(int), minlength=len(MODES)).tolist(), strict=True))


def lowest_overturning(found: xr.Dataset) -> float | None:
    """Return the lowest amplitude that overturns a block at any frequency; None if there is none."""
    fell = _overturned(found)
    over = found["amplitude"].values[fell.any([name for name in fell.dims if name != "amplitude"]).values]
    return float(over[0]) if over.size else None


def record(found: xr.Dataset, outcomes: Mapping[str, int], undecided: int) -> dict[str, Any]:
    """Return the result as a JSON object."""
    return {
        "pulse": found.attrs["pulse"],
        "axes": axes_of(found.outcome),
        **{name: found.attrs[name] for name in ("restitution",) if name in found.attrs},
        "runs": sum(outcomes.values()),
        "outcomes": dict(outcomes),
        "modes": modes(found),
        "undecided": undecided,
        "lowest_overturning_amplitude": lowest_overturning(found),
    }
