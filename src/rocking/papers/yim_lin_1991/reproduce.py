"""The paper's figures, numbers and claims into a folder, and one page of them all."""

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
# Drawn from so many points that a page had better show them as pixels.
PIXELS = ("6", "7", "10", "11", "13a", "13b", "cascade", "crisis", "coexistence", "zoom")


def reproduce(
    folder: str | Path,
    figures: Iterable[str | int] | None = None,
    progress: Callable[[int, int, str], object] | None = None,
    summary: Callable[[str], object] | None = None,
) -> list[Path]:
    """Writes figures of Yim and Lin (1991) as PNG (200 dpi) and SVG, tables as CSV and Markdown; the same bytes every time.

    Parameters
    ----------
    folder : str or Path
        Where they go; made if it does not exist.
    figures : iterable of str or int, optional
        Which, by their numbers in the paper: 1 to 12, "13a" and "13b"; "exponents" and "claims", tables; or the name of a
        picture beyond the paper: "chaos", "cascade", "crisis", "threshold", "coexistence" and "zoom". All of them if not
        given, and then also index.html, one page of them all, with a twin in PDF where WeasyPrint is installed.
    progress : callable, optional
        Called as ``progress(done, total, name)`` before each of them and each claim, and once at the end.

    summary : callable, optional
        Called as ``summary(sentence)`` once the claims are judged: how many there are, and how they stand.

    Returns
    -------
    list of Path
        The files, in the order of the figures; each appears under its name only once it is complete.

    Raises
    ------
    ValueError
        If there is no such figure here.
    OSError
        If the folder cannot be made or written.

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
    """Tells how far it has come."""

    def __init__(
        self, wanted: list[str], whole: bool, said: Callable[[int, int, str], object] | None
    ) -> None:
        claims = sum(map(len, _chapters())) if "claims" in wanted else 1
        self.done, self.total, self.name, self.said = -1, len(wanted) - 1 + claims + whole, "", said
        if not wanted:
            self.total = 0

    def next(self, name: str) -> None:
        """Before the next step."""
        self.done, self.name = self.done + 1, name
        if self.said is not None:
            self.said(self.done, self.total, name)

    def end(self) -> None:
        """After the last."""
        if self.said is not None:
            self.said(self.total, self.total, self.name)


def _chapters() -> tuple[Chapter, ...]:
    return import_module(f"{ROOM}.claims").CHAPTERS


def _module(name: str) -> str:
    return f"{ROOM}.figure{FIGURES[name]}" if name in FIGURES else f"{ROOM}.beyond.{name}"


def _stem(name: str) -> str:
    return f"figure-{name:>02}" if name in FIGURES else f"beyond-{name}"


def _shown(name: str, folder: Path) -> Path:
    """Which of a picture's files the page shows."""
    return folder / f"{_stem(name)}{'.png' if name in PIXELS else '.svg'}"


def _draw(name: str, folder: Path) -> list[Path]:
    # The reader's own style must not decide what the bytes are.
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
