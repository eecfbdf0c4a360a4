"""Pictures of results as a notebook shows them."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

from matplotlib.axes import Axes

DOTS_PER_INCH = 110


def picture(draw: Callable[[Any], Axes]) -> Callable[[Any], bytes]:
    """What makes the bytes of a PNG of a result, from what draws it."""

    def png(result: Any) -> bytes:
        stream = io.BytesIO()
        ax = draw(result)
        ax.get_figure(root=True).savefig(stream, format="png", dpi=DOTS_PER_INCH)  # type: ignore[union-attr]
        return stream.getvalue()

    return png
