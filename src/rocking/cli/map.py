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
Curves = Annotated[
    str | None,
    typer.Option(
        "--curves", metavar="NAMES", help="Theory over the picture: melnikov,symmetry-breaking-1, …."
    ),
]
Symbols = Annotated[
    str | None,
    typer.Option(
        "--symbols", metavar="SET", help="Marks for cells in it: kinds, or those of figure 10, 11 or 13b."
    ),
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
    max_cycles: ask.SurveyCycles = None,
    max_period: ask.SurveyPeriod = None,
    study: Study = None,
    store: ask.Store = None,
    repair: ask.Repair = False,
    plot: Plot = None,
    curves: Curves = None,
    symbols: Symbols = None,
    tiles: Tiles = None,
    netcdf: ask.SurveyNetcdf = None,
    csv: Csv = None,
    json: ask.Json = False,
) -> None:
    """Tell what the response is at every point of a grid.

    Two options are its axes, START:STOP:COUNT.
    """
    from rocking.cli import map_summary, maps

    question = maps.question(context.params, study)
    files = maps.files_of(question)
    found = maps.compute(question)
    for name, path in files.items():
        maps.WRITERS[name](found, path, question)
    written = [path for path in (question.store, *files.values()) if path is not None]
    map_summary.show(found, question.block, written, as_json=json)
