"""`rocking classify`."""

from __future__ import annotations

from typing import Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.input.study_option import with_study
from rocking.cli.option_names import ARGUMENTS, START, SYSTEM, computing

EXAMPLES = """\
# Normalised input.
rocking classify --amplitude 6.5 --period 0.4 --restitution 0.925 \\
    --plot verdict.png
# The same, proved.
rocking classify --amplitude 6.5 --period 0.4 --restitution 0.925 --prove
# A block of 2 m × 0.5 m, in SI units.
rocking classify --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2"""


@with_study
@ask.with_options(*SYSTEM, *START, phase=0.0, angle=0.0, velocity=0.0)
def classify(
    context: typer.Context,
    model: ask.Model = None,
    max_cycles: ask.MaxCycles = 100_000,
    max_period: ask.MaxPeriod = 64,
    prove: ask.Prove = False,
    plot: ask.VerdictPlot = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Classify the response and report the evidence."""
    from rocking.cli.output import motion_files
    from rocking.cli.reports import classify as report
    from rocking.response.classify import classify as judge

    motion_files.check_picture(plot)
    system, start, block = ask.question(context.params)
    with computing(ARGUMENTS):
        verdict = judge(system, start, max_cycles, max_period, prove)
    if plot is not None:
        motion_files.write_verdict(verdict, block, plot)
    report.show(verdict, block, plot, as_json=json)
