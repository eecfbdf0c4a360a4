"""`rocking paper`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rocking.cli.option_names import YourInput, your_input

EXAMPLES = """\
# Figures 1 and 4 only.
rocking paper 1 4 --output figures"""

FIGURES = typer.Argument(
    metavar="FIGURE",
    help="Figures of the paper (1 to 12, 13a, 13b), tables (exponents, claims) or additional figures (chaos, cascade, crisis, "
    "threshold, coexistence, zoom). Default: all of them, and an HTML report.",
)
OUTPUT = typer.Option("--output", metavar="DIR", help="Folder in which the files are written.")


def paper(
    figures: Annotated[list[str] | None, FIGURES] = None,
    output: Annotated[Path, OUTPUT] = Path("results/yim-lin-1991"),
) -> None:
    """Reproduce the figures and numbers of Yim & Lin (1991)."""
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
            raise  # drawing has begun: the error is not in the input
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
