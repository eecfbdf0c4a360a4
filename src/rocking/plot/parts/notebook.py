"""Figures of results for display in a notebook."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

DOTS_PER_INCH = 110


def picture(draw: Callable[[Any], Axes | Figure]) -> Callable[[Any], bytes]:
    """Return a function that renders a result as the bytes of a PNG, given the function that draws it."""

    def png(result: Any) -> bytes:
        stream = io.BytesIO()
        drawn: Any = draw(result)
        drawn.get_figure(root=True).savefig(stream, format="png", dpi=DOTS_PER_INCH)
        return stream.getvalue()

    return png
