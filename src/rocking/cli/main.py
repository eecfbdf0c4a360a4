"""The command `rocking` and how it ends: 0, 2 (your input), 1 (we failed), 130 (Ctrl-C); one line on stderr, no traceback."""

from __future__ import annotations

import os
import sys
from typing import Annotated

import typer

from rocking.cli.cite import cite
from rocking.cli.paper import paper
from rocking.cli.simulate import simulate

INTERRUPTED = 130

app = typer.Typer(pretty_exceptions_enable=False, add_completion=False, rich_markup_mode=None)
for command in (simulate, paper, cite):
    app.command()(command)


@app.callback(invoke_without_command=True)
def rocking(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Show the version and stop.")] = False,
) -> None:
    """Free-standing blocks on a shaking base: exact simulation and nonlinear dynamics."""
    if version:
        from rocking import __version__

        print(f"rocking {__version__}")
    elif context.invoked_subcommand is None:
        print(context.get_help())
        raise typer.Exit(2)


def main() -> None:
    """Run the command line and exit."""
    for stream in (sys.stdout, sys.stderr):
        # A terminal without Greek letters shows question marks.
        stream.reconfigure(errors="replace")  # type: ignore[union-attr]
    try:
        # Typer turns Ctrl-C into an exit code of its own, which it returns.
        code = app(prog_name="rocking", standalone_mode=False)
        sys.stdout.flush()
    except KeyboardInterrupt:
        code = INTERRUPTED
    except BrokenPipeError:
        # Nobody reads on; stdout goes nowhere, lest the interpreter complain when it closes it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = 1
    except typer.TyperException as error:
        say(error.format_message())
        code = 2
    except Exception as error:  # noqa: BLE001 (a traceback helps nobody at a prompt)
        say(f"failed, and should not have: {type(error).__name__}: {error}")
        code = 1
    if code == INTERRUPTED:
        say("interrupted")
    sys.exit(code)


def say(message: str) -> None:
    """One line on stderr."""
    print("rocking:", " ".join(message.split()), file=sys.stderr)


if __name__ == "__main__":
    main()
