"""The whole paper on one page: its figures, its claims with what came of them, and what lies beyond; and the same as a PDF."""

from __future__ import annotations

import base64
import inspect
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from pathlib import Path

from attrs import frozen
from PIL import Image

from rocking.model import VERSION, replacing
from rocking.papers.yim_lin_1991.claim import Chapter, Judged, Standing
from rocking.papers.yim_lin_1991.table_files import write_table

PAGE, TWIN = "index.html", "index.pdf"
DOTS_PER_INCH = 200


@frozen
class Picture:
    """A picture of the page, and what is said below it."""

    name: str
    title: str
    text: str
    file: Path

    @property
    def inches(self) -> float:
        """How wide it is on paper."""
        with Image.open(self.file.with_suffix(".png")) as image:
            return image.width / DOTS_PER_INCH

    @property
    def data(self) -> str:
        """The picture in the page itself."""
        kind = "svg+xml" if self.file.suffix == ".svg" else "png"
        return f"data:image/{kind};base64,{base64.b64encode(self.file.read_bytes()).decode()}"


@frozen
class Judgement:
    """A chapter with its claims judged."""

    title: str
    claims: Sequence[Judged]


def pictured(name: str, module: str, file: Path) -> Picture:
    """A figure with the caption that its module has for a docstring."""
    title, _, text = inspect.cleandoc(import_module(module).__doc__ or "").partition("\n\n")
    return Picture(name, title.replace("\n", " "), text, file)


def judged(chapters: Iterable[Chapter], said: Callable[[str], object]) -> list[Judgement]:
    """Every claim computed now; `said` is told each one's place before it is."""
    judgements = []
    for chapter in chapters:
        claims = []
        for claim in chapter:
            said(claim.place)
            claims.append(claim.judged())
        judgements.append(Judgement(chapter.title, claims))
    return judgements


def counted(judgements: Iterable[Judgement]) -> Mapping[Standing, int]:
    """How many claims stand how."""
    found = Counter(claim.standing for judgement in judgements for claim in judgement.claims)
    return {standing: found[standing] for standing in Standing}


def summed_up(judgements: Iterable[Judgement]) -> str:
    """How many claims stand how, in one sentence."""
    counts = counted(judgements)
    told = ", ".join(f"{standing} {counts[standing]}" for standing in Standing if counts[standing])
    return f"{sum(counts.values())} claims of the paper: {told}"


def write_claims(folder: Path, judgements: Iterable[Judgement]) -> list[Path]:
    """Writes the claims as a table of their own."""
    rows = [
        [
            judgement.title,
            claim.claim.place,
            claim.claim.says,
            claim.finding.figures,
            str(claim.standing),
            claim.because,
        ]
        for judgement in judgements
        for claim in judgement.claims
    ]
    return write_table(
        folder, "claims", ["part", "place", "the paper says", "computed", "verdict", "because"], rows
    )


def write(
    folder: Path, figures: Sequence[Picture], judgements: Sequence[Judgement], beyond: Sequence[Picture]
) -> list[Path]:
    """Writes the page and, where the library for it is there (extra ``report``), its twin in PDF."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("rocking.papers.yim_lin_1991", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    page = environment.get_template("report.html").render(
        figures=figures, judgements=judgements, beyond=beyond, counts=counted(judgements), version=VERSION
    )
    with replacing(folder / PAGE) as temporary:
        temporary.write_text(page, encoding="utf-8")
    return [folder / PAGE, *_print(folder / TWIN, page)]


def can_print() -> bool:
    """Whether WeasyPrint (extra ``report``) and the libraries it needs from the system are there."""
    try:
        import_module("weasyprint")
    except (ImportError, OSError):
        return False
    return True


def _print(path: Path, page: str) -> list[Path]:
    if not can_print():
        return []
    from weasyprint import HTML

    with replacing(path) as temporary:
        HTML(string=page).write_pdf(temporary)
    return [path]
