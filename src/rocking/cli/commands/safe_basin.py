"""`rocking safe-basin`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis
from rocking.cli.input import options as ask
from rocking.cli.input.study_file import Study
from rocking.cli.option_names import SYSTEM

EXAMPLES = """\
# The safe fraction over the amplitude, plotted with both thresholds.
rocking safe-basin --amplitude 2:16:29 --period 1 --restitution 0.8 \\
    --samples 2000 --plot safe.png
# Initial states near rest only.
rocking safe-basin --amplitude 2:16:29 --period 1 --restitution 0.8 \\
    --angle=-0.2:0.2 --velocity=-0.2:0.2 --samples 2000
# A block of 2 m × 0.5 m, in SI units.
rocking safe-basin --height 2 --width 0.5 --acceleration 2:10:20 \\
    --frequency-hz 1.2 --samples 2000 --csv safe.csv"""


def _range_option(name: str, text: str) -> Any:
    return typer.Option(name, parser=axis.only_range, metavar="RANGE", help=text)


Angle = Annotated[
    Any,
    _range_option(
        "--angle",
        "Range START:STOP of the initial angles Θ, in units of the critical angle θcr, not in degrees. Default: -1:1, or the "
        "range between narrower braces.",
    ),
]
Velocity = Annotated[
    Any,
    _range_option(
        "--velocity",
        "Range START:STOP of the initial angular velocities Θ', in units of α θcr. Default: -1:1.",
    ),
]
Samples = Annotated[
    ask.Number,
    ask.number_option(
        "--samples",
        "Number of random initial states in these ranges, the same ones at each amplitude. Default: 10,000.",
    ),
]
Seed = Annotated[ask.Number, ask.number_option("--seed", "Random seed. Default: 0.")]
Plot = Annotated[
    Path | None,
    ask.file_option(
        "--plot",
        "Plot the safe fraction over the amplitude, with its intervals and the thresholds (.png .svg .pdf).",
    ),
]
Csv = Annotated[Path | None, ask.file_option("--csv", "Write one row per amplitude (.csv).")]


@ask.with_options(*SYSTEM, declare=axis.amplitude_axis_option)
def safe_basin(
    context: typer.Context,
    angle: Angle = None,
    velocity: Velocity = None,
    samples: Samples = None,
    seed: Seed = None,
    model: ask.Model = None,
    max_cycles: ask.SurveyCycles = None,
    max_period: ask.SurveyPeriod = None,
    study: Study = None,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.SurveyNetcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Estimate the safe fraction of initial states.

    It is the fraction of the initial states that do not overturn, at each amplitude, with its 95 % confidence interval. Give the
    amplitude as an AXIS, START:STOP:COUNT: COUNT evenly spaced values, both ends included. COUNT is optional. Default: 200.
    """
    from rocking.cli.input import safe_basin_request as request
    from rocking.cli.output.files import check_files
    from rocking.cli.reports import safe_basin as report

    question = request.question(context.params, study)
    files = check_files(question.places)
    found = request.compute(question)
    report.write(found, question.block, files)
    report.show(found, question.block, list(files.values()), as_json=json)
