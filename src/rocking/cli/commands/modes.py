"""`rocking modes`."""

from __future__ import annotations

from typing import Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.input.study_option import with_study
from rocking.cli.option_names import ARGUMENTS, FORCED, your_input

EXAMPLES = """\
# The (1, 3) modes, plotted over the amplitude.
rocking modes --amplitude 6.5 --period 0.4 --restitution 0.925 -n 3 \\
    --plot modes.png
# The (1, 1) modes of a block of 2 m × 0.5 m, in SI units.
rocking modes --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2 \\
    --csv modes.csv"""


@with_study
@ask.with_options(*FORCED)
def modes(
    context: typer.Context,
    n: ask.ModeCycles = 1,
    plot: ask.ModesPlot = None,
    csv: ask.ModesCsv = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Compute the symmetric (1, n) modes in closed form.

    Prints their velocity and phase at impact, their stability and their admissibility.
    """
    from rocking.cli.output.files import check_files
    from rocking.cli.reports import modes as report

    files = check_files({"plot": plot, "csv": csv})
    system, _, block = ask.question(context.params)
    with your_input(ARGUMENTS | {"n must": "-n must"}):
        answer = report.find(system, n)
    report.write(answer, block, files)
    report.show(answer, block, list(files.values()), as_json=json)
