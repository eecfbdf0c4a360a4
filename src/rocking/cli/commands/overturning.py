"""`rocking overturning`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis
from rocking.cli.input import options as ask
from rocking.cli.input.study_file import Study

EXAMPLES = """\
rocking overturning --period 0.4:3:50 --restitution 0.925 --plot overturning.png
rocking overturning --period 1 --restitution 0.925 --amplitude 1:16:1501 --phases 1 --json
rocking overturning --height 2 --width 0.5 --frequency-hz 1:2:10"""

SHAKEN = ("period", "frequency", "height", "width", "frequency_hz", "period_s", "restitution")
Amplitude = Annotated[
    Any,
    axis.axis_option(
        "--amplitude", "Normalised: amplitudes to scan, START:STOP:COUNT; 1:16:301 unless given."
    ),
]
Acceleration = Annotated[
    Any,
    axis.axis_option("--acceleration", "SI: accelerations to scan, m/s²; 1:16:301 times g θcr unless given."),
]
AccelerationG = Annotated[Any, axis.axis_option("--acceleration-g", "SI: the same in units of g.")]
Phases = Annotated[
    ask.Number, ask.number_option("--phases", "Phases at which the shaking begins; 16 unless given.")
]
MaxCycles = Annotated[
    ask.Number, ask.number_option("--max-cycles", "Cycles of the base to follow at most; 1,000 unless given.")
]
Plot = Annotated[
    Path | None,
    ask.file_option(
        "--plot", "The lowest amplitude, over the share of phases that overturn (.png .svg .pdf)."
    ),
]


@ask.with_options(*SHAKEN, declare=axis.value_option)
def overturning(
    context: typer.Context,
    amplitude: Amplitude = None,
    acceleration: Acceleration = None,
    acceleration_g: AccelerationG = None,
    phases: Phases = None,
    max_cycles: MaxCycles = None,
    max_period: ask.SurveyPeriod = None,
    study: Study = None,
    store: ask.Store = None,
    repair: ask.Repair = False,
    plot: Plot = None,
    netcdf: ask.SurveyNetcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Find the lowest amplitude that overturns a block from rest.

    It is the lowest over the phases at which the shaking may begin.
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
