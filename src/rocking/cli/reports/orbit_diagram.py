"""Report and output files of an orbit diagram."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from rocking.cli.output import files
from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.reports.motion import asked_in_si, beyond, in_si, reach
from rocking.cli.reports.validity import warned, warnings
from rocking.model.block import PHYSICAL, Block

if TYPE_CHECKING:
    from rocking.orbits.orbit_diagram import OrbitDiagram


def show(
    diagram: OrbitDiagram, block: Block | None, typed: str, files: Sequence[Path], *, as_json: bool
) -> None:
    """Print a summary on stdout, and the paths of the files."""
    if as_json:
        print_json(record(diagram, block, files))
        return
    fixed = ", ".join(f"{name} {value:.6g}" for name, value in diagram.fixed.items())
    in_units = (in_si(name, value, block) for name, value in diagram.fixed.items())
    rows: list[Row] = [("varied", typed, ""), ("fixed", fixed, ", ".join(filter(None, in_units)))]
    if block is not None:
        rows += _in_si(diagram, block)
    for way, fell, peaks in zip(diagram.sweeps, diagram.overturned, diagram.peak, strict=True):
        known = peaks[~fell]
        if known.size:
            rows.append((f"largest |Θ|, {way}", f"{known.max():.6g}", reach(float(known.max()), block)))
    more = [*beyond(diagram.start.angle, block), *warned(_warnings(diagram, block))]
    print_table(str(diagram), rows, files, more)


def _in_si(diagram: OrbitDiagram, block: Block) -> Iterator[Row]:
    """Yield rows of the varied values, and of those at which the block overturned, in SI."""
    places = {diagram.parameter: diagram.values} | {
        f"overturned, {way}": diagram.values[fell]
        for way, fell in zip(diagram.sweeps, diagram.overturned, strict=True)
    }
    for name, values in places.items():
        ends = np.unique(values[[0, -1]]) if values.size else values
        shown = in_si(diagram.parameter, ends, block)
        if values.size and shown:
            yield name, " to ".join(f"{value:.6g}" for value in ends), shown


def _warnings(diagram: OrbitDiagram, block: Block | None) -> list[str]:
    asked = diagram.fixed | {diagram.parameter: diagram.values}
    return warnings(block, asked["amplitude"], asked["restitution"], full="critical_angle" in asked)


def record(diagram: OrbitDiagram, block: Block | None, files: Sequence[Path]) -> dict[str, Any]:
    """Return the result as a JSON object."""
    result: dict[str, Any] = {
        "parameter": diagram.parameter,
        "first": float(diagram.values[0]),
        "last": float(diagram.values[-1]),
        "count": len(diagram.values),
        **diagram.fixed,
        "start": attrs.asdict(diagram.start),
        "section_phase": diagram.section_phase,
        "transient": diagram.transient,
        "cycles": diagram.cycles,
        "sweeps": [
            {
                "way": way,
                "overturned": int(fell.sum()),
                "overturned_at": diagram.values[fell].tolist(),
                "peak": float(peaks[~fell].max()) if not fell.all() else None,
            }
            for way, fell, peaks in zip(diagram.sweeps, diagram.overturned, diagram.peak, strict=True)
        ],
        "files": [str(path) for path in files],
    }
    if block is None:
        return result
    for sweep in result["sweeps"]:
        if diagram.parameter in PHYSICAL:
            varied = PHYSICAL[diagram.parameter]
            sweep[f"overturned_at_{varied.key}"] = varied.turn(block, sweep["overturned_at"]).tolist()
        sweep["peak_deg"] = None if sweep["peak"] is None else float(block.degrees(sweep["peak"]))
    return result | {"block": asked_in_si(diagram.to_xarray(), block), "warnings": _warnings(diagram, block)}


def write_plot(diagram: OrbitDiagram, block: Block | None, path: Path) -> None:
    """Write the plot of the points."""
    from rocking import plot

    plot.save(plot.orbit_diagram(diagram, block=block), path)


def write_csv(diagram: OrbitDiagram, block: Block | None, path: Path) -> None:
    """Write one row per point, normalised and with a block in SI; a run that overturned has one row without numbers."""
    files.write_csv(_tables(diagram, block), path)


def _tables(diagram: OrbitDiagram, block: Block | None) -> Iterator[dict[str, Any]]:
    """Yield one table (columns by heading) per sweep and parameter value."""
    fixed = diagram.to_xarray().attrs
    for way, fell, points in zip(diagram.sweeps, diagram.overturned, diagram.points, strict=True):
        for value, gone, rows in zip(diagram.values, fell, points, strict=True):
            count = 1 if gone else len(rows)
            said = {
                "sweep": np.full(count, way),
                diagram.parameter: np.full(count, value),
                "cycle": np.array(["overturned"]) if gone else np.arange(count),
            }
            table = said | {"angle": rows[:count, 0], "velocity": rows[:count, 1]}
            table = files.columns(files.with_fixed(table, said, fixed), block)
            yield {name: np.array([""]) if _empty(column) else column for name, column in table.items()}


def _empty(column: np.ndarray) -> bool:
    """Return whether a column holds no numbers, because the block overturned."""
    return column.dtype.kind == "f" and bool(np.isnan(column).all())


def write_netcdf(diagram: OrbitDiagram, block: Block | None, path: Path) -> None:
    """Write the dataset of the diagram, with its values in SI if there is a block."""
    files.write_dataset(files.with_block(diagram.to_xarray(), block), path)


WRITERS: dict[str, Callable[[OrbitDiagram, Block | None, Path], None]] = {
    "plot": write_plot,
    "csv": write_csv,
    "netcdf": write_netcdf,
}
