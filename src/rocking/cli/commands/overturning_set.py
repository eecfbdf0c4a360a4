"""`rocking overturning-set`."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from rocking.cli.input import axis, record_source
from rocking.cli.input import options as ask

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


@ask.with_options("height", "width", "restitution", "angle")
@record_source.with_files("Plot the intervals of overturning levels, a row per record", "Write the switches")
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
    **shared: Any,
) -> None:
    """Find all levels at which records overturn a block.

    Overturning is not monotone: a stronger motion can spare a block that a weaker one overturns. Every interval wider than the
    distance of two levels is found. AXIS is START:STOP:COUNT: COUNT evenly spaced levels, both ends included. COUNT is optional.
    Default: 200.
    """
    from rocking.cli.input import overturning_set_request as request
    from rocking.cli.reports import overturning_set as report

    question = request.question(context.params, shared["study"])
    files = record_source.files_of(question.places, sources, question.records)
    found = request.compute(question)
    report.write(found, files)
    report.show(found, question.doubts, list(files.values()), as_json=shared["json"])
