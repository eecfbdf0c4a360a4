"""Figures, tables and claims of the paper as files, and a report on all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path

from rocking.papers.report import reproduction
from rocking.papers.report.claim import Chapter
from rocking.papers.report.reproduction import Part

ROOM = "rocking.papers.yim_lin_1991"
FIGURES = {
    "1": Part(f"{ROOM}.figure01", 0.3),
    "2": Part(f"{ROOM}.figure02", 0.5),
    "3": Part(f"{ROOM}.figure03", 0.6),
    "4": Part(f"{ROOM}.figure04", 0.4),
    "5": Part(f"{ROOM}.figure05", 0.6),
    "6": Part(f"{ROOM}.figure06", 0.4),
    "7": Part(f"{ROOM}.figure07", 0.8),
    "8": Part(f"{ROOM}.figure08", 3.2),
    "9": Part(f"{ROOM}.figure09", 0.3),
    "10": Part(f"{ROOM}.figure10", 1.8),
    "11": Part(f"{ROOM}.figure11", 1.3),
    "12": Part(f"{ROOM}.figure12", 0.3),
    "13a": Part(f"{ROOM}.figure13", 0.4),
    "13b": Part(f"{ROOM}.figure13b", 4.3),
}
TABLES = {"exponents": Part(f"{ROOM}.table_exponents", 6.5)}
BEYOND = {
    "chaos": Part(f"{ROOM}.beyond.chaos", 1.5),
    "cascade": Part(f"{ROOM}.beyond.cascade", 0.8),
    "crisis": Part(f"{ROOM}.beyond.crisis", 0.4),
    "threshold": Part(f"{ROOM}.beyond.threshold", 0.4),
    "coexistence": Part(f"{ROOM}.beyond.coexistence", 1.4),
    "zoom": Part(f"{ROOM}.beyond.zoom", 1.3),
    "bifurcations": Part(f"{ROOM}.beyond.bifurcations", 23.0),
}
# Figures with many points, which the page shows as PNG.
PIXELS = ("6", "7", "10", "11", "13a", "13b", "cascade", "crisis", "coexistence", "zoom", "bifurcations")


TITLE = "Yim & Lin (1991), recomputed"
LEAD = """\
All figures and claims of S. C. S. Yim and H. Lin, Nonlinear impact and chaotic response of slender rocking objects,
J. Eng. Mech. ASCE 117 (1991), recomputed with rocking {version}. Each verdict was computed when this page was generated. The claims
are paraphrased; their numbers and locations are those of the paper. The explanations after a verdict are written by hand. If the
computation does not support an explanation, the verdict is “not confirmed”."""


def reproduce(
    folder: str | Path,
    figures: Iterable[str | int] | None = None,
    progress: bool = False,
    summary: Callable[[str], object] | None = None,
) -> list[Path]:
    """Write figures of Yim & Lin (1991) as PNG (200 dpi) and SVG, and tables as CSV and Markdown, with reproducible bytes.

    Parameters
    ----------
    folder : str or Path
        Folder for the files; created if it does not exist.
    figures : iterable of str or int, optional
        Figures of the paper, 1 to 12, "13a" and "13b". Tables: "exponents" and "claims". Additional figures: "chaos", "cascade",
        "crisis", "threshold", "coexistence", "zoom" and "bifurcations". Default: all of them, and the report index.html, also as PDF if
        the libraries of WeasyPrint are available.
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
    ...     [path.name for path in reproduce(folder, figures=[1])]
    ['figure-01.png', 'figure-01.svg']
    """
    return reproduction.write(PAPER, folder, figures, progress, summary)


def _chapters() -> tuple[Chapter, ...]:
    return import_module(f"{ROOM}.claims").CHAPTERS


PAPER = reproduction.Paper(
    title=TITLE,
    lead=LEAD,
    source="the paper",
    figures=FIGURES,
    tables=TABLES,
    beyond=BEYOND,
    pixels=PIXELS,
    page_cost=5.2,
    chapters=lambda: _chapters(),  # noqa: PLW0108 (looked up at each call)
)
