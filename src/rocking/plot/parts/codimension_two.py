"""Marks of points of codimension two on bifurcation curves."""

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from rocking.orbits.bifurcation_curve import BifurcationCurve
from rocking.plot.parts import style
from rocking.plot.parts.branch_lines import unless_there

# Marker, size in points, and name in the legend.
AT_GRAZING = ("o", 3.0, "at a grazing")
MARKS = {
    "cusp": ("D", 3.0, "cusp"),
    "degenerate-period-doubling": ("*", 5.5, "degenerate doubling"),
    "degenerate-symmetry-breaking": ("P", 4.5, "degenerate breaking"),
}


def mark(
    ax: Axes, curves: Iterable[BifurcationCurve], across: Callable[[Any], Any], upright: Callable[[Any], Any]
) -> None:
    """Draw one mark per point of codimension two, and one entry of the legend per type of mark."""
    points = [point for curve in curves for point in curve.special]
    for kind in dict.fromkeys(point.kind for point in points):
        marker, size, name = MARKS.get(kind, AT_GRAZING)
        x, y = np.array([point.values for point in points if point.kind == kind]).T
        ax.plot(
            across(x),
            upright(y),
            linestyle="none",
            marker=marker,
            color=style.INK,
            markeredgecolor=style.INK,
            markeredgewidth=0.3,
            markersize=size,
            zorder=3,
            label=unless_there(ax, name),
            gid="codimension-2",
        )
