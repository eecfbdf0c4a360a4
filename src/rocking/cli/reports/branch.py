"""Report of a branch of periodic orbits, as text, JSON, CSV and netCDF."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.output.files import columns, with_block, with_fixed, write_result
from rocking.cli.reports.motion import asked_of, in_si, physical_of, question_of, reach, state_in_si
from rocking.cli.reports.orbits import multiplier_columns, orbit_record, orbit_warnings
from rocking.cli.reports.validity import warned
from rocking.model.block import PHYSICAL, Block
from rocking.model.orbit import Orbit
from rocking.model.system import quantities

if TYPE_CHECKING:
    import xarray as xr

    from rocking.orbits.branch import Branch, SpecialPoint

SAME_QUANTITY = {"period": "frequency", "frequency": "period"}
"""Quantities that vary together."""


def write(branch: Branch, orbit: Orbit, block: Block | None, files: Mapping[str, Path]) -> None:
    """Write the plot, one row per point as CSV, and the dataset with the fixed quantities of the system."""
    write_result(
        files,
        figure=lambda plot: plot.branch(branch, block=block),
        tables=lambda: [_table(branch, orbit, block)],
        data=lambda: _dataset(branch, orbit, block),
    )


def _table(branch: Branch, orbit: Orbit, block: Block | None) -> dict[str, Any]:
    """Return the points of a branch as columns by heading, with a block also in SI."""
    points, fixed = branch.points, _fixed(branch, orbit)
    table = {branch.name: points["parameter"]}
    # `phase` is that of the first event of a point.
    table |= {"forcing_phase": np.full(len(points), fixed.pop("phase"))}
    table |= {name: points[name] for name in ("phase", "velocity", "peak", "stability")}
    table |= multiplier_columns(points["multipliers"])
    return columns(with_fixed(table, [branch.name], fixed), block)


def _fixed(branch: Branch, orbit: Orbit) -> dict[str, float]:
    """Return the quantities of the system that do not vary along a branch."""
    varied = (branch.name, SAME_QUANTITY.get(branch.name))
    return {name: value for name, value in quantities(orbit.system).items() if name not in varied}


def _dataset(branch: Branch, orbit: Orbit, block: Block | None) -> xr.Dataset:
    """Return the dataset of a branch; with a block, its parameter has a coordinate in SI."""
    data = branch.to_xarray().assign_attrs(_fixed(branch, orbit))
    if block is not None:
        data = data.assign_coords({branch.name: data["parameter"]})
    return with_block(data, block)


def show(
    branch: Branch, orbit: Orbit, block: Block | None, typed: str, files: Sequence[Path], *, as_json: bool
) -> None:
    """Print the orbit, the special points and the ends of a branch on stdout, and the paths of the files."""
    if as_json:
        print_json(record(branch, orbit, block, files))
        return
    rows = [*asked_of(orbit.system, block), *_found(branch, orbit, block, typed)]
    print_table(str(branch), rows, files, warned(orbit_warnings(orbit.system, block)))


def _found(branch: Branch, orbit: Orbit, block: Block | None, typed: str) -> Iterator[Row]:
    """Yield the rows of the result."""
    yield "varied", typed, ""
    start = orbit.start
    yield "orbit followed", f"{orbit.stability} {orbit}", ""
    state = f"Θ = {start.angle:.6g}, Θ' = {start.velocity:.6g}"
    yield "its state at τ = 0", state, "" if block is None else state_in_si(start, block)
    for special in branch.special:
        yield special.kind, *_place(branch.name, special.parameter, block, digits=10)
    for name, value, reason in _ends(branch):
        text, physical = _place(branch.name, value, block)
        yield f"{name} end", f"{text}: {reason}", physical
    peak = float(np.nanmax(branch.points["peak"]))
    yield "largest |Θ|", f"{peak:.6g}", reach(peak, block)


def _place(name: str, value: float, block: Block | None, digits: int = 6) -> tuple[str, str]:
    """Return a value of the parameter, and the same in SI."""
    return f"{name.replace('_', ' ')} {value:.{digits}g}", in_si(name, value, block)


def _ends(branch: Branch) -> Iterator[tuple[str, float, str]]:
    """Yield name, parameter and reason of both ends."""
    values = branch.points["parameter"]
    yield "first", float(values[0]), branch.ends[0]
    yield "last", float(values[-1]), branch.ends[1]


def record(branch: Branch, orbit: Orbit, block: Block | None, files: Sequence[Path]) -> dict[str, Any]:
    """Return the branch as a JSON object: the orbit followed, special points and ends."""
    result: dict[str, Any] = {
        "parameter": branch.name,
        **question_of(orbit.system),
        "orbit": orbit_record(orbit),
        "points": len(branch),
        "stable_points": int(branch.points["stable"].sum()),
        "special": [_special(special, block) for special in branch.special],
        "ends": [
            {"reason": reason} | value_record(branch.name, value, block) for _, value, reason in _ends(branch)
        ],
        "peak": float(np.nanmax(branch.points["peak"])),
        "files": [str(path) for path in files],
    }
    if block is None:
        return result
    physical = physical_of(orbit.system, block) | {"peak_deg": float(block.degrees(result["peak"]))}
    return result | {"block": physical, "warnings": orbit_warnings(orbit.system, block)}


def _special(special: SpecialPoint, block: Block | None) -> dict[str, Any]:
    return (
        {"kind": special.kind}
        | value_record(special.name, special.parameter, block)
        | {"orbit": orbit_record(special.orbit)}
    )


def value_record(name: str, value: float, block: Block | None) -> dict[str, float]:
    """Return a value of a parameter by name as a JSON object, with a block also in SI."""
    if block is None or name not in PHYSICAL:
        return {name: value}
    return {name: value, PHYSICAL[name].key: float(PHYSICAL[name].turn(block, value))}
