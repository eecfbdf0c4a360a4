"""Figures, tables and claims of a paper as files, and a report on all of them."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from pathlib import Path

import matplotlib.style
from matplotlib.figure import Figure

import rocking as rk
from rocking.model.files import check_folder
from rocking.model.package import require_extra
from rocking.model.progress import Bar
from rocking.model.text import counted
from rocking.model.validation import instance
from rocking.papers.report import page
from rocking.papers.report.paper import CLAIMS, Kind, Paper, Part
from rocking.papers.report.workers import Step, carry_out


def reproduce(
    paper: Paper,
    folder: str | Path,
    figures: Iterable[str | int] | None = None,
    progress: bool = False,
    summary: Callable[[str], object] | None = None,
) -> list[Path]:
    """Write figures of a paper as PNG (200 dpi) and SVG, and tables as CSV and Markdown, with reproducible bytes.

    Parameters
    ----------
    paper : Paper
        Contents of the report, from `rocking.papers.catalogue`.
    folder : str or Path
        Folder for the files; created if it does not exist.
    figures : iterable of str or int, optional
        Names of figures and tables, such as 12, "13a" or "claims"; `Paper.names` lists them. Default: all of them, and the
        report, whose first page is index.html, also as PDF if the libraries of WeasyPrint are available.
    progress : bool
        Whether to show on stderr the part of the cost that is done, and the steps that run. Default: False.
    summary : callable, optional
        Called as ``summary(line)`` after the claims, with the number of claims by verdict.

    Returns
    -------
    list of Path
        Paths of the files, in the order of the figures. A file exists only once it is complete.

    Raises
    ------
    ValueError
        If a figure is unknown.
    ImportError
        If the report is wanted, and the extra ``report`` is not installed.
    OSError
        If the folder cannot be created or written.

    Examples
    --------
    >>> import tempfile
    >>> from rocking.papers.catalogue import YIM_LIN_1991
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     [path.name for path in reproduce(YIM_LIN_1991, folder, figures=[1])]
    ['figure-01.png', 'figure-01.svg']
    """
    if figures is None:
        require_extra("report")
    requested = paper.known(paper.names if figures is None else figures)
    folder = check_folder("folder", folder)
    folder.mkdir(parents=True, exist_ok=True)
    steps = {name: steps_of(paper, name, folder) for name in requested}
    every = [step for name in requested for step in steps[name]]
    cost = sum(step.cost for step in every) + (paper.page_cost if figures is None else 0.0)
    title = f"{paper.title}: {_contents(paper, steps)}"
    with Bar(cost, title=title, in_seconds=True, shown=instance("progress", progress, bool)) as bar:
        results = dict(zip(every, carry_out(every, bar), strict=True))
        written: list[Path] = []
        chapters: list[page.Section] = []
        for name in requested:
            computed = [results[step] for step in steps[name]]
            if name == CLAIMS:
                chapters = page.verdicts(paper.chapters, computed)
                written += page.write_claims(folder, chapters)
            else:
                written += computed[0]
        if figures is None:
            last = Step("page", paper.page_cost, _write_page, (paper, folder, chapters))
            written += carry_out([last], bar)[0]
    if chapters and summary is not None:
        summary(page.summary_line(chapters, paper.source))
    return written


def steps_of(paper: Paper, name: str, folder: Path) -> list[Step]:
    """Return the steps that write a figure or a table, or that test the claims."""
    if name == CLAIMS:
        return [
            Step(claim.place, claim.cost, claim.compute) for chapter in paper.chapters for claim in chapter
        ]
    part = paper.parts[name]
    if part.kind is Kind.TABLE:
        return [Step(part.text, part.cost, part.compute, (folder,))]
    return [Step(part.text, part.cost, _draw, (part.compute, folder / part.stem))]


def _contents(paper: Paper, steps: dict[str, list[Step]]) -> str:
    """Return the numbers of figures, tables and claims as text."""
    tables = sum(part.name in steps for part in paper.of(Kind.TABLE))
    claims = CLAIMS in steps
    numbers = {
        "figure": len(steps) - tables - claims,
        "table": tables,
        "claim": len(steps[CLAIMS]) if claims else 0,
    }
    return ", ".join(counted(count, kind) for kind, count in numbers.items() if count)


def _draw(draw: Callable[[], Figure], stem: Path) -> list[Path]:
    # The bytes must not depend on the user's matplotlib settings.
    with matplotlib.style.context("default"):
        figure = draw()
        return [rk.plot.save(figure, stem.with_name(stem.name + suffix)) for suffix in (".png", ".svg")]


def _write_page(paper: Paper, folder: Path, chapters: list[page.Section]) -> list[Path]:
    figures, additional = (
        page.Section(name, title, pictures=[_picture(part, folder) for part in paper.of(kind)])
        for name, title, kind in (
            ("figures", "Figures", Kind.FIGURE),
            ("further-results", "Further results", Kind.ADDITIONAL),
        )
    )
    sections = [figures, *chapters, additional]
    return page.write(
        folder, paper.title, paper.lead, [each for each in sections if each.pictures or each.claims]
    )


def _picture(part: Part, folder: Path) -> page.Picture:
    """Return a figure as the page shows it, with its caption."""
    title, _, text = inspect.cleandoc(part.compute.__doc__ or "").partition("\n\n")
    file = folder / f"{part.stem}{'.png' if part.pixels else '.svg'}"
    return page.Picture(part.stem, title.replace("\n", " "), text, file)
