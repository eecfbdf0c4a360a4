"""Figure 1: block and base, with dimensions H, B, R, corners O, O', angles θ, θcr and base acceleration.

The block is drawn at θ = θcr/2. Signs are those of Eqs. (1) to (3): angles are positive clockwise, accelerations to
the right.
"""

from matplotlib.figure import Figure

import rocking as rk


def draw() -> Figure:
    """Draw figure 1."""
    figure, (ax,) = rk.plot.panels(height=3.6)
    rk.plot.schematic(ax)
    return figure
