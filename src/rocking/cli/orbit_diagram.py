"""`rocking orbit-diagram`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli import axes
from rocking.cli import options as ask

# The control character keeps the lines that follow as they are.
EXAMPLES = """\b
rocking orbit-diagram --amplitude 7:10.9:1000 --period 1.721328 --restitution 0.8 --plot diagram.png
rocking orbit-diagram --height 2 --width 0.5 --acceleration 2:6 --frequency-hz 1.2 --sweep rest"""

Sweep = Annotated[
    str,
    typer.Option(
        "--sweep", metavar="WAY", help="up, down or both, each from where the last ended; or each from rest."
    ),
]
Transient = Annotated[
    int, typer.Option("--transient", parser=ask.number, metavar="NUMBER", help="Cycles left out at each.")
]
Cycles = Annotated[
    int,
    typer.Option("--cycles", parser=ask.number, metavar="NUMBER", help="Cycles, and points, kept at each."),
]
SectionPhase = Annotated[
    float | None,
    typer.Option(
        "--section-phase",
        parser=ask.number,
        metavar="NUMBER",
        help="Phase of the base at which points are taken, rad; φ unless given.",
    ),
]
Plot = Annotated[
    Path | None, typer.Option("--plot", metavar="FILE", help="Points over the parameter (.png .svg .pdf).")
]
Csv = Annotated[
    Path | None, typer.Option("--csv", metavar="FILE", help="A row a point, and a row where it overturned.")
]


def orbit_diagram(
    context: typer.Context,
    amplitude: axes.Amplitude = None,
    period: axes.Period = None,
    frequency: axes.Frequency = None,
    height: ask.Height = None,
    width: ask.Width = None,
    acceleration: axes.Acceleration = None,
    acceleration_g: axes.AccelerationG = None,
    displacement: axes.Displacement = None,
    frequency_hz: axes.FrequencyHz = None,
    period_s: axes.PeriodS = None,
    restitution: axes.Restitution = None,
    phase: axes.Phase = 0.0,
    brace_angle: axes.BraceAngle = None,
    brace_restitution: axes.BraceRestitution = None,
    angle: ask.Angle = 0.0,
    velocity: ask.Velocity = 0.0,
    sweep: Sweep = "both",
    transient: Transient = 300,
    cycles: Cycles = 100,
    section_phase: SectionPhase = None,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
) -> None:
    """Vary one option and show which responses are left.

    It is given as START:STOP:COUNT; a transient is left out.
    """
    from rocking.cli import diagrams
    from rocking.cli.files import check_files

    files = check_files({"plot": plot, "csv": csv, "netcdf": netcdf})
    study = axes.study(context.params)
    with ask.your_input(ask.ARGUMENTS | diagrams.ARGUMENTS):
        diagram = diagrams.run(study, sweep, transient, cycles, section_phase)
    for name, path in files.items():
        diagrams.WRITERS[name](diagram, study.block, path)
    diagrams.show(diagram, study, list(files.values()), as_json=json)
