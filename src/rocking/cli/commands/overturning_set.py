"""`rocking overturning-set`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis, record_source
from rocking.cli.input import options as ask
from rocking.cli.input.study_file import Study

EXAMPLES = """\
# Peak accelerations at which the record of the package overturns a block.
rocking overturning-set example --height 2 --width 0.5 --pga-g 0.1:2:400 \\
    --plot overturning-set.png --csv overturning-set.csv"""


def _levels(name: str, what: str) -> Any:
    return axis.axis_option(name, f"Levels: {what}.")


Scale = Annotated[Any, _levels("--scale", "factor of each record")]
Pga = Annotated[Any, _levels("--pga", "peak ground acceleration, m/s²")]
PgaG = Annotated[Any, _levels("--pga-g", "peak ground acceleration, in units of g")]
Pgv = Annotated[Any, _levels("--pgv", "peak ground velocity, m/s")]
Pgd = Annotated[Any, _levels("--pgd", "peak ground displacement, m")]
Arias = Annotated[Any, _levels("--arias", "Arias intensity, m/s")]
PgaRatio = Annotated[Any, _levels("--pga-ratio", "peak ground acceleration over g tan θcr")]
PgvRatio = Annotated[Any, _levels("--pgv-ratio", "α times the peak ground velocity, over g tan θcr")]
Polarity = Annotated[
    ask.Number,
    ask.number_option("--polarity", "1, or -1 for the opposite direction of the records. Default: 1."),
]
Plot = Annotated[
    Path | None,
    ask.file_option("--plot", "Plot the intervals of overturning levels, a row per record (.png .svg .pdf)."),
]
Csv = Annotated[Path | None, ask.file_option("--csv", "Write the switches (.csv).")]


@ask.with_options("height", "width", "restitution", "angle")
def overturning_set(
    context: typer.Context,
    sources: record_source.Sources,
    inertia_ratio: record_source.InertiaRatio = None,
    scale: Scale = None,
    pga: Pga = None,
    pga_g: PgaG = None,
    pgv: Pgv = None,
    pgd: Pgd = None,
    arias: Arias = None,
    pga_ratio: PgaRatio = None,
    pgv_ratio: PgvRatio = None,
    polarity: Polarity = None,
    units: record_source.Units = None,
    step: record_source.Step = None,
    baseline: record_source.Baseline = None,
    study: Study = None,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.SurveyNetcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Find all levels at which records overturn a block.

    Overturning is not monotone: a stronger motion can spare a block that a weaker one overturns. Every interval wider than the
    distance of two levels is found. AXIS is START:STOP:COUNT: COUNT evenly spaced levels, both ends included. COUNT is optional.
    Default: 200.
    """
    from rocking.cli.input import overturning_set_request as request
    from rocking.cli.output.files import check_apart, check_files
    from rocking.cli.reports import overturning_set as report

    question = request.question(context.params, study)
    check_apart(question.places)
    files = check_files(question.places)
    record_source.check_not_read(files, sources, question.records)
    found = request.compute(question)
    report.write(found, files)
    report.show(found, question.doubts, list(files.values()), as_json=json)
