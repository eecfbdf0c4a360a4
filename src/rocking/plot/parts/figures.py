"""Figures that plot functions make, and pictures of results for a notebook.

This is the convention for a plot function that is called without axes. It is that of seaborn and xarray where pyplot is in use:

- In a script that does not import pyplot, the figure belongs to its variable. No window opens, and memory is freed with it.
- Once `matplotlib.pyplot` is imported, with any backend, the figure belongs to pyplot. `plt.show`, `plt.savefig` and
  `plt.close` act on it. It stays open until it is closed, and Matplotlib warns of more than 20 open figures.
- A notebook shows the figure once, in the cell that calls the function, although it may be saved, too. Pyplot need not be imported.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from importlib import import_module
from types import ModuleType
from typing import Any, Literal

from matplotlib import get_backend
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import LayoutEngine

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


def picture(draw: Callable[[Any], Axes | Figure]) -> Callable[[Any], bytes]:
    """Return a function that renders a result as the bytes of a PNG, given the function that draws it."""

    def png(result: Any) -> bytes:
        stream = io.BytesIO()
        with apart():
            drawn: Any = draw(result)
        drawn.figure.savefig(stream, format="png", dpi=DOTS_PER_INCH)
        return stream.getvalue()

    return png
