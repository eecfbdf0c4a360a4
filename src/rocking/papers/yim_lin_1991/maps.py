"""The layout of the paper's maps: ours in colour, many points, beside the paper's symbols at a few."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import rocking as rk

PERIODS, AMPLITUDES = (0.2, 3.0), (0.0, 16.0)


def draw_map(symbols: str, count: int, title: str, curves: Sequence[str] = (), **asked: Any) -> Figure:
    """Draws a map of count × count points from rest, T 0.2 to 3 and A 0 to 16."""
    found = rk.parametric_map(
        period=np.linspace(*PERIODS, count), amplitude=np.linspace(*AMPLITUDES, count), **asked
    )
    figure, (left, right) = rk.plot.panels(columns=2, height=4.4)
    rk.plot.parametric_map(found, left, curves=curves)
    rk.plot.parametric_map(found, right, curves=curves, symbols=symbols)
    rk.plot.title(left, f"{title}, {count} × {count} points")
    rk.plot.title(right, "the same in the paper's symbols")
    return figure
