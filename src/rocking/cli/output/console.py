"""How findings are shown on stdout: a title with aligned rows and the files written, or JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

Row = tuple[str, ...]
WARNING = "warning: "


def screen() -> Console:
    """Stdout, on which nothing is coloured by what it says, and no line is cut."""
    from rich.console import Console

    return Console(highlight=False, markup=False, emoji=False, soft_wrap=True)


def print_table(title: str, rows: Iterable[Row], files: Iterable[Path], more: Iterable[str] = ()) -> None:
    """Print a title, rows as columns, more lines below them, and where files are."""
    console = screen()
    console.print(title, style="bold")
    for line in aligned(list(rows)):
        console.print(line)
    for line in more:
        console.print(line, style="yellow" if line.startswith(WARNING) else None)
    for path in files:
        console.print(f"wrote {path}")


def print_json(told: dict[str, Any]) -> None:
    """Print what is told for a program."""
    print(json.dumps(finite(told), indent=2, ensure_ascii=False, allow_nan=False))


def aligned(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as lines of a table, as long as they need be: no terminal is so narrow that a number may be cut."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        yield "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()


def finite(value: Any) -> Any:
    """The same with null for what is infinite, for which JSON has no number."""
    if isinstance(value, dict):
        return {name: finite(part) for name, part in value.items()}
    if isinstance(value, list):
        return [finite(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
