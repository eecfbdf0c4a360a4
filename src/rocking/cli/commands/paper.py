"""`rocking paper`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli.option_names import YourInput, as_typed, your_input

EXAMPLES = """\
# Figures 1 and 4 of Yim & Lin (1991) only.
rocking paper 1 4 --output figures
# Figure 2 of the report on pulses and earthquakes.
rocking paper pulses-and-earthquakes 2 --output pulses
# Names of the reports.
rocking paper --list"""

FIGURES = typer.Argument(
    metavar="FIGURE",
    help="Name of the report: yim-lin-1991 (default) or pulses-and-earthquakes. Then figures, tables or additional figures of it. "
    "For yim-lin-1991: 1 to 12, 13a, 13b, exponents, claims, chaos, cascade, crisis, threshold, coexistence, zoom, bifurcations. "
    "For pulses-and-earthquakes: 1 to 5, claims. Default: all of them, and an HTML report.",
)
OUTPUT = typer.Option(
    "--output",
    metavar="DIR",
    help="Folder in which the files are written. Default: results/yim-lin-1991. Default of another report: its own name in results.",
)
LIST = typer.Option("--list", help="Print the names of the reports and exit.")


def paper(
    figures: Annotated[list[str] | None, FIGURES] = None,
    output: Annotated[Path | None, OUTPUT] = None,
    listed: Annotated[bool, LIST] = False,
) -> None:
    """Reproduce figures and numbers of papers on rocking."""
    from rocking.papers import PAPERS, room_of

    if listed:
        for known, title in PAPERS.items():
            print(f"{known}  {title}")
        return
    name, *rest = figures if figures and figures[0] in PAPERS else (next(iter(PAPERS)), *(figures or ()))
    folder = Path("results") / name if output is None else output
    last: list[str] = []
    files = _written(name, folder, rest, last)
    for path in files:
        print(f"wrote {path}")
    if not rest:
        last.append(f"open {folder / room_of(name).PAGE}")
    if last:
        print("; ".join(last))


def _written(name: str, folder: Path, figures: list[str], last: list[str]) -> list[Path]:
    """Write figures of a report, all by default, with a progress bar; append the summary of the claims to `last`."""
    from rich.console import Console
    from rich.progress import Progress

    from rocking.model import check_folder
    from rocking.papers import room_of

    with your_input():
        check_folder("--output", folder)
    bar = Progress(console=Console(stderr=True))

    def advance(done: int, total: int, step: str) -> None:
        if not bar.tasks:
            bar.start()
            bar.add_task("", total=total)
        bar.update(bar.task_ids[0], completed=done, description=step)

    try:
        return room_of(name).reproduce(folder, figures or None, advance, last.append)
    except (ValueError, OSError) as error:
        if bar.tasks:
            raise  # drawing has begun: the error is not in the input
        raise YourInput(as_typed(str(error), {"figures": "FIGURE"})) from error
    finally:
        if bar.tasks:
            bar.stop()
