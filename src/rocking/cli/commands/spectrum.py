"""`rocking spectrum`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis, record_source
from rocking.cli.input import options as ask
from rocking.cli.input.study_file import Study

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
Plot = Annotated[
    Path | None, ask.file_option("--plot", "Plot the largest angle over the size (.png .svg .pdf).")
]
Csv = Annotated[Path | None, ask.file_option("--csv", "Write one row per run (.csv).")]


@ask.with_options("height", "width")
def spectrum(
    context: typer.Context,
    sources: record_source.Sources,
    size: Size = None,
    slenderness_deg: Slenderness = None,
    restitution: Restitution = None,
    inertia_ratio: record_source.InertiaRatio = None,
    scale: Scale = None,
    pga_g: PgaG = None,
    units: record_source.Units = None,
    step: record_source.Step = None,
    baseline: record_source.Baseline = None,
    study: Study = None,
    store: ask.Store = None,
    repair: ask.Repair = False,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.SurveyNetcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Follow blocks of many sizes under ground motions.

    AXIS is START:STOP:COUNT: COUNT evenly spaced values, both ends included. COUNT is optional. Default: 200.
    """
    from rocking.cli.input import spectrum_request
    from rocking.cli.output import survey_run
    from rocking.cli.reports import spectrum as report

    question = spectrum_request.question(context.params, study)
    files = spectrum_request.files_of(question)
    found = spectrum_request.compute(question)
    with survey_run.complete(question.places.get("store")):
        for name, path in files.items():
            spectrum_request.WRITERS[name](found, path)
    report.show(
        found, question.records, question.doubts, survey_run.written(question.places, files), as_json=json
    )
