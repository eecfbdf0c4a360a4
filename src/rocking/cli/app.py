"""Command-line application: all commands of `rocking`."""

from __future__ import annotations

from typing import Annotated

import typer

from rocking.cli.commands import (
    basins,
    cite,
    classify,
    continue_orbit,
    explore,
    fragility,
    frequency_response,
    lyapunov,
    modes,
    orbit_diagram,
    orbits,
    overturning,
    overturning_set,
    overturning_spectrum,
    paper,
    record,
    safe_basin,
    sensitivity,
    simulate,
    spectrum,
)
from rocking.cli.commands import map as map_
from rocking.cli.study_command import StudyCommand

VERSION = typer.Option("--version", help="Show the version and exit.")

# Help in plain text: Rich takes longer to load than the rest of `rocking --help`.
app = typer.Typer(
    pretty_exceptions_enable=False,
    add_completion=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 120},
)


for name, command, examples in (
    ("simulate", simulate.simulate, simulate.EXAMPLES),
    ("record", record.record, record.EXAMPLES),
    ("spectrum", spectrum.spectrum, spectrum.EXAMPLES),
    ("classify", classify.classify, classify.EXAMPLES),
    ("lyapunov", lyapunov.lyapunov, lyapunov.EXAMPLES),
    ("modes", modes.modes, modes.EXAMPLES),
    ("map", map_.map_, map_.EXAMPLES),
    ("basins", basins.basins, basins.EXAMPLES),
    ("safe-basin", safe_basin.safe_basin, safe_basin.EXAMPLES),
    ("overturning", overturning.overturning, overturning.EXAMPLES),
    ("overturning-set", overturning_set.overturning_set, overturning_set.EXAMPLES),
    ("overturning-spectrum", overturning_spectrum.overturning_spectrum, overturning_spectrum.EXAMPLES),
    ("fragility", fragility.fragility, fragility.EXAMPLES),
    ("sensitivity", sensitivity.sensitivity, sensitivity.EXAMPLES),
    ("orbits", orbits.orbits, orbits.EXAMPLES),
    ("continue", continue_orbit.continue_orbit, continue_orbit.EXAMPLES),
    ("frequency-response", frequency_response.frequency_response, frequency_response.EXAMPLES),
    ("orbit-diagram", orbit_diagram.orbit_diagram, orbit_diagram.EXAMPLES),
    ("explore", explore.explore, None),
    ("paper", paper.paper, paper.EXAMPLES),
    ("cite", cite.cite, None),
):
    # The control character keeps the line breaks of the examples below the options.
    app.command(name, cls=StudyCommand, epilog=examples and f"\b\nExamples:\n{examples}")(command)


@app.callback(invoke_without_command=True)
def rocking(context: typer.Context, version: Annotated[bool, VERSION] = False) -> None:
    """Simulate and analyse free-standing blocks that rock on a moving base.

    Run rocking COMMAND --help for the options and examples of a command.
    """
    if version:
        from rocking import __version__

        print(f"rocking {__version__}")
    elif context.invoked_subcommand is None:
        print(context.get_help())
        raise typer.Exit(2)
