"""`rocking orbit-diagram`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis
from rocking.cli.input import options as ask
from rocking.cli.option_names import START, SYSTEM

EXAMPLES = """\
rocking orbit-diagram --amplitude 7:10.9:1000 --period 1.721328 --restitution 0.8 --plot diagram.png
rocking orbit-diagram --height 2 --width 0.5 --acceleration 2:6 --frequency-hz 1.2 --sweep rest"""

Sweep = Annotated[
    str,
    typer.Option(
        "--sweep",
        metavar="WAY",
        help="up, down or both, each from where the last ended; or rest, each from its start.",
    ),
]
Transient = Annotated[int, ask.number_option("--transient", "Cycles left out at each.")]
Cycles = Annotated[int, ask.number_option("--cycles", "Cycles, and points, kept at each.")]
SectionPhase = Annotated[
    float | None,
    ask.number_option("--section-phase", "Phase of the base at which points are taken, rad; φ unless given."),
]
Plot = Annotated[Path | None, ask.file_option("--plot", "Points over the parameter (.png .svg .pdf).")]
Csv = Annotated[Path | None, ask.file_option("--csv", "A row a point, and a row where it overturned (.csv).")]


@ask.with_options(*SYSTEM, declare=axis.value_option, phase=0.0)
@ask.with_options(*START, angle=0.0, velocity=0.0)
def orbit_diagram(
    context: typer.Context,
    sweep: Sweep = "both",
    transient: Transient = 300,
    cycles: Cycles = 100,
    section_phase: SectionPhase = None,
    plot: Plot = None,
    csv: Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Vary one option and show which responses are left.

    It is given as START:STOP:COUNT; a transient is left out.
    """
    from rocking.cli.input import orbit_diagram_request
    from rocking.cli.output.files import check_files
    from rocking.cli.reports import orbit_diagram as report

    files = check_files({"plot": plot, "csv": csv, "netcdf": netcdf})
    study = orbit_diagram_request.study(context.params)
    diagram = orbit_diagram_request.compute(study, sweep, transient, cycles, section_phase)
    for name, path in files.items():
        report.WRITERS[name](diagram, study.block, path)
    report.show(diagram, study.block, study.typed, list(files.values()), as_json=json)
