"""`rocking map`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli import axes
from rocking.cli import options as ask
from rocking.cli.studies import Study

# The control character keeps the lines that follow as they are.
EXAMPLES = """\b
rocking map --amplitude 0:16:100 --period 0.2:3:100 --restitution 0.925 --plot map.png
rocking map --height 2 --width 0.5 --acceleration 1:8:50 --frequency-hz 0.5:3:50 --store map.zarr"""


def _quantity(name: str, text: str) -> Any:
    return typer.Option(name, parser=axes.number_or_axis, metavar="NUMBER|AXIS", help=text)


Number = float | None
Phase = Annotated[Number, _quantity("--phase", "φ of the base's acceleration, rad; 0 unless given.")]
Angle = Annotated[Number, _quantity("--angle", "Θ at the start, in θcr; 0 unless given.")]
Velocity = Annotated[Number, _quantity("--velocity", "Θ' at the start, in θcr per τ; 0 unless given.")]
MaxCycles = Annotated[
    Number,
    typer.Option(
        "--max-cycles",
        parser=ask.number,
        metavar="NUMBER",
        help="Cycles of the base to follow at most; 10,000 unless given.",
    ),
]
MaxPeriod = Annotated[
    Number,
    typer.Option(
        "--max-period",
        parser=ask.number,
        metavar="NUMBER",
        help="Longest period looked for, in cycles of the base; 64 unless given.",
    ),
]
Store = Annotated[
    Path | None,
    typer.Option(
        "--store", metavar="DIR", help="Zarr store, written while it runs; the same command goes on with it."
    ),
]
Repair = Annotated[
    bool, typer.Option("--repair", help="Compute tiles of the store again that are found damaged.")
]
Plot = Annotated[
    Path | None,
    typer.Option("--plot", metavar="FILE", help="The map in colours, with shares (.png .svg .pdf)."),
]
Tiles = Annotated[
    Path | None,
    typer.Option(
        "--tiles", metavar="DIR", help="Image tiles, and a page that pans and zooms them without a server."
    ),
]
Netcdf = Annotated[
    Path | None, typer.Option("--netcdf", metavar="FILE", help="The map with its description (.nc).")
]
Csv = Annotated[Path | None, typer.Option("--csv", metavar="FILE", help="A row a point (.csv).")]


def map_(
    context: typer.Context,
    amplitude: axes.Amplitude = None,
    period: axes.Period = None,
    frequency: axes.Frequency = None,
    height: ask.Height = None,
    width: ask.Width = None,
    acceleration: axes.Acceleration = None,
    acceleration_g: axes.AccelerationG = None,
    displacement: axes.Displacement = None,
    frequency_hz: axes.FrequencyHz = None,
    period_s: axes.PeriodS = None,
    restitution: axes.Restitution = None,
    phase: Phase = None,
    brace_angle: axes.BraceAngle = None,
    brace_restitution: axes.BraceRestitution = None,
    angle: Angle = None,
    velocity: Velocity = None,
    max_cycles: MaxCycles = None,
    max_period: MaxPeriod = None,
    study: Study = None,
    store: Store = None,
    repair: Repair = False,
    plot: Plot = None,
    tiles: Tiles = None,
    netcdf: Netcdf = None,
    csv: Csv = None,
    json: ask.Json = False,
) -> None:
    """Tell what the response is at every point of a grid: two options are axes, START:STOP:COUNT."""
    from rocking.cli import maps

    question = maps.question(context.params, study)
    files = maps.check_files(question)
    found = maps.compute(question)
    for name, path in files.items():
        maps.WRITERS[name](found, path, question.block)
    maps.show(found, question, list(files.values()), as_json=json)
