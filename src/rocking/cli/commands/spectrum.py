"""`rocking spectrum`."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from rocking.cli.input import axis, record_source
from rocking.cli.input import options as ask

EXAMPLES = """\
# Blocks of 100 sizes and a slenderness of 10° under a record scaled to 0.5 g.
rocking spectrum example --size 0.5:5:100 --slenderness-deg 10 \\
    --pga-g 0.5 --plot spectrum.png
# The shape of a cabinet of 2 m × 0.5 m, at many sizes and two intensities.
rocking spectrum example --height 2 --width 0.5 --size 0.5:5:50 \\
    --pga-g 0.6:1.2:2 --csv spectrum.csv"""

Size = Annotated[
    Any,
    axis.value_option(
        "--size",
        "Distance R from a corner to the centre of mass, m: half the diagonal. Default: that of --height and --width.",
    ),
]
Slenderness = Annotated[
    Any,
    axis.value_option(
        "--slenderness-deg",
        "Critical angle θcr, degrees: the arc tangent of width over height. Default: that of --height and --width.",
    ),
]
Restitution = Annotated[
    Any,
    axis.value_option(
        "--restitution", "Coefficient of restitution e. Default: Housner's value for each slenderness."
    ),
]
Scale = Annotated[Any, axis.value_option("--scale", "Factor of the records. Default: 1.")]
PgaG = Annotated[
    Any,
    axis.value_option("--pga-g", "Peak to which each record is scaled, in units of g; replaces --scale."),
]


@ask.with_options("height", "width")
@record_source.with_files("Plot the largest angle over the size", "Write one row per run", store=True)
def spectrum(
    context: typer.Context,
    sources: record_source.Sources,
    size: Size = None,
    slenderness_deg: Slenderness = None,
    restitution: Restitution = None,
    inertia_ratio: record_source.InertiaRatio = None,
    scale: Scale = None,
    pga_g: PgaG = None,
    **shared: Any,
) -> None:
    """Follow blocks of many sizes under ground motions.

    AXIS is START:STOP:COUNT: COUNT evenly spaced values, both ends included. COUNT is optional. Default: 200.
    """
    from rocking.cli.input import spectrum_request
    from rocking.cli.output import survey_run
    from rocking.cli.reports import spectrum as report

    question = spectrum_request.question(context.params, shared["study"])
    files = record_source.files_of(question.places, question.records)
    found = spectrum_request.compute(question)
    with survey_run.complete(question.places.get("store")):
        report.write(found, files)
    written = survey_run.written(question.places, files)
    report.show(found, question.records, question.doubts, written, as_json=shared["json"])
