"""Figures, tables and claims of the paper as files, and a report on all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path

from rocking.papers.report import reproduction
from rocking.papers.report.claim import Chapter
from rocking.papers.yim_lin_1991 import beyond

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
        "crisis", "threshold", "coexistence", "zoom" and "bifurcations". Default: all of them, and the report index.html, also as PDF if
        the libraries of WeasyPrint are available.
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
    figures={name: f"{ROOM}.figure{stem}" for name, stem in FIGURES.items()},
    tables={name: f"{ROOM}.table_{name}" for name in TABLES},
    beyond={name: f"{ROOM}.beyond.{name}" for name in beyond.NAMES},
    pixels=PIXELS,
    chapters=lambda: _chapters(),  # noqa: PLW0108 (looked up at each call)
)
