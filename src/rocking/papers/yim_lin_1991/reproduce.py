"""Figures, tables and claims of the paper as files, and a report on all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path

import matplotlib.style

import rocking as rk
from rocking.model import check_folder
from rocking.papers.yim_lin_1991 import beyond, report
from rocking.papers.yim_lin_1991.claim import Chapter

FIGURES = {
    "1": "01",
    "2": "02",
    "3": "03",
    "4": "04",
    "5": "05",
    "6": "06",
    "7": "07",
    "8": "08",
    "9": "09",
    "10": "10",
    "11": "11",
    "12": "12",
    "13a": "13",
    "13b": "13b",
}
TABLES = ("exponents", "claims")
ROOM = "rocking.papers.yim_lin_1991"
# Figures with many points, which the page shows as PNG.
PIXELS = ("6", "7", "10", "11", "13a", "13b", "cascade", "crisis", "coexistence", "zoom")


def reproduce(
    folder: str | Path,
    figures: Iterable[str | int] | None = None,
    progress: Callable[[int, int, str], object] | None = None,
    summary: Callable[[str], object] | None = None,
) -> list[Path]:
    """Write figures of Yim & Lin (1991) as PNG (200 dpi) and SVG, and tables as CSV and Markdown, with reproducible bytes.

    Parameters
    ----------
    folder : str or Path
        Folder for the files; created if it does not exist.
    figures : iterable of str or int, optional
        Figures of the paper, 1 to 12, "13a" and "13b". Tables: "exponents" and "claims". Additional figures: "chaos", "cascade",
        "crisis", "threshold", "coexistence" and "zoom". Default: all of them, and the report index.html, also as PDF if
        WeasyPrint is installed.
    progress : callable, optional
        Called as ``progress(done, total, name)`` before each figure, table and claim, and once at the end.
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
    OSError
        If the folder cannot be created or written.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     [path.name for path in reproduce(folder, figures=[1])]
    ['figure-01.png', 'figure-01.svg']
    """
    wanted = _known((*FIGURES, *TABLES, *beyond.NAMES) if figures is None else figures)
    folder = check_folder("folder", folder)
    folder.mkdir(parents=True, exist_ok=True)
    steps = Steps(wanted, whole=figures is None, said=progress)
    written: list[Path] = []
    judgements: list[report.Judgement] = []
    for name in wanted:
        if name == "claims":
            judgements = report.judged(_chapters(), steps.next)
            written += report.write_claims(folder, judgements)
            if summary is not None:
                summary(report.summed_up(judgements))
            continue
        steps.next(name if name in (*TABLES, *beyond.NAMES) else f"figure {name}")
        if name in TABLES:
            written += import_module(f"{ROOM}.table_{name}").write(folder)
        else:
            written += _draw(name, folder)
    if figures is None:
        steps.next("page")
        page = [
            [report.pictured(_stem(name), _module(name), _shown(name, folder)) for name in names]
            for names in (FIGURES, beyond.NAMES)
        ]
        written += report.write(folder, page[0], judgements, page[1])
    steps.end()
    return written


class Steps:
    """Progress report."""

    def __init__(
        self, wanted: list[str], whole: bool, said: Callable[[int, int, str], object] | None
    ) -> None:
        claims = sum(map(len, _chapters())) if "claims" in wanted else 1
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


def _chapters() -> tuple[Chapter, ...]:
    return import_module(f"{ROOM}.claims").CHAPTERS


def _module(name: str) -> str:
    return f"{ROOM}.figure{FIGURES[name]}" if name in FIGURES else f"{ROOM}.beyond.{name}"


def _stem(name: str) -> str:
    return f"figure-{name:>02}" if name in FIGURES else f"beyond-{name}"


def _shown(name: str, folder: Path) -> Path:
    """Return the file of a figure that the page shows."""
    return folder / f"{_stem(name)}{'.png' if name in PIXELS else '.svg'}"


def _draw(name: str, folder: Path) -> list[Path]:
    # The bytes must not depend on the user's matplotlib settings.
    with matplotlib.style.context("default"):
        figure = import_module(_module(name)).draw()
        return [rk.plot.save(figure, folder / f"{_stem(name)}{suffix}") for suffix in (".png", ".svg")]


def _known(figures: Iterable[str | int]) -> list[str]:
    names = [str(figure) for figure in figures]
    for name in names:
        if name not in (*FIGURES, *TABLES, *beyond.NAMES):
            raise ValueError(
                f"figures must be among {', '.join((*FIGURES, *TABLES, *beyond.NAMES))}; got {name!r}"
            )
    return names
