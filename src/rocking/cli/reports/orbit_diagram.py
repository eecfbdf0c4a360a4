"""An orbit diagram as a command runs it, shows it and writes it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from rocking.cli.input.axis import Study
from rocking.cli.option_names import option, options
from rocking.cli.output import files
from rocking.cli.output.console import Row, print_json, print_table
from rocking.cli.reports.motion import asked_in_si, beyond, in_si, reach
from rocking.cli.reports.validity import warned, warnings
from rocking.model import PHYSICAL

if TYPE_CHECKING:
    from rocking.model import Block
    from rocking.orbits import OrbitDiagram

ARGUMENTS = options("sweep", "transient", "section_phase", "brace_angle", "brace_restitution")
# Below about a second a bar would only flicker.
LONG = 2_000_000


def run(study: Study, sweep: str, transient: int, cycles: int, section_phase: float | None) -> OrbitDiagram:
    """The diagram, with a bar on stderr while a long one is made."""
    from rich.console import Console
    from rich.progress import Progress

    from rocking.orbits import orbit_diagram

    total = len(study.values) * (2 if sweep == "both" else 1)
    console = Console(stderr=True)
    short = not console.is_terminal or total * (transient + cycles) < LONG
    with Progress(console=console, transient=True, disable=short) as bar:
        task = bar.add_task(option(study.parameter), total=total)
        return orbit_diagram(
            study.system,
            study.parameter,
            study.values,
            study.start,
            sweep,
            transient,
            cycles,
            section_phase,
            progress=lambda done: bar.advance(task, done),
        )


def show(diagram: OrbitDiagram, study: Study, files: Sequence[Path], *, as_json: bool) -> None:
    """Print what was found on stdout, and where its files are."""
    if as_json:
        print_json(record(diagram, study.block, files))
        return
    fixed = ", ".join(f"{name} {value:.6g}" for name, value in diagram.fixed.items())
    in_units = (in_si(name, value, study.block) for name, value in diagram.fixed.items())
    rows: list[Row] = [("varied", study.typed, ""), ("fixed", fixed, ", ".join(filter(None, in_units)))]
    if study.block is not None:
        rows += _in_si(diagram, study.block)
    for way, fell, peaks in zip(diagram.sweeps, diagram.overturned, diagram.peak, strict=True):
        known = peaks[~fell]
        if known.size:
            rows.append((f"largest |Θ|, {way}", f"{known.max():.6g}", reach(float(known.max()), study.block)))
    more = [*beyond(diagram.start.angle, study.block), *warned(_warnings(diagram, study.block))]
    print_table(str(diagram), rows, files, more)


def _in_si(diagram: OrbitDiagram, block: Block) -> Iterator[Row]:
    """Rows that say in SI what the title says normalised: the values, and those at which the block overturned."""
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
    return warnings(block, asked["amplitude"], asked["restitution"])


def record(diagram: OrbitDiagram, block: Block | None, files: Sequence[Path]) -> dict[str, Any]:
    """The same for a program to read."""
    told: dict[str, Any] = {
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
        return told
    for sweep in told["sweeps"]:
        if diagram.parameter in PHYSICAL:
            varied = PHYSICAL[diagram.parameter]
            sweep[f"overturned_at_{varied.key}"] = varied.turn(block, sweep["overturned_at"]).tolist()
        sweep["peak_deg"] = None if sweep["peak"] is None else float(block.degrees(sweep["peak"]))
    return told | {
        "block": asked_in_si(diagram.to_xarray(), block),
        "warnings": _warnings(diagram, block),
    }


def write_plot(diagram: OrbitDiagram, block: Block | None, path: Path) -> None:
    """The points."""
    from rocking import plot

    plot.save(plot.orbit_diagram(diagram, block=block), path)


def write_csv(diagram: OrbitDiagram, block: Block | None, path: Path) -> None:
    """A row a point, normalised, then in SI if there is a block; where the block overturned one row without numbers."""
    files.write_csv(_tables(diagram, block), path)


def _tables(diagram: OrbitDiagram, block: Block | None) -> Iterator[dict[str, Any]]:
    """Columns by their heading, of one value after another."""
    for way, fell, points in zip(diagram.sweeps, diagram.overturned, diagram.points, strict=True):
        for value, gone, rows in zip(diagram.values, fell, points, strict=True):
            count = 1 if gone else len(rows)
            said = {
                "sweep": np.full(count, way),
                diagram.parameter: np.full(count, value),
                "cycle": np.array(["overturned"]) if gone else np.arange(count),
            }
            table = files.columns(said | {"angle": rows[:count, 0], "velocity": rows[:count, 1]}, block)
            yield {name: np.array([""]) if _empty(column) else column for name, column in table.items()}


def _empty(column: np.ndarray) -> bool:
    """Whether it holds no numbers, for there the block overturned."""
    return column.dtype.kind == "f" and bool(np.isnan(column).all())


def write_netcdf(diagram: OrbitDiagram, block: Block | None, path: Path) -> None:
    """The diagram's dataset, with its values in SI if there is a block."""
    files.write_dataset(files.with_block(diagram.to_xarray(), block), path)


WRITERS: dict[str, Callable[[OrbitDiagram, Block | None, Path], None]] = {
    "plot": write_plot,
    "csv": write_csv,
    "netcdf": write_netcdf,
}
