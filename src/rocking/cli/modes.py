"""`rocking modes`."""

from __future__ import annotations

import typer

from rocking.cli import options as ask

# The control character keeps the lines that follow as they are.
EXAMPLES = """\b
rocking modes --amplitude 6.5 --period 0.4 --restitution 0.925 -n 3 --plot modes.png
rocking modes --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2"""


def modes(
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
    n: ask.ModeCycles = 1,
    plot: ask.ModesPlot = None,
    json: ask.Json = False,
) -> None:
    """Give the symmetric (1, n) modes in closed form.

    With their speed, phase and stability, and whether they exist.
    """
    from rocking.cli import closed_forms, outputs

    outputs.check_picture(plot)
    system, _, block = ask.question({**ask.UNASKED, **context.params})
    with ask.your_input(ask.ARGUMENTS):
        answer = closed_forms.find(system, n)
    if plot is not None:
        outputs.write_modes(system, answer.n, block, plot)
    closed_forms.show(answer, block, plot, as_json=json)
