"""Figure 3: phase portraits of the three periodic responses of figure 2, in the same cycles.

At each impact the velocity changes at Θ = 0 from the ring to the dot, by the factor e = 0.925 (Eq. (2)). Arrows give
the direction of motion. The scale of (c) differs from the scale of (a) and (b).
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import PERIODIC
from rocking.papers.yim_lin_1991.history_and_portrait import draw_arrow

LIMITS = ((0.1, 0.8), (0.1, 0.8), (0.3, 1.1))
# Cycles after the first one shown at which an arrow stands.
ARROWS = ((0.0, 0.5), (0.0, 1.5), (1.5, 6.5))


def draw() -> Figure:
    """Draw figure 3."""
    figure, axes = rk.plot.panels(rows=3, height=2.9)
    for ax, case, (width, height), arrows in zip(axes, PERIODIC, LIMITS, ARROWS, strict=True):
        motion = case.motion()
        rk.plot.phase_portrait(motion, ax, cycles=case.shown)
        for cycle in arrows:
            draw_arrow(ax, motion, case.shown[0] + cycle)
        rk.plot.title(ax, case.name)
        ax.set(xlim=(-width, width), ylim=(-height, height))
    return figure
