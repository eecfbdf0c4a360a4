"""`rocking overturning-set`."""

from __future__ import annotations

from typing import Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.input import record_source

EXAMPLES = """\
# Peak accelerations at which the record of the package overturns a block.
rocking overturning-set example --height 2 --width 0.5 --pga-g 0.1:2:400 \\
    --plot overturning-set.png --csv overturning-set.csv"""


@ask.with_options("height", "width", "restitution", "angle")
@record_source.with_levels()
@record_source.with_files("Plot the intervals of overturning levels, a row per record", "Write the switches")
def overturning_set(
    context: typer.Context,
    sources: record_source.Sources,
    inertia_ratio: record_source.InertiaRatio = None,
    polarity: record_source.Polarity = None,
    **shared: Any,
) -> None:
    """Find the levels at which records overturn a block.

    Overturning is not monotone: a stronger motion can spare a block that a weaker one overturns. Every interval wider than the
    distance of two levels is found. AXIS is START:STOP:COUNT: COUNT evenly spaced levels, both ends included. COUNT is optional.
    Default: 200.
    """
    from rocking.cli.input import overturning_set_request as request
    from rocking.cli.reports import overturning_set as report

    question = request.question(context.params, shared["study"])
    files = record_source.files_of(question.places, question.records)
    found = request.compute(question)
    report.write(found, files)
    report.show(found, question.doubts, list(files.values()), as_json=shared["json"])
