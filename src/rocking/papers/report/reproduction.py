"""Figures, tables and claims of a paper as files, and a report on all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from pathlib import Path

import matplotlib.style
from attrs import frozen

import rocking as rk
from rocking.model.files import check_folder
from rocking.model.package import require_extra
from rocking.model.progress import Bar
from rocking.model.text import counted
from rocking.model.validation import Refusal, instance
from rocking.papers.report import page
from rocking.papers.report.claim import Chapter
from rocking.papers.report.workers import Step, carry_out

CLAIMS = "claims"
"""Name of the table of claims, which is written with the verdicts."""


@frozen
class Part:
    """Figure or table of a report.

    Attributes
    ----------
    module : str
        Module with `draw` or `write`.
    cost : float
        Approximate processor time, s, for progress and for the order of the steps. Default: 0.5.
    """

    module: str
    cost: float = 0.5


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
        Figures, tables except "claims", and additional figures, by name.
    pixels : sequence of str
        Figures with many points, which the page shows as PNG.
    chapters : callable
        Function that returns the claims.
    page_cost : float
        Approximate processor time of the page, s.
    """

    title: str
    lead: str
    source: str
    figures: Mapping[str, Part]
    tables: Mapping[str, Part]
    beyond: Mapping[str, Part]
    pixels: Sequence[str]
    chapters: Callable[[], Sequence[Chapter]]
    page_cost: float

    @property
    def parts(self) -> dict[str, Part]:
        """Figures, tables except "claims", and additional figures, by name."""
        return {**self.figures, **self.tables, **self.beyond}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of figures, tables and additional figures, in the order of the report."""
        return (*self.figures, *self.tables, CLAIMS, *self.beyond)

    def known(self, names: Iterable[str | int]) -> list[str]:
        """Return names as text; Refusal if the report lacks one."""
        found = [str(name) for name in names]
        for name in found:
            if name not in self.names:
                raise Refusal("figures", f"be among {', '.join(self.names)}", name)
        return found

    def steps(self, name: str, folder: Path) -> list[Step]:
        """Return the steps that write a figure or a table, or that test the claims."""
        if name == CLAIMS:
            return [
                Step(claim.place, claim.cost, claim.compute)
                for chapter in self.chapters()
                for claim in chapter
            ]
        part = self.parts[name]
        if name in self.tables:
            return [Step(name, part.cost, _tabulate, (part.module, folder))]
        label = f"figure {name}" if name in self.figures else name
        return [Step(label, part.cost, _draw, (part.module, folder / self.stem(name)))]

    def stem(self, name: str) -> str:
        """Return the name of the files of a figure, without suffix."""
        return f"figure-{name:>02}" if name in self.figures else f"beyond-{name}"

    def picture(self, name: str, folder: Path) -> page.Picture:
        """Return a figure as the page shows it."""
        file = folder / f"{self.stem(name)}{'.png' if name in self.pixels else '.svg'}"
        return page.pictured(self.stem(name), self.parts[name].module, file)


def write(
    paper: Paper,
    folder: str | Path,
    figures: Iterable[str | int] | None = None,
    progress: bool = False,
    summary: Callable[[str], object] | None = None,
) -> list[Path]:
    """Write figures and tables of a paper, by default all of them and the report; return the paths.

    The report needs the extra ``report``: `ImportError` without it.
    """
    if figures is None:
        require_extra("report")
    wanted = paper.known(paper.names if figures is None else figures)
    folder = check_folder("folder", folder)
    folder.mkdir(parents=True, exist_ok=True)
    steps = {name: paper.steps(name, folder) for name in wanted}
    every = [step for name in wanted for step in steps[name]]
    cost = sum(step.cost for step in every) + (paper.page_cost if figures is None else 0.0)
    claims = len(steps.get(CLAIMS, ()))
    tables = len(paper.tables.keys() & steps)
    figures_wanted = len(steps) - tables - (CLAIMS in steps)
    kinds = {"figure": figures_wanted, "table": tables, "claim": claims}
    title = f"{paper.title}: {', '.join(counted(count, kind) for kind, count in kinds.items() if count)}"
    with Bar(cost, title=title, in_seconds=True, shown=instance("progress", progress, bool)) as bar:
        results = dict(zip(every, carry_out(every, bar), strict=True))
        written: list[Path] = []
        judgements: list[page.Judgement] = []
        for name in wanted:
            found = [results[step] for step in steps[name]]
            if name == CLAIMS:
                judgements = page.judged(paper.chapters(), found)
                written += page.write_claims(folder, judgements)
            else:
                written += found[0]
        if figures is None:
            (pages,) = carry_out(
                [Step("page", paper.page_cost, _write_page, (paper, folder, judgements))], bar
            )
            written += pages
    if judgements and summary is not None:
        summary(page.summed_up(judgements, paper.source))
    return written


def _draw(module: str, stem: Path) -> list[Path]:
    # The bytes must not depend on the user's matplotlib settings.
    with matplotlib.style.context("default"):
        figure = import_module(module).draw()
        return [rk.plot.save(figure, stem.with_name(stem.name + suffix)) for suffix in (".png", ".svg")]


def _write_page(paper: Paper, folder: Path, judgements: list[page.Judgement]) -> list[Path]:
    figures, beyond = (
        [paper.picture(name, folder) for name in names] for names in (paper.figures, paper.beyond)
    )
    return page.write(folder, paper.title, paper.lead, figures, judgements, beyond)


def _tabulate(module: str, folder: Path) -> list[Path]:
    written: list[Path] = import_module(module).write(folder)
    return written
