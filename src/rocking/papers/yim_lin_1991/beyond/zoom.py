"""Figure 11's boundary of overturning, and a part of it a thousand times larger.

(a) A part of the map at e = 0.925 above A*, around T = 1.0915 and A = 5.3120, 240 × 240 points. (b) The part in the middle of (a), a
thousandth as wide and as high, with as many points. Strips that overturn alternate with strips that do not, in (b) as in (a); both also
have wide regions without a change. The titles give the share of neighbouring points, at the same amplitude, of which one overturns
and the other does not. Of a single smooth boundary from top to bottom it would be 1 in 239, or 0.42 %.
"""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import rocking as rk

CENTRE = (1.0914985576, 5.3120190162)
WIDTHS = ((0.8, 4.0), (8e-4, 4e-3))
COUNT = 240


def draw() -> Figure:
    """Draw the map and its enlargement."""
    figure, axes = rk.plot.panels(columns=2, height=3.8)
    for ax, (width, height) in zip(axes, WIDTHS, strict=True):
        (period, amplitude) = CENTRE
        found = rk.parametric_map(
            period=period + width * np.linspace(-0.5, 0.5, COUNT),
            amplitude=amplitude + height * np.linspace(-0.5, 0.5, COUNT),
            restitution=0.925,
        )
        rk.plot.parametric_map(found, ax)
        rk.plot.title(
            ax, f"{width:g} by {height:g}\none of two neighbours overturns: {100 * divided(found):.1f} %"
        )
    return figure


def divided(found: xr.Dataset) -> float:
    """The share of points next to each other in period of which one overturns and the other does not."""
    over = found.kind.transpose("amplitude", "period").values == rk.Kind.OVERTURNED.code
    return float((over[:, 1:] != over[:, :-1]).mean())
