"""`rocking paper`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def paper(
    figures: Annotated[
        list[str] | None, typer.Argument(help="Which, such as 2 13a; all unless given.")
    ] = None,
    output: Annotated[Path, typer.Option("--output", metavar="DIR", help="Where they go.")] = Path(
        "results/yim-lin-1991"
    ),
) -> None:
    """Reproduce the figures of Yim and Lin (1991)."""
    from rich.progress import Progress

    from rocking.papers.yim_lin_1991 import reproduce

    with Progress() as bar:
        ...
