"""Report on a paper as files: tables, an HTML page for each section and one of contents, and all of it as one PDF."""

from __future__ import annotations

import base64
import csv
import io
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path

from attrs import frozen
from PIL import Image

from rocking.model.files import replacing
from rocking.model.package import VERSION
from rocking.papers.report.claim import Chapter, Finding, Standing, Verdict, typeset

PAGE, TWIN = "index.html", "index.pdf"
DOTS_PER_INCH = 200
PREDICATES = {
    Standing.CONFIRMED: ("is confirmed as it stands", "are confirmed as they stand"),
    Standing.QUALIFIED: ("is confirmed with a qualification", "are confirmed with a qualification"),
    Standing.MISPRINT: ("contains a misprint", "contain a misprint"),
    Standing.ERROR: ("is an error in the paper", "are errors in the paper"),
    Standing.NOT_CONFIRMED: ("is not confirmed", "are not confirmed"),
    Standing.UNTESTED: ("is not judged", "are not judged"),
}
"""What the first page says of one claim and of several claims with a verdict."""


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
class Section:
    """Section of the report, with figures or with the verdicts on the claims of a chapter.

    Attributes
    ----------
    name : str
        Name of its page, without suffix.
    title : str
        Heading.
    pictures : sequence of Picture
        Figures.
    claims : sequence of Verdict
        Verdicts on claims.
    """

    name: str
    title: str
    pictures: Sequence[Picture] = ()
    claims: Sequence[Verdict] = ()

    @property
    def counts(self) -> Mapping[Standing, int]:
        """Number of claims with each verdict."""
        return counted([self])


def verdicts(chapters: Iterable[Chapter], findings: Iterable[Finding]) -> list[Section]:
    """Return a section for each chapter with the verdicts on its claims, from the findings in the order of the claims."""
    following = iter(findings)
    return [
        Section(
            f"claims-{slug(chapter.title)}",
            chapter.title,
            claims=[claim.verdict(next(following)) for claim in chapter],
        )
        for chapter in chapters
    ]


def slug(text: str) -> str:
    """Return a text as part of an address.

    Examples
    --------
    >>> slug("Makris & Konstantinidis (2003)")
    'makris-konstantinidis-2003'
    """
    return "-".join(re.findall(r"[a-z0-9]+", text.lower()))


def counted(sections: Iterable[Section]) -> Mapping[Standing, int]:
    """Return the number of claims with each verdict, without the verdicts that no claim has."""
    numbers = Counter(claim.standing for section in sections for claim in section.claims)
    return {standing: numbers[standing] for standing in Standing if numbers[standing]}


def listed(counts: Mapping[Standing, int]) -> str:
    """Return the number of claims with each verdict as text."""
    return ", ".join(f"{standing} ({count})" for standing, count in counts.items())


def summary_line(sections: Iterable[Section], of: str) -> str:
    """Return the number of claims with each verdict as one line of text."""
    counts = counted(sections)
    return f"{sum(counts.values())} claims of {of}: {listed(counts)}"


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
        written.append(_write_text(path, text))
    return written


def write_claims(folder: Path, chapters: Iterable[Section]) -> list[Path]:
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


def findings(counts: Mapping[Standing, int]) -> list[str]:
    """Return how many claims have each verdict, each as a sentence without its full stop.

    Examples
    --------
    >>> findings({Standing.CONFIRMED: 61, Standing.ERROR: 1})
    ['61 are confirmed as they stand', '1 is an error in the paper']
    """
    return [f"{count} {PREDICATES[standing][count != 1]}" for standing, count in counts.items()]


def write(folder: Path, title: str, lead: str, sections: Sequence[Section]) -> list[Path]:
    """Write the report as pages and, if the libraries of WeasyPrint are available, as one PDF.

    Each section is a page. Another page lists the claims by verdict. The first page has the main findings and the contents. It is
    written last, so that all that it links to exists.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("rocking.papers.report", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(subscripts=subscripts, listed=listed)
    counts = counted(sections)
    rows = [(section, verdict) for section in sections for verdict in section.claims]
    judged = {standing: [row for row in rows if row[1].standing is standing] for standing in counts}
    sections = [*sections, Section("verdicts", "Claims by verdict")]
    page = partial(
        environment.get_template("page.html").render,
        title=title,
        lead=lead.format(version=VERSION),
        sections=sections,
        counts=counts,
        findings=findings(counts),
        judged=judged,
        main=[row for same in judged.values() for row in same if row[1].claim.main],
        twin=TWIN if can_print() else None,
    )
    written = [
        _write_text(folder / f"{section.name}.html", page(section=section, whole=False))
        for section in sections
    ]
    if can_print():
        written.append(_print(folder / TWIN, page(section=None, whole=True)))
    return [*written, _write_text(folder / PAGE, page(section=None, whole=False))]


def _write_text(path: Path, text: str) -> Path:
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return path


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


def _print(path: Path, page: str) -> Path:
    from weasyprint import HTML

    with replacing(path) as temporary:
        HTML(string=page).write_pdf(temporary)
    return path
