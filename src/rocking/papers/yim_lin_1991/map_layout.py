"""The layout of the paper's maps: ours in colour, many points, beside the paper's symbols at a few."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure

import rocking as rk


def draw_map(found: xr.Dataset, symbols: str, title: str, curves: Sequence[str] = ()) -> Figure:
    """Draws a map over period and amplitude twice."""
    figure, (left, right) = rk.plot.panels(columns=2, height=4.4)
    rk.plot.parametric_map(found, left, curves=curves)
    rk.plot.parametric_map(found, right, curves=curves, symbols=symbols)
    rk.plot.title(left, f"{title}, {found.period.size} × {found.amplitude.size} points")
    rk.plot.title(right, "the same in the paper's symbols")
    return figure
