"""`rocking simulate`."""

from __future__ import annotations

from typing import Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.option_names import ARGUMENTS, START, SYSTEM, your_input

EXAMPLES = """\
# Normalised input.
rocking simulate --amplitude 2 --period 1 --restitution 0.925 \\
    --plot motion.png
# A block of 2 m × 0.5 m, in SI units.
rocking simulate --height 2 --width 0.5 --acceleration 3 --frequency-hz 1.2"""


@ask.with_options(*SYSTEM, *START, phase=0.0, angle=0.0, velocity=0.0)
def simulate(
    context: typer.Context,
    cycles: ask.Cycles = 200,
    plot: ask.Plot = None,
    csv: ask.Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Simulate one block and summarise its motion."""
    from rocking.cli.output import motion_files
    from rocking.cli.reports import motion as report

    files = motion_files.check(cycles, plot=plot, csv=csv, netcdf=netcdf)
    system, start, block = ask.question(context.params)
    with your_input(ARGUMENTS):
        motion = motion_files.run(system, start, cycles, tuple(files))
    for name, path in files.items():
        motion_files.WRITERS[name](motion, block, path)
    report.show(motion, block, list(files.values()), as_json=json)
