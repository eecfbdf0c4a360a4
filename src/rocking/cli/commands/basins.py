"""`rocking basins`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.input.axis import axis_option
from rocking.cli.input.study_file import Study
from rocking.cli.option_names import SYSTEM

EXAMPLES = """\
rocking basins --amplitude 5.5 --period 1 --restitution 0.8 --angle=-1:1:300 --velocity=-1:1:300 --plot basins.png
rocking basins --amplitude 5.5 --period 1 --restitution 0.8 --samples 10000 --json"""

Angle = Annotated[
    Any,
    axis_option("--angle", "Θ at the start, in θcr, not degrees: START:STOP:COUNT; -1:1:200 unless given."),
]
Velocity = Annotated[Any, axis_option("--velocity", "Θ' at the start, in θcr per τ, likewise.")]
Samples = Annotated[
    ask.Number,
    ask.number_option("--samples", "Random starts in those ranges, not a grid: their COUNT is not used."),
]
Seed = Annotated[ask.Number, ask.number_option("--seed", "Of all that is drawn at random; 0 unless given.")]
BoundaryRuns = Annotated[
    ask.Number,
    ask.number_option(
        "--boundary-runs", "Runs for the exponents of the boundaries; 100,000 unless given, 0: none."
    ),
]
Plot = Annotated[
    Path | None, ask.file_option("--plot", "The basins, a colour an attractor, with shares (.png .svg .pdf).")
]


@ask.with_options(*SYSTEM)
def basins(
    context: typer.Context,
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
    **shared: Any,
) -> None:
    """Tell which start leads where.

    And how sharp the boundaries between them are.
    """
    from rocking.cli.input import basins_request
    from rocking.cli.output import survey_run
    from rocking.cli.reports import basins as report

    asked = basins_request.question(context.params, study)
    files = survey_run.files_of(asked)
    found, block = basins_request.compute(asked)
    with survey_run.complete(asked.get("store")):
        survey_run.write(found, "basins", files, block)
    report.show(found, block, survey_run.written(asked, files), as_json=json)
