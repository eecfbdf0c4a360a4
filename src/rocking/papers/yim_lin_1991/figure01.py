"""Figure 1: the block, its corners O and O', its dimensions H and B, the angles θ and θcr, and the base's acceleration.

Ours is drawn with half the critical angle and with the signs of eqs. 1 to 3: angles count clockwise, accelerations to
the right.
"""

from matplotlib.figure import Figure

import rocking as rk


def draw() -> Figure:
    """Draws figure 1."""
    figure, (ax,) = rk.plot.panels(height=3.6)
    rk.plot.schematic(ax)
    return figure
