"""`rocking map`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis
from rocking.cli.input import options as ask
from rocking.cli.input.study_file import Study
from rocking.cli.option_names import START, SYSTEM

EXAMPLES = """\
# Responses over amplitude and period, plotted.
rocking map --amplitude 0:16:100 --period 0.2:3:100 --restitution 0.925 \\
    --plot map.png
# A block of 2 m × 0.5 m, in SI units. Repeat the command to resume it.
rocking map --height 2 --width 0.5 --acceleration 1:8:50 \\
    --frequency-hz 0.5:3:50 --store block.zarr"""

Plot = Annotated[
    Path | None, ask.file_option("--plot", "Plot the map, with area fractions (.png .svg .pdf).")
]
Tiles = Annotated[
    Path | None,
    typer.Option(
        "--tiles",
        metavar="DIR",
        help="Write image tiles and a page that pans and zooms them without a server.",
    ),
]
Curves = Annotated[
    str | None,
    typer.Option(
        "--curves",
        metavar="NAMES",
        help="Theoretical curves to overlay, separated by commas: symmetry-breaking-1, symmetry-breaking-3, existence-1, "
        "existence-3, melnikov, heteroclinic.",
    ),
]
Symbols = Annotated[
    str | None,
    typer.Option(
        "--symbols",
        metavar="SET",
        help="Draw symbols instead of cells: kinds, or the symbols of figure 10, 11 or 13b of Yim & Lin (1991).",
    ),
]
Csv = Annotated[Path | None, ask.file_option("--csv", "Write one row per point (.csv).")]


@ask.with_options(*SYSTEM, *START, declare=axis.value_option)
def map_(
    context: typer.Context,
    model: ask.Model = None,
    max_cycles: ask.SurveyCycles = None,
    max_period: ask.SurveyPeriod = None,
    study: Study = None,
    store: ask.Store = None,
    repair: ask.Repair = False,
    plot: Plot = None,
    curves: Curves = None,
    symbols: Symbols = None,
    tiles: Tiles = None,
    netcdf: ask.SurveyNetcdf = None,
    csv: Csv = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Classify the response at each point of a grid.

    Give exactly two options as an AXIS, START:STOP:COUNT: COUNT evenly spaced values, both ends included. COUNT is
    optional. Default: 200.
    """
    from rocking.cli.input import map_request
    from rocking.cli.output import survey_run
    from rocking.cli.reports import map as report

    question = map_request.question(context.params, study)
    files = map_request.files_of(question)
    found = map_request.compute(question)
    with survey_run.complete(question.places.get("store")):
        for name, path in files.items():
            map_request.WRITERS[name](found, path, question)
    report.show(found, question.block, survey_run.written(question.places, files), as_json=json)
