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
rocking map --amplitude 0:16:100 --period 0.2:3:100 --restitution 0.925 --plot map.png
rocking map --height 2 --width 0.5 --acceleration 1:8:50 --frequency-hz 0.5:3:50 --store block.zarr"""


Plot = Annotated[Path | None, ask.file_option("--plot", "The map in colours, with shares (.png .svg .pdf).")]
Tiles = Annotated[
    Path | None,
    typer.Option(
        "--tiles", metavar="DIR", help="Image tiles, and a page that pans and zooms them without a server."
    ),
]
Curves = Annotated[
    str | None,
    typer.Option(
        "--curves", metavar="NAMES", help="Theory over the picture: melnikov,symmetry-breaking-1, …."
    ),
]
Symbols = Annotated[
    str | None,
    typer.Option(
        "--symbols", metavar="SET", help="Marks for cells in it: kinds, or those of figure 10, 11 or 13b."
    ),
]
Csv = Annotated[Path | None, ask.file_option("--csv", "A row a point (.csv).")]


@ask.with_options(*SYSTEM, *START, declare=axis.value_option)
def map_(
    context: typer.Context,
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
    """Tell what the response is at every point of a grid.

    Two options are its axes, START:STOP:COUNT.
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
