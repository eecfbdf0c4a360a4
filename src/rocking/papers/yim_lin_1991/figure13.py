"""Figure 13a: Poincaré map of the chaotic response between braces, A = 15, T = 2, e = 0.925, from rest with φ = 0.

Braces stand at the critical angle, Θb = 1, and return the block elastically, r = 1. Ours shows 10⁵ cycles, after 1,000
that are left out, at the forcing phase 0, just after any event at that instant. The paper gives neither the phase of
its section nor the number of its points.
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import BRACED

TRANSIENT, POINTS = 1_000, 100_000


def draw() -> Figure:
    """Draws figure 13a."""
    motion = rk.simulate(BRACED, cycles=TRANSIENT + POINTS - 1, record="section")
    figure, (ax,) = rk.plot.panels(height=3.2)
    rk.plot.section(motion, ax, transient=TRANSIENT)
    rk.plot.title(ax, "(a) $A = 15$, $T = 2$, $e = 0.925$\nbraces at 1, $r = 1$")
    return figure
