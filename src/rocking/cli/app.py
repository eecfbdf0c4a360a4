"""The commands, gathered."""

from __future__ import annotations

from typing import Annotated

import typer

from rocking.cli.commands import (
    basins,
    cite,
    classify,
    explore,
    modes,
    orbit_diagram,
    overturning,
    paper,
    simulate,
)
from rocking.cli.commands import map as map_

VERSION = typer.Option("--version", help="Show the version and stop.")

# Rich help would take longer to load than all the rest of `rocking --help`.
app = typer.Typer(
    pretty_exceptions_enable=False,
    add_completion=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _shown(examples: str) -> str:
    """Examples under the help; the control character keeps lines as they are."""
    return f"\b\n{examples}"


app.command(epilog=_shown(simulate.EXAMPLES))(simulate.simulate)
app.command(epilog=_shown(classify.EXAMPLES))(classify.classify)
app.command(epilog=_shown(modes.EXAMPLES))(modes.modes)
app.command("map", epilog=_shown(map_.EXAMPLES))(map_.map_)
app.command(epilog=_shown(basins.EXAMPLES))(basins.basins)
app.command(epilog=_shown(overturning.EXAMPLES))(overturning.overturning)
app.command(epilog=_shown(orbit_diagram.EXAMPLES))(orbit_diagram.orbit_diagram)
app.command()(explore.explore)
app.command(epilog=_shown(paper.EXAMPLES))(paper.paper)
app.command()(cite.cite)


@app.callback(invoke_without_command=True)
def rocking(context: typer.Context, version: Annotated[bool, VERSION] = False) -> None:
    """Free-standing blocks on a shaking base: exact simulation and nonlinear dynamics."""
    if version:
        from rocking import __version__

        print(f"rocking {__version__}")
    elif context.invoked_subcommand is None:
        print(context.get_help())
        raise typer.Exit(2)
