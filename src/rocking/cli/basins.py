"""`rocking basins`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli import options as ask
from rocking.cli.axes import number_or_axis
from rocking.cli.map import Repair, Store

# The control character keeps the lines that follow as they are.
EXAMPLES = """\b
rocking basins --amplitude 5.5 --period 1 --restitution 0.8 --angle=-1:1:300 --velocity=-1:1:300 --plot basins.png
rocking basins --amplitude 5.5 --period 1 --restitution 0.8 --samples 10000 --json"""

USUAL = "-1:1:200"
Angle = Annotated[
    Any,
    typer.Option(
        "--angle", parser=number_or_axis, metavar="AXIS", help="Θ at the start, in θcr: START:STOP:COUNT."
    ),
]
Velocity = Annotated[
    Any,
    typer.Option(
        "--velocity", parser=number_or_axis, metavar="AXIS", help="Θ' at the start, in θcr per τ, likewise."
    ),
]
Samples = Annotated[
    ask.Number,
    typer.Option(
        "--samples", parser=ask.number, metavar="NUMBER", help="Random starts in those ranges, not a grid."
    ),
]
Seed = Annotated[
    int, typer.Option("--seed", parser=ask.number, metavar="NUMBER", help="Of all that is drawn at random.")
]
BoundaryRuns = Annotated[
    int,
    typer.Option(
        "--boundary-runs",
        parser=ask.number,
        metavar="NUMBER",
        help="Runs for the exponents of the boundaries; 0: none.",
    ),
]
Plot = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="The basins, a colour an attractor, with shares (.png .svg .pdf)."),
]
Netcdf = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Where each start leads, with its description (.nc).")
]


def basins(
    context: typer.Context,
    amplitude: ask.Amplitude = None,
    period: ask.Period = None,
    frequency: ask.Frequency = None,
    height: ask.Height = None,
    width: ask.Width = None,
    acceleration: ask.Acceleration = None,
    acceleration_g: ask.AccelerationG = None,
    displacement: ask.Displacement = None,
    frequency_hz: ask.FrequencyHz = None,
    period_s: ask.PeriodS = None,
    restitution: ask.Restitution = None,
    phase: ask.Phase = 0.0,
    brace_angle: ask.BraceAngle = None,
    brace_restitution: ask.BraceRestitution = None,
    angle: Angle = USUAL,
    velocity: Velocity = USUAL,
    samples: Samples = None,
    seed: Seed = 0,
    max_cycles: ask.MaxCycles = 10_000,
    max_period: ask.MaxPeriod = 64,
    boundary_runs: BoundaryRuns = 100_000,
    store: Store = None,
    repair: Repair = False,
    plot: Plot = None,
    netcdf: Netcdf = None,
    json: ask.Json = False,
) -> None:
    """Tell which start leads where, and how sharp the boundaries are."""
    import sys

    from rocking.cli import surveys
    from rocking.survey import basin_map

    files = surveys.check_files({"plot": plot, "netcdf": netcdf})
    system, _, block = ask.question(context.params | ask.AT_REST)
    with ask.your_input(surveys.ARGUMENTS):
        found = basin_map(
            system,
            angle=surveys.starts(angle, samples),
            velocity=surveys.starts(velocity, samples),
            samples=samples,  # type: ignore[arg-type]
            seed=seed,
            max_cycles=max_cycles,
            max_period=max_period,
            boundary_runs=boundary_runs,
            store=store,
            repair=repair,
            progress=sys.stderr.isatty(),
        )
    surveys.write(found, found.dataset, "basins", files)
    surveys.show_basins(found, block, [each for each in (store, *files.values()) if each], as_json=json)
