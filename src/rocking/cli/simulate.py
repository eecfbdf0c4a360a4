"""`rocking simulate`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import typer

from rocking.cli import options as ask

if TYPE_CHECKING:
    from rocking.model import State, System
    from rocking.motion import Motion

EXAMPLES = """\
rocking simulate --amplitude 2 --period 1 --restitution 0.925 --plot motion.png
rocking simulate --height 2 --width 0.5 --acceleration 3 --frequency-hz 1.2"""


@ask.asks(*ask.SYSTEM, *ask.START, phase=0.0, angle=0.0, velocity=0.0)
def simulate(
    context: typer.Context,
    cycles: ask.Cycles = 200,
    plot: ask.Plot = None,
    csv: ask.Csv = None,
    netcdf: ask.Netcdf = None,
    json: ask.Json = False,
    **shared: Any,
) -> None:
    """Run one block and tell what it did."""
    from rocking.cli import outputs, summary

    files = outputs.check(cycles, plot=plot, csv=csv, netcdf=netcdf)
    system, start, block = ask.question(context.params)
    with ask.your_input(ask.ARGUMENTS):
        motion = run(system, start, cycles, tuple(files))
    for name, path in files.items():
        outputs.WRITERS[name](motion, block, path)
    summary.show(motion, block, list(files.values()), as_json=json)


def run(system: System, start: State, cycles: int, wanted: tuple[str, ...]) -> Motion:
    """The motion with all its events, so that what is told of it is the same whatever files are `wanted`.

    Without them where there are too many: too many cycles, or too many events if no file needs them.
    """
    from rocking.cli.outputs import MOST_CYCLES_KEPT
    from rocking.model import TooManyEvents
    from rocking.motion import simulate as march

    if not cycles <= MOST_CYCLES_KEPT:
        counted = march(system, start, cycles=cycles, record="none")
        if counted.cycles > MOST_CYCLES_KEPT:
            return counted
        cycles = counted.cycles  # it overturned long before
    try:
        return march(system, start, cycles=cycles)
    except TooManyEvents as error:
        if wanted:
            names = ", ".join(map(ask.option, wanted))
            raise ask.YourInput(
                f"too many events for {names}: run fewer cycles, or leave {names} out"
            ) from error
        return march(system, start, cycles=cycles, record="none")
