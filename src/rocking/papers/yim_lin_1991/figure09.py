"""Figure 9: heteroclinic orbits of the free, undamped block between its unstable equilibria Θ = ±1, Eq. (17).

The orbits are drawn from the closed form. Some of the closed orbits inside are shown; arrows give the direction of
motion. Each heteroclinic orbit takes two formulas because the acceleration jumps at Θ = 0. Angle and velocity are
continuous, because nothing is dissipated.
"""

from matplotlib.figure import Figure

import rocking as rk


def draw() -> Figure:
    """Draw figure 9."""
    figure, (ax,) = rk.plot.panels(height=3.2)
    rk.plot.heteroclinic(ax)
    return figure
