"""`rocking simulate`."""

from __future__ import annotations

from typing import Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.input.study_option import with_study
from rocking.cli.option_names import ARGUMENTS, START, SYSTEM, YourInput, computing

CYCLES = 200
EXAMPLES = """\
# Normalised input.
rocking simulate --amplitude 2 --period 1 --restitution 0.925 \\
    --plot motion.png
# A block of 2 m × 0.5 m, in SI units.
rocking simulate --height 2 --width 0.5 --acceleration 3 --frequency-hz 1.2
# A stout block, whose angle is not small.
rocking simulate --height 2 --width 1 --acceleration 6 --frequency-hz 1.2 \\
    --model full
# The same block under one pulse.
rocking simulate --pulse one-sine --height 2 --width 0.5 \\
    --acceleration-g 0.5 --frequency-hz 1"""


@with_study
@ask.with_options(*SYSTEM, *START, phase=0.0, angle=0.0, velocity=0.0)
def simulate(
    context: typer.Context,
    pulse: ask.PulseKind = None,
    cycles: ask.Cycles = None,
    model: ask.Model = None,
    plot: ask.Plot = None,
    csv: ask.Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Simulate one block and summarise its motion."""
    from rocking.cli.output import motion_files
    from rocking.cli.reports import motion as report

    if pulse is not None and cycles is not None:
        raise YourInput("--cycles belongs to harmonic motion: omit it with --pulse")
    count = None if pulse is not None else CYCLES if cycles is None else cycles
    files = motion_files.check(count or 0, plot=plot, csv=csv, netcdf=netcdf)
    system, start, block = ask.question(context.params)
    with computing(ARGUMENTS):
        motion = motion_files.run(system, start, count, tuple(files))
    for name, path in files.items():
        motion_files.WRITERS[name](motion, block, path)
    report.show(motion, block, list(files.values()), as_json=json)
