"""`rocking fragility`."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from rocking.cli.input import axis, record_source
from rocking.cli.input import options as ask

EXAMPLES = """\
# The record of the package; name a folder or a table instead.
rocking fragility example --height 2 --width 0.5 --pga-g 0.1:1.5:15 \\
    --limit 0.5 --plot fragility.png
# The records as they are.
rocking fragility example --height 2 --width 0.5 --scale 1
# An uncertain block: 20 samples per record.
rocking fragility example --height 2 --width 0.5 --pga-g 0.1:1.5:15 \\
    --samples 20 --width-spread 0.1 --csv fragility.csv"""

Limit = Annotated[
    list[float] | None,
    ask.number_option(
        "--limit", "Limit of |Θ|, in units of θcr; may be repeated. Overturning always follows."
    ),
]
Samples = Annotated[
    ask.Number,
    ask.number_option("--samples", "Number of samples of an uncertain block per record. Default: 1."),
]
HeightSpread = Annotated[
    ask.Number, ask.number_option("--height-spread", "Standard deviation of ln H. Default: 0.")
]
WidthSpread = Annotated[
    ask.Number, ask.number_option("--width-spread", "Standard deviation of ln B. Default: 0.")
]
RestitutionSpread = Annotated[
    ask.Number,
    ask.number_option(
        "--restitution-spread", "Half the width of the uniform distribution of e about its value. Default: 0."
    ),
]
Replicates = Annotated[
    ask.Number, ask.number_option("--replicates", "Number of bootstrap replicates. Default: 1,000.")
]
Seed = Annotated[ask.Number, ask.number_option("--seed", "Random seed of samples and bootstrap. Default: 0.")]


@ask.with_options("height", "width", "restitution")
@record_source.with_levels(declare=axis.value_option)
@record_source.with_files(
    "Plot the probabilities with intervals and lognormal fits",
    "Write the probabilities and their intervals as a table",
)
def fragility(
    context: typer.Context,
    sources: record_source.Sources,
    limit: Limit = None,
    samples: Samples = None,
    height_spread: HeightSpread = None,
    width_spread: WidthSpread = None,
    restitution_spread: RestitutionSpread = None,
    replicates: Replicates = None,
    seed: Seed = None,
    **shared: Any,
) -> None:
    """Estimate how likely ground motions overturn a block.

    A curve is the probability of overturning, or of exceeding a limit of the angle, over the intensity of the ground motion.
    --scale 1 alone gives the probability under the records as they are.

    All intervals are at 95 % and clustered by record: runs of the same record are not independent. AXIS is START:STOP:COUNT:
    COUNT evenly spaced values, both ends included.
    """
    from rocking.cli.input import fragility_request as request
    from rocking.cli.reports import fragility as report

    question = request.question(context.params, shared["study"])
    files = record_source.files_of(question.places, question.records)
    found = request.compute(question)
    report.write(found, files)
    report.show(found, question.doubts, list(files.values()), as_json=shared["json"])
