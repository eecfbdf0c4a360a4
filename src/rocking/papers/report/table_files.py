"""Tables as files."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from rocking.model.files import replacing
from rocking.papers.report.claim import typeset


def write_table(folder: Path, name: str, header: Sequence[str], rows: Sequence[Sequence[str]]) -> list[Path]:
    """Write a table as CSV, with plain numbers, and as Markdown, with typeset numbers."""
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows([header, *rows])
    lines = [
        header,
        ["---"] * len(header),
        *([typeset(text).replace("|", r"\|") for text in row] for row in rows),
    ]
    markdown = "".join(f"| {' | '.join(line)} |\n" for line in lines)
    written = []
    for suffix, text in ((".csv", stream.getvalue()), (".md", markdown)):
        path = folder / f"table-{name}{suffix}"
        with replacing(path) as temporary:
            temporary.write_text(text, encoding="utf-8")
        written.append(path)
    return written
