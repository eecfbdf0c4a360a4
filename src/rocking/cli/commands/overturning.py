"""`rocking overturning`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis
from rocking.cli.input import options as ask
from rocking.cli.input.study_file import Study

EXAMPLES = """\
# The lowest overturning amplitude over the forcing period, plotted.
rocking overturning --period 0.4:3:50 --restitution 0.925 \\
    --plot overturning.png
# One period, one phase, a fine scan of the amplitude.
rocking overturning --period 1 --restitution 0.925 --amplitude 1:16:1501 \\
    --phases 1 --json
# A block of 2 m × 0.5 m, in SI units.
rocking overturning --height 2 --width 0.5 --frequency-hz 1:2:10 \\
    --csv overturning.csv"""

SHAKEN = (
    "period",
    "frequency",
    "height",
    "width",
    "frequency_hz",
    "period_s",
    "restitution",
    "critical_angle",
)
Amplitude = Annotated[
    Any,
    axis.axis_option(
        "--amplitude",
        "Amplitudes A of the base acceleration to scan, in units of g θcr. Default: 1:16:301.",
    ),
]
Acceleration = Annotated[
    Any,
    axis.axis_option(
        "--acceleration",
        "Amplitudes of the base acceleration to scan, m/s². Default: 1:16:301 times g θcr.",
    ),
]
AccelerationG = Annotated[
    Any, axis.axis_option("--acceleration-g", "Amplitudes to scan, in units of g; replaces --acceleration.")
]
Phases = Annotated[
    ask.Number,
    ask.number_option("--phases", "Number of initial forcing phases. Default: 16."),
]
MaxCycles = Annotated[
    ask.Number,
    ask.number_option("--max-cycles", "Maximum number of forcing cycles per run. Default: 1,000."),
]
Plot = Annotated[
    Path | None,
    ask.file_option(
        "--plot",
        "Plot the lowest amplitude and the fraction of phases that overturn (.png .svg .pdf).",
    ),
]

Csv = Annotated[
    Path | None,
    ask.file_option("--csv", "Write one row per forcing period, frequency or restitution (.csv)."),
]


@ask.with_options(*SHAKEN, declare=axis.value_option)
def overturning(
    context: typer.Context,
    amplitude: Amplitude = None,
    acceleration: Acceleration = None,
    acceleration_g: AccelerationG = None,
    phases: Phases = None,
    model: ask.Model = None,
    max_cycles: MaxCycles = None,
    max_period: ask.SurveyPeriod = None,
    study: Study = None,
    store: ask.Store = None,
    repair: ask.Repair = False,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.SurveyNetcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Find the lowest amplitude that overturns a block.

    The block is initially at rest. The minimum is taken over the initial phases of the forcing. AXIS is START:STOP:COUNT:
    COUNT evenly spaced values, both ends included. COUNT is optional. Default: 200.
    """
    from rocking.cli.input import overturning_request
    from rocking.cli.output import survey_run
    from rocking.cli.reports import overturning as report

    asked = overturning_request.question(context.params, study)
    files = survey_run.files_of(asked)
    found, block = overturning_request.compute(asked)
    with survey_run.complete(asked.get("store")):
        report.write(found, files, block)
    report.show(found, block, survey_run.written(asked, files), as_json=json)
