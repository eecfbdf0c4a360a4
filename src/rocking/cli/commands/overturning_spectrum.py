"""`rocking overturning-spectrum`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis
from rocking.cli.input import options as ask
from rocking.cli.input.study_file import Study

EXAMPLES = """\
# Outcomes under one sine over amplitude and frequency, plotted.
rocking overturning-spectrum --pulse one-sine --amplitude 1:12:100 \\
    --frequency 0.5:8:100 --restitution 0.9 --plot pulses.png
# A block of 2 m × 0.5 m, in SI units.
rocking overturning-spectrum --pulse ricker --height 2 --width 0.5 \\
    --acceleration-g 0.2:2:50 --frequency-hz 0.3:3:50 --csv pulses.csv"""

Pulse = Annotated[
    str | None,
    typer.Option(
        "--pulse",
        metavar="KIND",
        help="Form of the pulse: rectangular, triangular, trapezoidal, half-sine, one-sine, one-cosine, ricker or "
        "antisymmetric-ricker. Its duration is one period of the frequency; for a half-sine, half of it.",
    ),
]
Amplitude = Annotated[
    Any, axis.axis_option("--amplitude", "Amplitudes A of the base acceleration, in units of g θcr.")
]
Frequency = Annotated[Any, axis.axis_option("--frequency", "Frequencies Ω of the pulse, in units of α.")]
Acceleration = Annotated[
    Any, axis.axis_option("--acceleration", "Amplitudes of the base acceleration, m/s².")
]
AccelerationG = Annotated[
    Any,
    axis.axis_option(
        "--acceleration-g", "Amplitudes of the base acceleration, in units of g; replaces --acceleration."
    ),
]
FrequencyHz = Annotated[Any, axis.axis_option("--frequency-hz", "Frequencies of the pulse, Hz.")]
Plot = Annotated[
    Path | None,
    ask.file_option("--plot", "Plot the outcomes, with the mode of overturning in colour (.png .svg .pdf)."),
]
Csv = Annotated[Path | None, ask.file_option("--csv", "Write one row per run (.csv).")]


@ask.with_options("height", "width", "restitution", "critical_angle", declare=axis.value_option)
def overturning_spectrum(
    context: typer.Context,
    pulse: Pulse = None,
    amplitude: Amplitude = None,
    frequency: Frequency = None,
    acceleration: Acceleration = None,
    acceleration_g: AccelerationG = None,
    frequency_hz: FrequencyHz = None,
    model: ask.Model = None,
    study: Study = None,
    store: ask.Store = None,
    repair: ask.Repair = False,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.SurveyNetcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Find the pulses that overturn a block.

    The block is initially at rest. The mode of overturning is the number of impacts since the block last rested. AXIS is
    START:STOP:COUNT: COUNT evenly spaced values, both ends included. COUNT is optional. Default: 200.
    """
    from rocking.cli.input import overturning_spectrum_request as request
    from rocking.cli.output import survey_run
    from rocking.cli.reports import overturning_spectrum as report

    question = request.question(context.params, study)
    files = survey_run.files_of(question.places)
    found = request.compute(question)
    with survey_run.complete(question.places.get("store")):
        report.write(found, files, question.block)
    report.show(found, question.block, survey_run.written(question.places, files), as_json=json)
