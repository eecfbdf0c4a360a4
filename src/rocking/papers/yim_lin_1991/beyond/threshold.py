"""Exact tangency amplitude A* and Melnikov's amplitude A_M over the period, e = 0.5, 0.8 and 0.925.

A* is the amplitude at which the manifolds of the two saddle orbits touch, in closed form. A_M of Eq. (22) is its
first-order approximation in A and 1 − e. A_M is too low for slow forcing and too high for fast forcing; A_M and A*
agree in the limit e → 1. Colour distinguishes A* and A_M, the dash the coefficient of restitution.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk

PERIODS = np.linspace(0.2, 3.0, 561)
RESTITUTIONS = (0.5, 0.8, 0.925)


def draw() -> Figure:
    """Draw A* and A_M over the period."""
    figure, (ax,) = rk.plot.panels(height=3.4)
    curves = {}
    for e in RESTITUTIONS:
        curves[f"$A^*$, $e = {e:g}$"] = rk.theory.heteroclinic_amplitude(PERIODS, e)
        curves[f"$A_M$, $e = {e:g}$"] = rk.theory.melnikov_amplitude(PERIODS, e)
    rk.plot.thresholds(PERIODS, curves, ax)
    ax.set(xlim=(PERIODS[0], PERIODS[-1]), ylim=(0.0, 16.0))
    return figure
