"""Figure 3: phase diagrams of the three periodic responses of figure 2, in the same cycles.

Ours marks every impact: the velocity falls at Θ = 0 from the open to the full mark, by e = 0.925 (eq. 2).
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import PERIODIC


def draw() -> Figure:
    """Draws figure 3."""
    figure, axes = rk.plot.panels(rows=3, height=3.0)
    for ax, case in zip(axes, PERIODIC, strict=True):
        rk.plot.phase_portrait(case.motion(), ax, cycles=case.shown)
        rk.plot.title(ax, case.title)
    return figure
