"""`rocking modes`."""

from __future__ import annotations

from typing import Any

import typer

from rocking.cli import options as ask

EXAMPLES = """\
rocking modes --amplitude 6.5 --period 0.4 --restitution 0.925 -n 3 --plot modes.png
rocking modes --height 2 --width 0.5 --acceleration 4 --frequency-hz 1.2"""


@ask.asks(*ask.FORCED)
def modes(
    context: typer.Context,
    n: ask.ModeCycles = 1,
    plot: ask.ModesPlot = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Give the symmetric (1, n) modes in closed form.

    With their speed, phase and stability, and whether they exist.
    """
    from rocking.cli import closed_forms, outputs

    outputs.check_picture(plot)
    system, _, block = ask.question(context.params)
    with ask.your_input(ask.ARGUMENTS):
        answer = closed_forms.find(system, n)
    if plot is not None:
        outputs.write_modes(system, answer.n, block, plot)
    closed_forms.show(answer, block, plot, as_json=json)
