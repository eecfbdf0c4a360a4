"""The paper's figures and numbers into a folder."""

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path

import matplotlib.style

import rocking as rk
from rocking.model import check_folder

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
TABLES = {"exponents": "table_exponents"}


def reproduce(
    folder: str | Path,
    figures: Iterable[str | int] | None = None,
    progress: Callable[[int, int, str], object] | None = None,
) -> list[Path]:
    """Writes figures of Yim and Lin (1991) as PNG (200 dpi) and SVG, tables as CSV and Markdown; the same bytes every time.

    Parameters
    ----------
    folder : str or Path
        Where they go; made if it does not exist.
    figures : iterable of str or int, optional
        Which, by their numbers in the paper: 1 to 12, "13a" and "13b"; or "exponents", a table. All of them if not given.
    progress : callable, optional
        Called as ``progress(done, total, name)`` before each figure and once at the end.

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
    wanted = _known((*FIGURES, *TABLES) if figures is None else figures)
    folder = check_folder("folder", folder)
    folder.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    for done, name in enumerate(wanted):
        if progress is not None:
            progress(done, len(wanted), name)
        if name in TABLES:
            written += import_module(f"rocking.papers.yim_lin_1991.{TABLES[name]}").write(folder)
            continue
        # The reader's own style must not decide what the bytes are.
        with matplotlib.style.context("default"):
            figure = import_module(f"rocking.papers.yim_lin_1991.figure{FIGURES[name]}").draw()
            written += [
                rk.plot.save(figure, folder / f"figure-{name:>02}{suffix}") for suffix in (".png", ".svg")
            ]
    if progress is not None:
        progress(len(wanted), len(wanted), wanted[-1] if wanted else "")
    return written


def _known(figures: Iterable[str | int]) -> list[str]:
    names = [str(figure) for figure in figures]
    for name in names:
        if name not in FIGURES and name not in TABLES:
            raise ValueError(f"figures must be among {', '.join((*FIGURES, *TABLES))}; got {name!r}")
    return names
