"""Printing of results on stdout: a title, aligned rows and the files written, or JSON."""

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
    """Return a console on stdout without automatic colours, markup or line breaks."""
    from rich.console import Console

    return Console(highlight=False, markup=False, emoji=False, soft_wrap=True)


def print_table(title: str, rows: Iterable[Row], files: Iterable[Path], more: Iterable[str] = ()) -> None:
    """Print a title, rows as columns, further lines, and the paths of the files written."""
    console = screen()
    console.print(title, style="bold")
    for line in aligned(list(rows)):
        console.print(line)
    for line in more:
        console.print(line, style="yellow" if line.startswith(WARNING) else None)
    for path in files:
        console.print(f"wrote {path}")


def print_json(record: dict[str, Any]) -> None:
    """Print a JSON object."""
    print(json.dumps(finite(record), indent=2, ensure_ascii=False, allow_nan=False))


def aligned(rows: Sequence[Row]) -> Iterator[str]:
    """Yield the rows as lines of a table; lines are never cut, so that numbers stay whole in a narrow terminal."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        yield "   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()


def finite(value: Any) -> Any:
    """Replace infinities and NaN by None, because JSON has no such numbers."""
    if isinstance(value, dict):
        return {name: finite(part) for name, part in value.items()}
    if isinstance(value, list):
        return [finite(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
