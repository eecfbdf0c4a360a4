"""`rocking continue`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis
from rocking.cli.input import options as ask
from rocking.cli.input.study_option import with_study
from rocking.cli.option_names import START, SYSTEM

EXAMPLES = """\
# The response from rest at an amplitude of 7, followed down to its fold.
rocking continue --amplitude 7:0.1 --period 1.721328 --restitution 0.8 \\
    --plot branch.png
# The response at an amplitude of 15, followed in both directions.
rocking continue --amplitude 10:30 --at 15 --period 1 --restitution 0.9
# An unstable orbit of period 3, from an approximate state at τ = 0.
rocking continue --amplitude 5:6.5 --at 5.5 --period 0.5 \\
    --restitution 0.925 --response-period 3 --angle 0.064 --velocity 0.054
# A block of 2 m × 0.5 m, in SI units.
rocking continue --height 2 --width 0.5 --acceleration 4:2 \\
    --frequency-hz 1.2 --csv branch.csv"""

At = Annotated[
    ask.Number,
    ask.number_option(
        "--at", "Value of the option with the range at which the orbit is found. Default: START of the range."
    ),
]
ResponsePeriod = Annotated[
    int | None,
    ask.number_option(
        "--response-period",
        "Find an orbit of this number of forcing cycles near the initial state, stable or unstable. Default: the orbit that "
        "the response from the initial state approaches.",
    ),
]
Plot = Annotated[
    Path | None, ask.file_option("--plot", "Plot the largest |Θ| over the parameter (.png .svg .pdf).")
]
Csv = Annotated[Path | None, ask.file_option("--csv", "Write one row per point of the branch (.csv).")]


@with_study
@ask.with_options(*SYSTEM, declare=axis.range_option, phase=0.0)
@ask.with_options(*START, angle=0.0, velocity=0.0)
def continue_orbit(
    context: typer.Context,
    model: ask.Model = None,
    at: At = None,
    response_period: ResponsePeriod = None,
    step: ask.Step = 0.01,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Follow a periodic orbit through a parameter.

    The branch is followed in both directions, through folds, to its ends within the range. Its special points are located.
    Give exactly one option as a RANGE, START:STOP.
    """
    from rocking.cli.input import continue_request as request
    from rocking.cli.output.files import check_files
    from rocking.cli.reports import branch as report

    files = check_files({"plot": plot, "csv": csv, "netcdf": netcdf})
    study = request.study(context.params)
    orbit, branch = request.compute(study, response_period, step)
    report.write(branch, orbit, study.block, files)
    report.show(branch, orbit, study.block, study.typed, list(files.values()), as_json=json)
