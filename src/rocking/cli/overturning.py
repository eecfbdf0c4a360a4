"""`rocking overturning`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli import axes
from rocking.cli import options as ask
from rocking.cli.map import Repair, Store

# The control character keeps the lines that follow as they are.
EXAMPLES = """\b
rocking overturning --period 0.4:3:50 --restitution 0.925 --plot overturning.png
rocking overturning --period 1 --restitution 0.925 --amplitude 1:16:1501 --phases 1 --json"""

USUAL = "1:16:301"
Amplitude = Annotated[
    Any,
    typer.Option(
        "--amplitude",
        parser=axes.number_or_axis,
        metavar="AXIS",
        help="Amplitudes to scan: START:STOP:COUNT.",
    ),
]
Phases = Annotated[
    int,
    typer.Option("--phases", parser=ask.number, metavar="NUMBER", help="Phases at which the shaking begins."),
]
Plot = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE", help="The lowest amplitude, over the share of phases that overturn (.png .svg .pdf)."
    ),
]
Netcdf = Annotated[Path | None, typer.Option(metavar="FILE", help="All of it with its description (.nc).")]


def overturning(
    period: axes.Period = None,
    frequency: axes.Frequency = None,
    restitution: axes.Restitution = None,
    amplitude: Amplitude = USUAL,
    phases: Phases = 16,
    max_cycles: ask.MaxCycles = 1_000,
    max_period: ask.MaxPeriod = 64,
    store: Store = None,
    repair: Repair = False,
    plot: Plot = None,
    netcdf: Netcdf = None,
    json: ask.Json = False,
) -> None:
    """Find the lowest amplitude that overturns a block from rest, whatever the phase at which the shaking begins."""
    import sys

    from rocking.cli import surveys
    from rocking.survey import overturning_amplitude

    files = surveys.check_files({"plot": plot, "netcdf": netcdf})
    given = {"period": period, "frequency": frequency, "restitution": restitution, "amplitude": amplitude}
    surveys.require("restitution", restitution)
    with ask.your_input(surveys.ARGUMENTS):
        typed = {name: surveys.values(each) for name, each in given.items() if each is not None}
        found = overturning_amplitude(
            **typed,
            phases=phases,
            max_cycles=max_cycles,
            max_period=max_period,
            store=store,
            repair=repair,
            progress=sys.stderr.isatty(),
        )
    surveys.write(found, found.dataset, "overturning", files)
    surveys.show_overturning(found, [each for each in (store, *files.values()) if each], as_json=json)
