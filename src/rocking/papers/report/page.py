"""Report on a paper as files: tables, and one HTML page and PDF with figures, claims and further results."""

from __future__ import annotations

import base64
import csv
import io
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from pathlib import Path

from attrs import frozen
from PIL import Image

from rocking.model.files import replacing
from rocking.model.package import VERSION
from rocking.papers.report.claim import Chapter, Finding, Standing, Verdict, typeset

PAGE, TWIN = "index.html", "index.pdf"
DOTS_PER_INCH = 200


@frozen
class Picture:
    """Figure of the report with its caption."""

    name: str
    title: str
    text: str
    file: Path

    @property
    def inches(self) -> float:
        """Width on paper, inches."""
        with Image.open(self.file.with_suffix(".png")) as image:
            return image.width / DOTS_PER_INCH

    @property
    def data(self) -> str:
        """Data URL of the figure."""
        kind = "svg+xml" if self.file.suffix == ".svg" else "png"
        return f"data:image/{kind};base64,{base64.b64encode(self.file.read_bytes()).decode()}"


@frozen
class Verdicts:
    """Verdicts on the claims of a chapter."""

    title: str
    claims: Sequence[Verdict]


def verdicts(chapters: Iterable[Chapter], findings: Iterable[Finding]) -> list[Verdicts]:
    """Return the verdicts on all claims, from the findings in the order of the claims."""
    following = iter(findings)
    return [
        Verdicts(chapter.title, [claim.verdict(next(following)) for claim in chapter]) for chapter in chapters
    ]


def counted(chapters: Iterable[Verdicts]) -> Mapping[Standing, int]:
    """Return the number of claims with each verdict."""
    numbers = Counter(claim.standing for chapter in chapters for claim in chapter.claims)
    return {standing: numbers[standing] for standing in Standing}


def summary_line(chapters: Iterable[Verdicts], of: str) -> str:
    """Return the number of claims with each verdict as one line of text."""
    counts = counted(chapters)
    listed = ", ".join(f"{standing} ({counts[standing]})" for standing in Standing if counts[standing])
    return f"{sum(counts.values())} claims of {of}: {listed}"


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


def write_claims(folder: Path, chapters: Iterable[Verdicts]) -> list[Path]:
    """Write the claims and their verdicts as a table."""
    rows = [
        [
            chapter.title,
            claim.claim.place,
            claim.claim.says,
            claim.finding.figures,
            str(claim.standing),
            claim.because,
        ]
        for chapter in chapters
        for claim in chapter.claims
    ]
    return write_table(
        folder, "claims", ["part", "place", "claim", "computed", "verdict", "explanation"], rows
    )


def write(
    folder: Path,
    title: str,
    lead: str,
    figures: Sequence[Picture],
    chapters: Sequence[Verdicts],
    beyond: Sequence[Picture],
) -> list[Path]:
    """Write the HTML page and, if the libraries of WeasyPrint are available, the same page as PDF."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("rocking.papers.report", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["subscripts"] = subscripts
    page = environment.get_template("page.html").render(
        title=title,
        lead=lead.format(version=VERSION),
        figures=figures,
        chapters=chapters,
        beyond=beyond,
        counts=counted(chapters),
    )
    with replacing(folder / PAGE) as temporary:
        temporary.write_text(page, encoding="utf-8")
    return [folder / PAGE, *_print(folder / TWIN, page)]


def subscripts(text: str) -> str:
    """Return text as HTML with the indices of its symbols as subscripts, such as A_M and θcr.

    Examples
    --------
    >>> print(subscripts("A_M < A* & f_r, θcr"))
    A<sub>M</sub> &lt; A* &amp; f<sub>r</sub>, θ<sub>cr</sub>
    """
    from markupsafe import Markup, escape

    html = re.sub(r"\b([Af])_([A-Za-z]+)", r"\1<sub>\2</sub>", str(escape(text)))
    return Markup(html.replace("θcr", "θ<sub>cr</sub>").replace("Θb", "Θ<sub>b</sub>"))


def can_print() -> bool:
    """Return whether the system libraries that WeasyPrint needs are available."""
    try:
        import_module("weasyprint")
    except OSError:
        return False
    return True


def _print(path: Path, page: str) -> list[Path]:
    if not can_print():
        return []
    from weasyprint import HTML

    with replacing(path) as temporary:
        HTML(string=page).write_pdf(temporary)
    return [path]
