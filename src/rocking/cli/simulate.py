"""`rocking simulate`."""

from __future__ import annotations

import typer

from rocking.cli import options as ask


def simulate(
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
    angle: ask.Angle = 0.0,
    velocity: ask.Velocity = 0.0,
    cycles: ask.Cycles = 200,
    plot: ask.Plot = None,
    csv: ask.Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
) -> None:
    r"""Run one block and tell what it did.

    \b
    rocking simulate --amplitude 2 --period 1 --restitution 0.925 --plot motion.png
    rocking simulate --height 2 --width 0.5 --acceleration 3 --frequency-hz 1.2
    """
    from rocking.cli import outputs, summary

    files = outputs.check(cycles, plot=plot, csv=csv, netcdf=netcdf)
    system, start, block = ask.question(context.params)
    keep = files or (block and cycles <= outputs.MOST_CYCLES)

    from rocking.motion import simulate as run

    with ask.your_input():
        motion = run(system, start, cycles=cycles, record="all" if keep else "none")
    for name, path in files.items():
        outputs.WRITERS[name](motion, block, path)
    summary.show(motion, block, list(files.values()), as_json=json)
