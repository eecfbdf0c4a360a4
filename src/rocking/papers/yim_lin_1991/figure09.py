"""Figure 9: the heteroclinic orbits of the free, undamped block between its unstable equilibria Θ = ±1, eq. 17.

Ours is drawn from the closed form, with some of the closed orbits inside and the way the pair is run through. Each orbit takes two
formulas because the acceleration jumps at Θ = 0; angle and velocity do not, as long as there are no losses.
"""

from matplotlib.figure import Figure

import rocking as rk


def draw() -> Figure:
    """Draws figure 9."""
    figure, (ax,) = rk.plot.panels(height=3.2)
    rk.plot.heteroclinic(ax)
    return figure
