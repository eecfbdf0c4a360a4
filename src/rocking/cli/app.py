"""The commands, gathered."""

from __future__ import annotations

from typing import Annotated

import typer

from rocking.cli.cite import cite
from rocking.cli.paper import paper
from rocking.cli.simulate import EXAMPLES, simulate

VERSION = typer.Option("--version", help="Show the version and stop.")

# Rich help would take longer to load than all the rest of `rocking --help`.
app = typer.Typer(pretty_exceptions_enable=False, add_completion=False, rich_markup_mode=None)
app.command(epilog=EXAMPLES)(simulate)
for command in (paper, cite):
    app.command()(command)


@app.callback(invoke_without_command=True)
def rocking(context: typer.Context, version: Annotated[bool, VERSION] = False) -> None:
    """Free-standing blocks on a shaking base: exact simulation and nonlinear dynamics."""
    if version:
        from rocking import __version__

        print(f"rocking {__version__}")
    elif context.invoked_subcommand is None:
        print(context.get_help())
        raise typer.Exit(2)
