"""Figures that plot functions make, pictures of results for a notebook, and files of figures.

This is the convention for a plot function that is called without axes. It is that of seaborn and xarray where pyplot is in use:

- In a script that does not import pyplot, the figure belongs to its variable. No window opens, and memory is freed with it.
- Once `matplotlib.pyplot` is imported, with any backend, the figure belongs to pyplot. `plt.show`, `plt.savefig` and
  `plt.close` act on it. It stays open until it is closed, and Matplotlib warns of more than 20 open figures.
- A notebook shows the figure once, in the cell that calls the function, although it may be saved, too. Pyplot need not be imported.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

from matplotlib import get_backend, rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import LayoutEngine

from rocking.model.files import check_writable, replacing
from rocking.model.validation import WrongType, within

DOTS_PER_INCH = 110

_apart = ContextVar("_apart", default=False)


class PyplotFigure(Figure):
    """Figure of pyplot that a notebook shows once if a cell returns it."""

    def _ipython_display_(self) -> None:
        """Close the figure, because the inline backend would show it again, and leave the display to IPython."""
        if "inline" in get_backend():
            sys.modules["matplotlib.pyplot"].close(self)
        raise NotImplementedError


def new(width: float, height: float, layout: Literal["constrained"] | LayoutEngine = "constrained") -> Figure:
    """Return a new figure of a size in inches, owned by pyplot if pyplot is in use."""
    pyplot = None if _apart.get() else _pyplot()
    if pyplot is None:
        return Figure(figsize=(width, height), layout=layout)
    return pyplot.figure(figsize=(width, height), layout=layout, FigureClass=PyplotFigure)


def _pyplot() -> ModuleType | None:
    """Return pyplot if it is imported. The kernel of a notebook imports it."""
    ipython = sys.modules.get("IPython")
    if ipython is not None and hasattr(ipython.get_ipython(), "kernel"):
        return import_module("matplotlib.pyplot")
    return sys.modules.get("matplotlib.pyplot")


@contextmanager
def apart() -> Iterator[None]:
    """Keep the figures made in this context out of pyplot."""
    before = _apart.set(True)
    try:
        yield
    finally:
        _apart.reset(before)


def picture(draw: Callable[[], Any]) -> bytes:
    """Return the PNG of the figure that a function makes, apart from pyplot."""
    stream = io.BytesIO()
    with apart():
        draw().figure.savefig(stream, format="png", dpi=DOTS_PER_INCH)
    return stream.getvalue()


# Without these matplotlib writes the date and its own version into the file.
METADATA = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"CreationDate": None, "Producer": None, "Creator": None},
}


def save(figure: Figure | Axes, path: str | Path, dpi: float = 200.0) -> Path:
    """Write a figure as PNG, SVG or PDF; the same figure gives the same bytes.

    Parameters
    ----------
    figure : matplotlib Figure or Axes
        Figure to write. For axes, the whole figure that contains them.
    path : str or Path
        Path of the file; the suffix selects the format: .png, .svg or .pdf.
    dpi : float
        Resolution of a PNG, and of rasterised points inside SVG and PDF, in dots per inch, in [10, 2400]. Default: 200.

    Returns
    -------
    Path
        Path of the file, which exists only once it is complete.

    Raises
    ------
    TypeError
        If `figure` is neither a Figure nor Axes, or `path` is not a path.
    ValueError
        If the suffix of `path` is not supported, or `dpi` lies outside its range.
    OSError
        If `path` cannot be written.

    See Also
    --------
    panels : Make a figure.
    animation : Write an animation.

    Notes
    -----
    The figure stays open. A notebook shows it, too.

    Examples
    --------
    >>> import rocking as rk, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     rk.plot.save(rk.plot.schematic(), f"{folder}/block.svg").name
    'block.svg'
    """
    drawn = figure.figure if isinstance(figure, Axes) else figure
    if not isinstance(drawn, Figure):
        raise WrongType("figure", "be a matplotlib Figure or Axes", figure)
    dpi = within("dpi", dpi, 10.0, 2400.0)
    path = check_path(path, tuple(METADATA))
    suffix = path.suffix.lower()
    # Names inside an SVG are hashed with a salt, by default a random one.
    with replacing(path) as partial, rc_context({"svg.hashsalt": "rocking"}):
        drawn.savefig(partial, format=suffix[1:], dpi=dpi, metadata=METADATA[suffix])
    return path


def check_path(path: str | Path, suffixes: Sequence[str]) -> Path:
    """Return `path` if it can be written and has one of these suffixes; raise before any computation otherwise."""
    if not isinstance(path, str | os.PathLike):
        raise WrongType("path", f"be the name of a file that ends in {', '.join(suffixes)}", path)
    return check_writable("path", path, suffixes)
