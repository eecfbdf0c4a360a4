"""`rocking record`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rocking.cli.input import options as ask
from rocking.cli.input import record_request, record_source
from rocking.cli.input.study_option import with_study
from rocking.cli.option_names import START, computing

EXAMPLES = """\
# The record that comes with the package.
rocking record example --height 2 --width 0.5 --plot record.png
# The same, scaled to 1.3 g: the block overturns.
rocking record example --height 2 --width 0.5 --pga-g 1.3 \\
    --animate fall.gif --csv fall.csv"""

File = Annotated[
    Path,
    typer.Argument(
        metavar="FILE",
        parser=record_request.record_path,
        help="Record file; its format is recognised by the content. `example` is the record that comes with the package.",
    ),
]
Scale = Annotated[
    ask.Number, ask.number_option("--scale", "Factor of the record; a negative one reverses it. Default: 1.")
]
PgaG = Annotated[
    ask.Number,
    ask.number_option("--pga-g", "Peak to which the record is scaled, in units of g; replaces --scale."),
]
Plot = Annotated[
    Path | None,
    ask.file_option(
        "--plot", "Plot the time history, the base acceleration and the phase portrait (.png .svg .pdf)."
    ),
]
Animate = Annotated[
    Path | None,
    ask.file_option("--animate", "Write an animation of the block on its moving base (.gif .mp4)."),
]


@with_study
@ask.with_options(
    "height", "width", "restitution", "brace_angle", "brace_restitution", *START, angle=0.0, velocity=0.0
)
def record(
    context: typer.Context,
    file: File,
    inertia_ratio: record_source.InertiaRatio = None,
    scale: Scale = None,
    pga_g: PgaG = None,
    channel: record_source.Channel = 1,
    units: record_source.Units = None,
    step: record_source.Step = None,
    baseline: record_source.Baseline = None,
    model: ask.Model = None,
    plot: Plot = None,
    animate: Animate = None,
    csv: ask.Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Simulate a block under a recorded ground motion.

    The run ends when the block is at rest permanently, or when overturning is certain. Without losses, at the base or at braces,
    it ends with the record. The block, the record and the report are in SI units, the initial state is in units of θcr and α θcr.
    """
    from rocking.cli.output import motion_files
    from rocking.cli.reports import record as report

    files = motion_files.check_of_record(plot=plot, animate=animate, csv=csv, netcdf=netcdf)
    block, braces, start = record_request.block_and_start(context.params)
    ground, doubts = record_request.ground_motion(context.params)
    with computing(record_request.ARGUMENTS):
        motion = motion_files.run(
            block.system(ground, braces=braces, model=model or "slender"), start, None, tuple(files)
        )
    for name, path in files.items():
        if name == "plot":
            motion_files.write_plot(motion, block, path, report.heading(ground))
        else:
            motion_files.WRITERS[name](motion, block, path)
    report.show(motion, block, ground, doubts, list(files.values()), as_json=json)
