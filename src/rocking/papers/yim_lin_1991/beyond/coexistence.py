"""Responses that coexist, and how finely their starts are mixed.

What comes of starts (Θ, Θ') at A = 5.5, T = 0.5, e = 0.925, figure 2c's system: periodic responses of several periods, among which the
start alone decides, and overturning. The exponent says how slowly the uncertain starts thin out as one aims better: 1 for a smooth
boundary, less for a fractal one.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk

SYSTEM = rk.System(rk.Harmonic(amplitude=5.5, period=0.5), restitution=0.925)
COUNT = 240


def draw() -> Figure:
    """Draws the basins."""
    axis = np.linspace(-1.0, 1.0, COUNT)
    found = rk.basin_map(SYSTEM, angle=axis, velocity=axis, boundary_runs=20_000)
    figure, (ax,) = rk.plot.panels(height=4.4)
    rk.plot.basins(found, ax)
    return figure
