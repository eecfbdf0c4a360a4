"""The commands, gathered."""

from __future__ import annotations

from typing import Annotated

import typer

from rocking.cli.basins import EXAMPLES as BASINS_EXAMPLES
from rocking.cli.basins import basins
from rocking.cli.cite import cite
from rocking.cli.classify import EXAMPLES as CLASSIFY_EXAMPLES
from rocking.cli.classify import classify
from rocking.cli.explore import explore
from rocking.cli.map import EXAMPLES as MAP_EXAMPLES
from rocking.cli.map import map_
from rocking.cli.modes import EXAMPLES as MODES_EXAMPLES
from rocking.cli.modes import modes
from rocking.cli.orbit_diagram import EXAMPLES as ORBIT_DIAGRAM_EXAMPLES
from rocking.cli.orbit_diagram import orbit_diagram
from rocking.cli.overturning import EXAMPLES as OVERTURNING_EXAMPLES
from rocking.cli.overturning import overturning
from rocking.cli.paper import EXAMPLES as PAPER_EXAMPLES
from rocking.cli.paper import paper
from rocking.cli.simulate import EXAMPLES, simulate

VERSION = typer.Option("--version", help="Show the version and stop.")

# Rich help would take longer to load than all the rest of `rocking --help`.
app = typer.Typer(
    pretty_exceptions_enable=False,
    add_completion=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command(epilog=EXAMPLES)(simulate)
app.command(epilog=CLASSIFY_EXAMPLES)(classify)
app.command(epilog=MODES_EXAMPLES)(modes)
app.command("map", epilog=MAP_EXAMPLES)(map_)
app.command(epilog=BASINS_EXAMPLES)(basins)
app.command(epilog=OVERTURNING_EXAMPLES)(overturning)
app.command(epilog=ORBIT_DIAGRAM_EXAMPLES)(orbit_diagram)
app.command()(explore)
app.command(epilog=PAPER_EXAMPLES)(paper)
app.command()(cite)


@app.callback(invoke_without_command=True)
def rocking(context: typer.Context, version: Annotated[bool, VERSION] = False) -> None:
    """Free-standing blocks on a shaking base: exact simulation and nonlinear dynamics."""
    if version:
        from rocking import __version__

        print(f"rocking {__version__}")
    elif context.invoked_subcommand is None:
        print(context.get_help())
        raise typer.Exit(2)
