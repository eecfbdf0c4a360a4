"""Layout of the paper's maps: all points in colour, beside the paper's symbols at some of them."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure

import rocking as rk


def draw_map(found: xr.Dataset, symbols: str, curves: Sequence[str] = ()) -> Figure:
    """Draw a map over period and amplitude in colour and in symbols."""
    figure, (left, right) = rk.plot.panels(columns=2, height=4.4)
    rk.plot.parametric_map(found, left, curves=curves)
    rk.plot.parametric_map(found, right, curves=curves, symbols=symbols)
    rk.plot.title(left, f"{found.period.size} × {found.amplitude.size} points")
    rk.plot.title(right, "symbols of the paper")
    return figure
