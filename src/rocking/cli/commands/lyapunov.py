"""`rocking lyapunov`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.input.study_option import with_study
from rocking.cli.option_names import ARGUMENTS, START, SYSTEM, computing, options

EXAMPLES = """\
# Normalised input.
rocking lyapunov --amplitude 10.103037 --period 1.721328 \\
    --restitution 0.8 --cycles 20000 --plot exponent.png
# A block of 2 m × 0.5 m, in SI units.
rocking lyapunov --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2 \\
    --csv exponents.csv"""

Cycles = Annotated[
    int, ask.number_option("--cycles", "Number of forcing cycles of the average, at least 32.")
]
Transient = Annotated[
    int | None,
    ask.number_option(
        "--transient", "Forcing cycles discarded before the average. Default: a tenth of --cycles."
    ),
]
Plot = Annotated[
    Path | None,
    ask.file_option("--plot", "Plot the running estimate of the largest exponent (.png .svg .pdf)."),
]

Csv = Annotated[
    Path | None,
    ask.file_option("--csv", "Write the running estimates of both exponents, with their errors (.csv)."),
]


@with_study
@ask.with_options(*SYSTEM, *START, phase=0.0, angle=0.0, velocity=0.0)
def lyapunov(
    context: typer.Context,
    model: ask.Model = None,
    cycles: Cycles = 10_000,
    transient: Transient = None,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Measure both Lyapunov exponents with their errors."""
    from rocking.cli.output.files import check_files
    from rocking.cli.reports import lyapunov as report
    from rocking.response.lyapunov import lyapunov as measure

    files = check_files({"plot": plot, "csv": csv, "netcdf": netcdf})
    system, start, block = ask.question(context.params)
    with computing(ARGUMENTS | options("transient")):
        spectrum = measure(system, start, cycles, transient)
    report.write(spectrum, block, files)
    report.show(spectrum, block, list(files.values()), as_json=json)
