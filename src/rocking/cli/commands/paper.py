"""`rocking paper`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli.option_names import YourInput, your_input

EXAMPLES = "rocking paper 1 4 --output figures"

FIGURES = typer.Argument(
    metavar="FIGURE",
    help="Numbers in the paper, such as 2 13a; exponents or claims, tables; chaos, cascade, crisis, threshold, coexistence or zoom, "
    "beyond it. All, and one page of them, unless given.",
)
OUTPUT = typer.Option("--output", metavar="DIR", help="Folder for the files.")


def paper(
    figures: Annotated[list[str] | None, FIGURES] = None,
    output: Annotated[Path, OUTPUT] = Path("results/yim-lin-1991"),
) -> None:
    """Reproduce the figures and numbers of Yim and Lin (1991)."""
    from rich.console import Console
    from rich.progress import Progress

    from rocking.model import check_folder
    from rocking.papers import yim_lin_1991

    with your_input():
        check_folder("--output", output)
    last: list[str] = []
    bar = Progress(console=Console(stderr=True))

    def advance(done: int, total: int, name: str) -> None:
        if not bar.tasks:
            bar.start()
            bar.add_task("", total=total)
        bar.update(bar.task_ids[0], completed=done, description=name)

    try:
        files = yim_lin_1991.reproduce(output, figures or None, advance, last.append)
    except (ValueError, OSError) as error:
        if bar.tasks:
            raise  # it was drawing already: the fault is not in what was typed
        raise YourInput(str(error)) from error
    finally:
        if bar.tasks:
            bar.stop()
    for path in files:
        print(f"wrote {path}")
    if not figures:
        last.append(f"open {output / yim_lin_1991.PAGE}")
    if last:
        print("; ".join(last))
