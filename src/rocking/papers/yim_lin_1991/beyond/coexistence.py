"""Responses that coexist, and how finely their basins are mixed.

Basins of attraction over initial states (Θ, Θ') at A = 5.5, T = 0.5, e = 0.925, which are those of figure 2c, and φ = 0. Periodic
responses of several periods coexist with overturning; the initial state alone selects one of them. The title gives the uncertainty
exponents of the boundaries, with their 95 % intervals: of the boundaries between all that are drawn, and of the boundary of overturning
alone. If the initial state is uncertain by ε, the fraction of states whose response is uncertain is proportional to ε to the power
of the exponent. The exponent is 1 for a smooth boundary, and less for a fractal one.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk

SYSTEM = rk.System(rk.Harmonic(amplitude=5.5, period=0.5), restitution=0.925)
COUNT = 240


def draw() -> Figure:
    """Draw the basins."""
    axis = np.linspace(-1.0, 1.0, COUNT)
    found = rk.basin_map(SYSTEM, angle=axis, velocity=axis, boundary_runs=20_000)
    figure, (ax,) = rk.plot.panels(height=4.4)
    rk.plot.basins(found, ax)
    rk.plot.title(
        ax,
        f"uncertainty exponent\nof all boundaries: {found.attractor_exponent}\nof overturning: {found.uncertainty_exponent}",
    )
    return figure
