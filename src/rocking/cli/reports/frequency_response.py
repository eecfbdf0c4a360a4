"""Report of a frequency response, as text, JSON, CSV and netCDF."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.cli.output.console import Row, aligned, print_json, print_table
from rocking.cli.output.files import columns, with_block, with_fixed, write_result
from rocking.cli.reports.branch import value_record
from rocking.cli.reports.motion import asked_in_si, in_si, reach
from rocking.cli.reports.validity import warned, warnings
from rocking.model.block import Block

if TYPE_CHECKING:
    from rocking.orbits.branch import Branch
    from rocking.orbits.frequency_response import FrequencyResponse


def write(found: FrequencyResponse, block: Block | None, files: Mapping[str, Path]) -> None:
    """Write the plot, the points of the branches and the responses from rest as CSV, and the dataset."""
    write_result(
        files,
        figure=lambda plot: plot.frequency_response(found, block=block),
        tables=lambda: _tables(found, block),
        data=lambda: with_block(found.to_xarray(), block),
    )


def _tables(found: FrequencyResponse, block: Block | None) -> Iterator[dict[str, Any]]:
    """Yield one table (columns by heading) per branch, and one of the responses from rest; cells that do not apply are empty."""
    fixed = found.to_xarray().attrs
    for table in _varying(found):
        yield columns(with_fixed(table, ["branch", found.parameter], fixed), block)


def _varying(found: FrequencyResponse) -> Iterator[dict[str, Any]]:
    """Yield the columns that vary, for each branch and for the responses from rest."""
    for number, branch in enumerate(found.branches):
        count = len(branch)
        yield {
            "branch": np.full(count, str(number)),
            "orbit_period": np.full(count, branch.period),
            "symmetric": np.full(count, str(branch.symmetric)),
            found.parameter: branch.points["parameter"],
            "stability": branch.points["stability"],
            "response": np.full(count, ""),
            "peak": branch.points["peak"],
        }
    rest, count = found.rest, len(found.values)
    yield {
        "branch": np.full(count, "from rest"),
        "orbit_period": rest["period"],
        "symmetric": np.full(count, ""),
        found.parameter: found.values,
        "stability": np.full(count, ""),
        "response": rest["kind"],
        "peak": _steady(found),
    }


def _steady(found: FrequencyResponse) -> np.ndarray:
    """Return the largest |Θ| of each response from rest: of the steady response or, without one, from the initial state on."""
    rest = found.rest
    return np.where(np.isnan(rest["steady_peak"]), rest["peak"], rest["steady_peak"])


def show(
    found: FrequencyResponse, block: Block | None, typed: str, files: Sequence[Path], *, as_json: bool
) -> None:
    """Print the branches and the responses from rest on stdout, and the paths of the files."""
    if as_json:
        print_json(record(found, block, files))
        return
    name, ends = found.parameter, found.values[[0, -1]]
    rows = [
        ("varied", typed, in_si(name, ends, block)),
        ("amplitude", f"A = {found.amplitude:.6g}", in_si("amplitude", found.amplitude, block)),
        ("restitution", f"e = {found.restitution:.6g}", ""),
    ]
    branches = ["", *aligned([*_branches(found, block)])] if found.branches else []
    print_table(str(found), rows, files, [*branches, *warned(_warnings(found, block))])


def _branches(found: FrequencyResponse, block: Block | None) -> Iterator[Row]:
    """Yield the heading and one row per branch."""
    name = found.parameter
    yield "branch", "orbits", name, "largest |Θ|", f"at {name}", "special points"
    for number, branch in enumerate(found.branches):
        values = branch.points["parameter"]
        low, high = float(values.min()), float(values.max())
        place, peak = _largest(branch)
        yield (
            f"{number}",
            f"(1, {branch.period}), {'' if branch.symmetric else 'a'}symmetric",
            f"{low:.6g} to {high:.6g}{_beside(name, (low, high), block)}",
            f"{peak:.6g}" + ("" if block is None else f" = {reach(peak, block)}"),
            f"{place:.6g}{_beside(name, place, block)}",
            ", ".join(
                f"{one.kind} at {one.parameter:.6g}{_beside(name, one.parameter, block)}"
                for one in branch.special
            )
            or "none",
        )


def _beside(name: str, values: Any, block: Block | None) -> str:
    physical = in_si(name, values, block)
    return f" = {physical}" if physical else ""


def _largest(branch: Branch) -> tuple[float, float]:
    """Return the parameter and the value of the largest |Θ| of a branch."""
    point = branch.points[int(np.nanargmax(branch.points["peak"]))]
    return float(point["parameter"]), float(point["peak"])


def _warnings(found: FrequencyResponse, block: Block | None) -> list[str]:
    return warnings(block, found.amplitude, found.restitution)


def record(found: FrequencyResponse, block: Block | None, files: Sequence[Path]) -> dict[str, Any]:
    """Return the frequency response as a JSON object."""
    result = {
        "parameter": found.parameter,
        "first": float(found.values[0]),
        "last": float(found.values[-1]),
        "count": len(found.values),
        "amplitude": found.amplitude,
        "restitution": found.restitution,
        "modes": list(found.modes),
        "branches": [_branch(branch, block) for branch in found.branches],
        "from_rest": dict(Counter(found.rest["kind"].tolist())),
        "files": [str(path) for path in files],
    }
    if block is None:
        return result
    return result | {"block": asked_in_si(found.to_xarray(), block), "warnings": _warnings(found, block)}


def _branch(branch: Branch, block: Block | None) -> dict[str, Any]:
    """Return a branch as a JSON object."""
    place, peak = _largest(branch)
    return {
        "orbit_period": branch.period,
        "symmetric": branch.symmetric,
        "points": len(branch),
        "stable_points": int(branch.points["stable"].sum()),
        "peak": peak,
        **({} if block is None else {"peak_deg": float(block.degrees(peak))}),
        "peak_at": value_record(branch.name, place, block),
        "special": [
            {"kind": one.kind} | value_record(one.name, one.parameter, block) for one in branch.special
        ],
        "ends": list(branch.ends),
    }
