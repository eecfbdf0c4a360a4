"""`rocking orbit-diagram`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import axis
from rocking.cli.input import options as ask
from rocking.cli.input.study_option import with_study
from rocking.cli.option_names import START, SYSTEM

EXAMPLES = """\
# Vary the amplitude, upwards and downwards.
rocking orbit-diagram --amplitude 7:10.9:1000 --period 1.721328 \\
    --restitution 0.8 --plot diagram.png
# A block of 2 m × 0.5 m, in SI units, from rest at each acceleration.
rocking orbit-diagram --height 2 --width 0.5 --acceleration 2:6 \\
    --frequency-hz 1.2 --sweep rest"""

Sweep = Annotated[
    str,
    typer.Option(
        "--sweep",
        metavar="DIRECTION",
        help="Sweep direction: up, down or both (each run starts from the previous end state), or rest (each run starts from "
        "the initial state).",
    ),
]
Transient = Annotated[
    int, ask.number_option("--transient", "Transient cycles discarded at each parameter value.")
]
Cycles = Annotated[
    int, ask.number_option("--cycles", "Cycles recorded at each parameter value, one point per cycle.")
]
SectionPhase = Annotated[
    float | None,
    ask.number_option(
        "--section-phase", "Forcing phase of the Poincaré section, rad. Default: the value of --phase."
    ),
]
Plot = Annotated[
    Path | None, ask.file_option("--plot", "Plot the points over the parameter (.png .svg .pdf).")
]
Csv = Annotated[
    Path | None,
    ask.file_option("--csv", "Write one row per point, and one row per run that overturned (.csv)."),
]


@with_study
@ask.with_options(*SYSTEM, declare=axis.value_option, phase=0.0)
@ask.with_options(*START, angle=0.0, velocity=0.0)
def orbit_diagram(
    context: typer.Context,
    model: ask.Model = None,
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
    """Compute an orbit (bifurcation) diagram.

    Give exactly one option as an AXIS, START:STOP:COUNT: COUNT evenly spaced values, both ends included. COUNT is
    optional. Default: 200.
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
