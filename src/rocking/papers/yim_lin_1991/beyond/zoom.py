"""Figure 11's boundary of overturning, a thousand times larger.

Left a corner of the map at e = 0.925 above A*; right the square in its middle, a thousandth as wide. There is as much to see: between
any two responses that stay lies one that overturns, however closely one looks.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk

CENTRE = (1.0914985576, 5.3120190162)
WIDTHS = ((0.8, 4.0), (8e-4, 4e-3))
COUNT = 240


def draw() -> Figure:
    """Draws the map and its enlargement."""
    figure, axes = rk.plot.panels(columns=2, height=3.8)
    for ax, (width, height) in zip(axes, WIDTHS, strict=True):
        (period, amplitude) = CENTRE
        found = rk.parametric_map(
            period=period + width * np.linspace(-0.5, 0.5, COUNT),
            amplitude=amplitude + height * np.linspace(-0.5, 0.5, COUNT),
            restitution=0.925,
        )
        rk.plot.parametric_map(found, ax)
        rk.plot.title(ax, f"{width:g} by {height:g} around\n$T = {period:.4f}$, $A = {amplitude:.4f}$")
    return figure
