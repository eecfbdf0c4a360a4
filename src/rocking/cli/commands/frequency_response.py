"""`rocking frequency-response`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis
from rocking.cli.input import options as ask
from rocking.cli.input.study_option import with_study
from rocking.cli.option_names import FORCED

EXAMPLES = """\
# The (1, 1) and (1, 3) orbits over the forcing period.
rocking frequency-response --amplitude 2 --period 0.5:2.5:100 \\
    --restitution 0.925 --plot response.png
# The (1, 1) orbits of a block of 2 m × 0.5 m, in SI units.
rocking frequency-response --height 2 --width 0.5 --acceleration 4 \\
    --frequency-hz 0.5:3:50 --modes 1 --csv response.csv"""

Modes = Annotated[
    list[int] | None,
    ask.number_option(
        "--modes",
        "Number n of forcing cycles per response period: 1, 3, 5, …; may be repeated. Default: 1 and 3.",
    ),
]
Plot = Annotated[
    Path | None,
    ask.file_option("--plot", "Plot the largest |Θ| over period or frequency (.png .svg .pdf)."),
]
Csv = Annotated[
    Path | None,
    ask.file_option(
        "--csv", "Write one row per point of the branches, and one per response from rest (.csv)."
    ),
]


@with_study
@ask.with_options(*(name for name in FORCED if name != "displacement"), declare=axis.forcing_axis_option)
def frequency_response(
    context: typer.Context,
    modes: Modes = None,
    step: ask.Step = 0.01,
    max_cycles: ask.MaxCycles = 10_000,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Compute the frequency response of (1, n) orbits.

    The branches of these orbits are followed, and the response from rest is classified at each value. Give the period or the
    frequency as an AXIS, START:STOP:COUNT: COUNT evenly spaced values, both ends included. COUNT is optional. Default: 200.
    """
    from rocking.cli.input import frequency_response_request as request
    from rocking.cli.output.files import check_files
    from rocking.cli.reports import frequency_response as report

    files = check_files({"plot": plot, "csv": csv, "netcdf": netcdf})
    study = request.study(context.params)
    found = request.compute(study, modes, step, max_cycles)
    report.write(found, study.block, files)
    report.show(found, study.block, study.typed, list(files.values()), as_json=json)
