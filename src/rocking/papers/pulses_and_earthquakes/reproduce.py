"""Figures and judged rows of the papers as files, and a report on all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path

from rocking.papers.report import reproduction
from rocking.papers.report.claim import Chapter
from rocking.papers.report.reproduction import Part

ROOM = "rocking.papers.pulses_and_earthquakes"
TITLE = "The rocking block under pulses and earthquakes, recomputed"
LEAD = """\
Formulas and numbers of Housner (1963), Shi et al. (1996), Makris & Roussos (2000), Zhang & Makris (2001) and Makris & Konstantinidis
(2003), recomputed with rocking {version}. They are those of the slender block or, where a row says so, of the full equation of motion.
Each verdict was computed when this page was generated. The claims are paraphrased; their numbers and locations are those of the papers. The
explanations after a verdict are written by hand. If the computation does not support an explanation, the verdict is “not confirmed”. Rows
that need a record which does not come with the package are not judged. e is the ratio of the velocities after and before an impact. A =
a/(gθcr) is the normalised acceleration, Ω the frequency of a pulse over the frequency parameter of the block."""


def reproduce(
    folder: str | Path,
    figures: Iterable[str | int] | None = None,
    progress: bool = False,
    summary: Callable[[str], object] | None = None,
) -> list[Path]:
    """Write figures of the report as PNG (200 dpi) and SVG, and the table of rows as CSV and Markdown, with reproducible bytes.

    Parameters
    ----------
    folder : str or Path
        Folder for the files; created if it does not exist.
    figures : iterable of str or int, optional
        Figures 1 to 5, and the table "claims". Default: all of them, and the report index.html, also as PDF if the
        libraries of WeasyPrint are available.
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
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     [path.name for path in reproduce(folder, figures=[2])]
    ['figure-02.png', 'figure-02.svg']
    """
    return reproduction.write(PAPER, folder, figures, progress, summary)


def _chapters() -> tuple[Chapter, ...]:
    return import_module(f"{ROOM}.claims").CHAPTERS


PAPER = reproduction.Paper(
    title=TITLE,
    lead=LEAD,
    source="the papers",
    figures={
        "1": Part(f"{ROOM}.figure01", 3.0),
        "2": Part(f"{ROOM}.figure02", 0.6),
        "3": Part(f"{ROOM}.figure03", 0.4),
        "4": Part(f"{ROOM}.figure04", 0.7),
        "5": Part(f"{ROOM}.figure05", 4.7),
    },
    tables={},
    beyond={},
    pixels=("1", "4"),
    page_cost=1.6,
    chapters=lambda: _chapters(),  # noqa: PLW0108 (looked up at each call)
)
