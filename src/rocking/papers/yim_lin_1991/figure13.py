"""Figure 13a: Poincaré map of the chaotic response between braces, A = 15, T = 2, e = 0.925, from rest.

The braces stand at the critical angle, Θb = 1, and are perfectly elastic, r = 1. The section lies at the forcing
phase ψ = 0, just after any event at that instant. The map shows 10⁵ cycles after a transient of 1,000. The motion
starts with φ = 0. The paper gives neither the phase of its section nor the number of its points.
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import BRACED

TRANSIENT, POINTS = 1_000, 100_000


def draw() -> Figure:
    """Draw figure 13a."""
    motion = rk.simulate(BRACED, cycles=TRANSIENT + POINTS - 1, record="section")
    figure, (ax,) = rk.plot.panels(height=3.2)
    rk.plot.section(motion, ax, transient=TRANSIENT)
    return figure
