"""Boundary of overturning of figure 11, and a part of it enlarged a thousand times, e = 0.925.

(a) Part of the map above A*, around T₀ = 1.0914985576 and A₀ = 5.3120190162, 0.8 wide and 4 high, 240 × 240 points.
(b) The part in the middle of (a), a thousandth as wide and as high, with as many points. The square in (a) marks its
position, enlarged. Strips of overturning alternate with strips of bounded responses, in (b) as in (a). Both also have
large regions without a change. The titles give the fraction of neighbouring points, at the same amplitude, of which
one overturns and the other does not. A single smooth boundary from top to bottom would give 1 in 239, or 0.42 %.
"""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter

import rocking as rk
from rocking.papers.report.claim import small
from rocking.papers.yim_lin_1991 import cached_surveys

CENTRE = (1.0914985576, 5.3120190162)
WIDTHS = ((0.8, 4.0), (8e-4, 4e-3))
COUNT = 240
# Units of the enlarged axes, and the ticks in these units.
UNITS = (1e-4, 1e-3)
TICKS = ((-4, -2, 0, 2, 4), (-2, -1, 0, 1, 2))


def draw() -> Figure:
    """Draw the map and its enlargement."""
    figure, axes = rk.plot.panels(columns=2, height=3.8)
    for ax, (width, height) in zip(axes, WIDTHS, strict=True):
        (period, amplitude) = CENTRE
        found = rk.parametric_map(
            cached_surveys.SYSTEM,
            period=period + width * np.linspace(-0.5, 0.5, COUNT),
            amplitude=amplitude + height * np.linspace(-0.5, 0.5, COUNT),
        ).dataset
        rk.plot.parametric_map(found, ax)
        rk.plot.title(ax, f"{100 * divided(found):.1f} % of neighbouring points differ")
    left, right = axes
    for colour, thickness in (("white", 3.0), (rk.plot.palette.INK, 1.2)):
        left.plot(
            *CENTRE, "s", markersize=8.0, markerfacecolor="none", markeredgecolor=colour, markeredgewidth=thickness
        )  # fmt: skip
    _measure_from_centre(right)
    return figure


def divided(found: xr.Dataset) -> float:
    """Return the fraction of points adjacent in period of which one overturns and the other does not."""
    over = found.kind.transpose("amplitude", "period").values == rk.Kind.OVERTURNED.code
    return float((over[:, 1:] != over[:, :-1]).mean())


def _measure_from_centre(ax: Axes) -> None:
    """Label the axes with the distances from the centre, in powers of ten."""
    for axis, symbol, centre, unit, ticks in zip(
        (ax.xaxis, ax.yaxis), "TA", CENTRE, UNITS, TICKS, strict=True
    ):
        axis.set_major_locator(FixedLocator([centre + unit * tick for tick in ticks]))
        axis.set_major_formatter(
            FuncFormatter(
                lambda value, _, centre=centre, unit=unit: f"{round((value - centre) / unit)}".replace(
                    "-", "−"
                )
            )
        )
        axis.set_label_text(f"${symbol} - {symbol}_0$ ({small(unit)})")
