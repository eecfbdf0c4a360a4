"""An orbit diagram as a command runs it, shows it and writes it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import attrs

from rocking.cli.axes import Study
from rocking.cli.files import write_dataset
from rocking.cli.options import option
from rocking.cli.screen import print_json, print_table
from rocking.cli.summary import reach, size_of
from rocking.model import replacing

if TYPE_CHECKING:
    from rocking.model import Block
    from rocking.orbits import OrbitDiagram

ARGUMENTS = {
    name: name for name in ("sweep", "transient", "section_phase", "brace_angle", "brace_restitution")
}
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
    rows = [("varied", study.typed, ""), ("fixed", fixed, "")]
    for way, fell, peaks in zip(diagram.sweeps, diagram.overturned, diagram.peak, strict=True):
        known = peaks[~fell]
        if known.size:
            rows.append((f"largest |Θ|, {way}", f"{known.max():.6g}", reach(float(known.max()), study.block)))
    print_table(str(diagram), rows, files)


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
    return told if block is None else told | {"block": size_of(block)}


def write_plot(diagram: OrbitDiagram, block: Block | None, path: Path) -> None:
    """The points."""
    from rocking import plot

    plot.save(plot.orbit_diagram(diagram, block=block), path)


def write_csv(diagram: OrbitDiagram, block: Block | None, path: Path) -> None:
    """A row a point, normalised; where the block overturned one row without numbers."""
    import csv

    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(
            ["sweep", diagram.parameter, "cycle", "angle [theta_cr]", "velocity [alpha theta_cr]"]
        )
        for way, fell, points in zip(diagram.sweeps, diagram.overturned, diagram.points, strict=True):
            for value, gone, rows in zip(diagram.values.tolist(), fell, points, strict=True):
                if gone:
                    writer.writerow([way, value, "overturned", "", ""])
                else:
                    writer.writerows([way, value, k, *row] for k, row in enumerate(rows.tolist()))


def write_netcdf(diagram: OrbitDiagram, block: Block | None, path: Path) -> None:
    """The diagram's dataset."""
    write_dataset(diagram.to_xarray(), path)


WRITERS: dict[str, Callable[[OrbitDiagram, Block | None, Path], None]] = {
    "plot": write_plot,
    "csv": write_csv,
    "netcdf": write_netcdf,
}
