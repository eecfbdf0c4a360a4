"""`rocking paper`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli.option_names import computing

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
    from rocking.model.files import check_folder
    from rocking.model.text import counted

    name, *rest = figures if figures and figures[0] in PAPERS else (next(iter(PAPERS)), *(figures or ()))
    folder = Path("results") / name if output is None else output
    with computing({"figures": "FIGURE"}):
        check_folder("--output", folder)
        room = room_of(name)
        try:
            room.PAPER.known(rest)
        except ValueError as error:
            raise ValueError(f"{error} (the reports are {' and '.join(PAPERS)})") from error
    last: list[str] = []
    written = room.reproduce(folder, rest or None, progress=True, summary=last.append)
    if rest:
        for path in written:
            print(f"wrote {path}")
    else:
        print(f"wrote {counted(len(written), 'file')} into {folder}")
        last.append(f"open {folder / room.PAGE}")
    if last:
        print("; ".join(last))
