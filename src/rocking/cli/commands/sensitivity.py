"""`rocking sensitivity`."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.input import record_source

EXAMPLES = """\
# The record of the package at 30 levels; name a folder or a table instead.
rocking sensitivity example --height 2 --width 0.5 --pga-g 0.5:1.5:30 \\
    --csv sensitivity.csv"""

Seed = Annotated[ask.Number, ask.number_option("--seed", "Random seed of the bootstrap. Default: 0.")]


@ask.with_options("height", "width", "restitution")
@record_source.with_levels()
@record_source.with_files(None, "Write one row per change")
def sensitivity(
    context: typer.Context,
    sources: record_source.Sources,
    inertia_ratio: record_source.InertiaRatio = None,
    seed: Seed = None,
    **shared: Any,
) -> None:
    """Count the verdicts that small changes reverse.

    A verdict is whether the block overturns. Every run is repeated with five changes: the amplitude ± 1 %, sampling half a step
    later, and the coefficient of restitution ± 0.02. All intervals are at 95 % and clustered by record. AXIS is
    START:STOP:COUNT: COUNT evenly spaced levels, both ends included. COUNT is optional. Default: 200.
    """
    from rocking.cli.input import sensitivity_request as request
    from rocking.cli.reports import sensitivity as report

    question = request.question(context.params, shared["study"])
    files = record_source.files_of(question.places, question.records)
    found = request.compute(question)
    report.write(found, files)
    report.show(found, question.doubts, list(files.values()), as_json=shared["json"])
