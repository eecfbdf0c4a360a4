"""`rocking classify`."""

from __future__ import annotations

import typer

from rocking.cli import options as ask

# The control character keeps the lines that follow as they are.
EXAMPLES = """\b
rocking classify --amplitude 6.5 --period 0.4 --restitution 0.925 --plot verdict.png
rocking classify --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2"""


def classify(
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
    max_cycles: ask.MaxCycles = 100_000,
    max_period: ask.MaxPeriod = 64,
    plot: ask.VerdictPlot = None,
    json: ask.Json = False,
) -> None:
    """Tell what a response is, and how that is known."""
    from rocking.cli import findings, outputs
    from rocking.response import classify as judge

    outputs.check_picture(plot)
    system, start, block = ask.question(context.params)
    with ask.your_input(ask.ARGUMENTS):
        verdict = judge(system, start, max_cycles, max_period)
    if plot is not None:
        outputs.write_verdict(verdict, block, plot)
    findings.show(verdict, block, plot, as_json=json)
