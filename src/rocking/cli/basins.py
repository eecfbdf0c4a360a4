"""`rocking basins`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli import options as ask
from rocking.cli.axes import number_or_axis
from rocking.cli.studies import Study

# The control character keeps the lines that follow as they are.
EXAMPLES = """\b
rocking basins --amplitude 5.5 --period 1 --restitution 0.8 --angle=-1:1:300 --velocity=-1:1:300 --plot basins.png
rocking basins --amplitude 5.5 --period 1 --restitution 0.8 --samples 10000 --json"""

Angle = Annotated[
    Any,
    typer.Option(
        "--angle",
        parser=number_or_axis,
        metavar="AXIS",
        help="Θ at the start, in θcr: START:STOP:COUNT; -1:1:200 unless given.",
    ),
]
Velocity = Annotated[
    Any,
    typer.Option(
        "--velocity", parser=number_or_axis, metavar="AXIS", help="Θ' at the start, in θcr per τ, likewise."
    ),
]
Samples = Annotated[
    ask.Number,
    typer.Option(
        "--samples", parser=ask.number, metavar="NUMBER", help="Random starts in those ranges, not a grid."
    ),
]
Seed = Annotated[
    ask.Number,
    typer.Option(
        "--seed", parser=ask.number, metavar="NUMBER", help="Of all that is drawn at random; 0 unless given."
    ),
]
BoundaryRuns = Annotated[
    ask.Number,
    typer.Option(
        "--boundary-runs",
        parser=ask.number,
        metavar="NUMBER",
        help="Runs for the exponents of the boundaries; 100,000 unless given, 0: none.",
    ),
]
Plot = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="The basins, a colour an attractor, with shares (.png .svg .pdf)."),
]


def basins(
    context: typer.Context,
    amplitude: ask.Amplitude = None,
    period: ask.Period = None,
    frequency: ask.Frequency = None,
    height: ask.Height = None,
    width: ask.Width = None,
    acceleration: ask.Acceleration = None,
    acceleration_g: ask.AccelerationG = None,
    displacement: ask.Displacement = None,
    frequency_hz: ask.FrequencyHz = None,
    period_s: ask.PeriodS = None,
    restitution: ask.Restitution = None,
    phase: ask.Phase = None,
    brace_angle: ask.BraceAngle = None,
    brace_restitution: ask.BraceRestitution = None,
    angle: Angle = None,
    velocity: Velocity = None,
    samples: Samples = None,
    seed: Seed = None,
    max_cycles: ask.SurveyCycles = None,
    max_period: ask.SurveyPeriod = None,
    boundary_runs: BoundaryRuns = None,
    study: Study = None,
    store: ask.Store = None,
    repair: ask.Repair = False,
    plot: Plot = None,
    netcdf: ask.SurveyNetcdf = None,
    json: ask.Json = False,
) -> None:
    """Tell which start leads where.

    And how sharp the boundaries between them are.
    """
    from rocking.cli import attractors, surveys

    asked = attractors.question(context.params, study)
    files = surveys.files_of(asked)
    found, block = attractors.compute(asked)
    surveys.write(found, "basins", files)
    attractors.show(found, block, surveys.written(asked, files), as_json=json)
