"""Figures, tables and claims of a paper as files, and a report on all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from pathlib import Path

import matplotlib.style
from attrs import frozen

import rocking as rk
from rocking.model import check_folder, require_extra
from rocking.papers.report import page
from rocking.papers.report.claim import Chapter

CLAIMS = "claims"
"""Name of the table of claims, which is written with the verdicts."""


@frozen
class Paper:
    """Contents of a report.

    Attributes
    ----------
    title, lead : str
        Title and first paragraph of the page; `{version}` in the paragraph is replaced.
    source : str
        Source of the claims, such as "the paper".
    figures, tables, beyond : dict
        Modules of the figures, of the tables and of the additional figures, by name. A figure module has `draw`, a table module
        `write`; the table "claims" needs none.
    pixels : sequence of str
        Figures with many points, which the page shows as PNG.
    chapters : callable
        Function that returns the claims.
    """

    title: str
    lead: str
    source: str
    figures: Mapping[str, str]
    tables: Mapping[str, str]
    beyond: Mapping[str, str]
    pixels: Sequence[str]
    chapters: Callable[[], Sequence[Chapter]]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of figures, tables and additional figures, in the order of the report."""
        return (*self.figures, *self.tables, *self.beyond)

    def stem(self, name: str) -> str:
        """Return the name of the files of a figure, without suffix."""
        return f"figure-{name:>02}" if name in self.figures else f"beyond-{name}"

    def picture(self, name: str, folder: Path) -> page.Picture:
        """Return a figure as the page shows it."""
        file = folder / f"{self.stem(name)}{'.png' if name in self.pixels else '.svg'}"
        return page.pictured(self.stem(name), (dict(self.figures) | dict(self.beyond))[name], file)


def write(
    paper: Paper,
    folder: str | Path,
    figures: Iterable[str | int] | None = None,
    progress: Callable[[int, int, str], object] | None = None,
    summary: Callable[[str], object] | None = None,
) -> list[Path]:
    """Write figures and tables of a paper, by default all of them and the report; return the paths.

    The report needs the extra ``report``: `ImportError` without it.
    """
    if figures is None:
        require_extra("report")
    wanted = _known(paper, paper.names if figures is None else figures)
    folder = check_folder("folder", folder)
    folder.mkdir(parents=True, exist_ok=True)
    steps = Steps(paper, wanted, whole=figures is None, said=progress)
    written: list[Path] = []
    judgements: list[page.Judgement] = []
    for name in wanted:
        if name == CLAIMS:
            judgements = page.judged(paper.chapters(), steps.next)
            written += page.write_claims(folder, judgements)
            if summary is not None:
                summary(page.summed_up(judgements, paper.source))
            continue
        steps.next(f"figure {name}" if name in paper.figures else name)
        if name in paper.tables:
            written += import_module(paper.tables[name]).write(folder)
        else:
            written += _draw(paper, name, folder)
    if figures is None:
        steps.next("page")
        shown = [[paper.picture(name, folder) for name in names] for names in (paper.figures, paper.beyond)]
        written += page.write(folder, paper.title, paper.lead, shown[0], judgements, shown[1])
    steps.end()
    return written


class Steps:
    """Progress report."""

    def __init__(
        self, paper: Paper, wanted: list[str], whole: bool, said: Callable[[int, int, str], object] | None
    ) -> None:
        claims = sum(map(len, paper.chapters())) if CLAIMS in wanted else 1
        self.done, self.total, self.name, self.said = -1, len(wanted) - 1 + claims + whole, "", said
        if not wanted:
            self.total = 0

    def next(self, name: str) -> None:
        """Report the start of the next step."""
        self.done, self.name = self.done + 1, name
        if self.said is not None:
            self.said(self.done, self.total, name)

    def end(self) -> None:
        """Report the end of the last step."""
        if self.said is not None:
            self.said(self.total, self.total, self.name)


def _draw(paper: Paper, name: str, folder: Path) -> list[Path]:
    # The bytes must not depend on the user's matplotlib settings.
    with matplotlib.style.context("default"):
        figure = import_module((dict(paper.figures) | dict(paper.beyond))[name]).draw()
        return [rk.plot.save(figure, folder / f"{paper.stem(name)}{suffix}") for suffix in (".png", ".svg")]


def _known(paper: Paper, figures: Iterable[str | int]) -> list[str]:
    names = [str(figure) for figure in figures]
    for name in names:
        if name not in paper.names:
            raise ValueError(f"figures must be among {', '.join(paper.names)}; got {name!r}")
    return names
