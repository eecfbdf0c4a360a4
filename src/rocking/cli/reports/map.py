"""Report of a parametric map, as text or JSON."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.cli.option_names import COUNTS, QUANTITIES
from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.reports.motion import asked_in_si, beyond, in_si
from rocking.cli.reports.validity import warned, warnings
from rocking.model.block import Block
from rocking.model.text import counted, percent
from rocking.model.verdict import Criterion

if TYPE_CHECKING:
    import xarray as xr


def show(found: xr.Dataset, block: Block | None, files: list[Path], *, as_json: bool) -> None:
    """Print the fractions of the response types on stdout, and the paths of the files."""
    from rocking.survey.export import counts

    kinds, criteria = counts(found, "kind"), counts(found, "evidence")
    full = "critical_angle" in (*found.coords, *found.attrs)
    doubts = warnings(block, _values(found, "amplitude"), _values(found, "restitution"), full=full)
    if as_json:
        in_units = {} if block is None else {"block": asked_in_si(found, block), "warnings": doubts}
        print_json(record(found, kinds, criteria, files) | in_units)
        return
    size = " × ".join(f"{found.sizes[name]:,}" for name in found.kind.dims)
    rows = [*_asked(found, block), *_found(kinds, criteria)]
    farthest = float(max(np.atleast_1d(_values(found, "angle")), key=abs))
    more = [*beyond(farthest, block), *warned(doubts)]
    print_table(f"parametric map, {size} points", rows, files, more)


def _values(found: xr.Dataset, name: str) -> Any:
    """Return the values of an axis, or the value of a quantity that does not vary."""
    return found[name].values if name in found.coords else found.attrs[name]


def _asked(found: xr.Dataset, block: Block | None) -> Iterator[Row]:
    for name in map(str, found.kind.dims):
        first, last = found[name].values[[0, -1]]
        yield name, f"{first:.6g} to {last:.6g}", in_si(name, (first, last), block)
    for name in (*QUANTITIES, "max_cycles"):
        if name in found.attrs:
            value = found.attrs[name]
            yield name.replace("_", " "), f"{value:.6g}", in_si(name, value, block)


def _found(kinds: dict[str, int], criteria: dict[str, int]) -> Iterator[Row]:
    total = sum(kinds.values())
    for kind, count in kinds.items():
        if count:
            yield kind, percent(count / total), counted(count, "point")
    for criterion in Criterion:
        count = criteria[str(criterion)]
        if criterion.why and count:
            yield f"  {criterion}", percent(count / total), f"{counted(count, 'point')}: {criterion.why}"


def record(
    found: xr.Dataset, kinds: dict[str, int], criteria: dict[str, int], files: list[Path]
) -> dict[str, Any]:
    """Return the result as a JSON object."""
    axes = {
        str(name): {
            "start": float(found[name][0]),
            "stop": float(found[name][-1]),
            "count": found.sizes[name],
        }
        for name in found.kind.dims
    }
    return {
        "axes": axes,
        **{name: found.attrs[name] for name in (*QUANTITIES, *COUNTS) if name in found.attrs},
        "points": sum(kinds.values()),
        "kinds": kinds,
        "evidence": criteria,
        "files": [str(path) for path in files],
    }
