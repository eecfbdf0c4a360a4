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
# A grid of 300 × 300 initial states, plotted.
rocking basins --amplitude 5.5 --period 1 --restitution 0.8 \\
    --angle=-1:1:300 --velocity=-1:1:300 --plot basins.png
# 10,000 random initial states.
rocking basins --amplitude 5.5 --period 1 --restitution 0.8 \\
    --samples 10000 --csv basins.csv"""

Angle = Annotated[
    Any,
    axis_option(
        "--angle",
        "Initial angles Θ, in units of the critical angle θcr, not in degrees. Default: -1:1:200, or the range between narrower braces.",
    ),
]
Velocity = Annotated[
    Any, axis_option("--velocity", "Initial angular velocities Θ', in units of α θcr. Default: -1:1:200.")
]
Samples = Annotated[
    ask.Number,
    ask.number_option(
        "--samples", "Number of random initial states in these ranges; replaces the grid. COUNT is ignored."
    ),
]
Seed = Annotated[ask.Number, ask.number_option("--seed", "Random seed. Default: 0.")]
BoundaryRuns = Annotated[
    ask.Number,
    ask.number_option(
        "--boundary-runs",
        "Number of runs used for the uncertainty exponents; 0 disables them. Default: 100,000.",
    ),
]
BoundaryWidth = Annotated[
    ask.Number,
    ask.number_option(
        "--boundary-width",
        "Largest width of the intervals of these exponents; runs are added until they are narrower. Default: no further runs.",
    ),
]
Plot = Annotated[
    Path | None,
    ask.file_option(
        "--plot", "Plot the basins, one colour per attractor, with their area fractions (.png .svg .pdf)."
    ),
]

Csv = Annotated[Path | None, ask.file_option("--csv", "Write one row per initial state (.csv).")]


@ask.with_options(*SYSTEM)
def basins(
    context: typer.Context,
    angle: Angle = None,
    velocity: Velocity = None,
    samples: Samples = None,
    seed: Seed = None,
    model: ask.Model = None,
    max_cycles: ask.SurveyCycles = None,
    max_period: ask.SurveyPeriod = None,
    boundary_runs: BoundaryRuns = None,
    boundary_width: BoundaryWidth = None,
    study: Study = None,
    store: ask.Store = None,
    repair: ask.Repair = False,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.SurveyNetcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Compute basins of attraction.

    The initial states form a grid over --angle and --velocity. The uncertainty exponents of the boundaries between the
    basins are also estimated. AXIS is START:STOP:COUNT: COUNT evenly spaced values, both ends included. COUNT is optional.
    Default: 200.
    """
    from rocking.cli.input import basins_request
    from rocking.cli.output import survey_run
    from rocking.cli.reports import basins as report

    asked = basins_request.question(context.params, study)
    files = survey_run.files_of(asked)
    found, block = basins_request.compute(asked)
    with survey_run.complete(asked.get("store")):
        report.write(found, files, block)
    report.show(found, block, survey_run.written(asked, files), as_json=json)
