"""Figure 2: time histories of three periodic responses, e = 0.925.

(a) A = 2, T = 1: (1, 1) mode, symmetric, 2 impacts per cycle. (b) A = 6.5, T = 0.4: (1, 3) mode, symmetric, 2 impacts
per 3 cycles. (c) A = 5.5, T = 0.5, from Θ' = 0.15 with forcing phase φ = 1.8: period 10, asymmetric, 4 impacts per 10
cycles. The responses (a) and (b) start from rest with φ = 0. Transients are omitted: (a) shows cycles 200 to 210, (b)
600 to 624 and (c) 600 to 630. The scale of (c) differs from the scale of (a) and (b).

Difference from the paper: its caption gives the initial state of (c) as (θ, φ) = (0.15, 1.8). The caption of figure 3
has (θ̇, φ). Here 0.15 is the initial velocity. An initial angle of 0.15 leads to a symmetric response of period 7.
The paper calls (c) a (1, 10) mode. It has four impacts, hence two rocking cycles, in ten forcing cycles: a (2, 10)
mode.
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import PERIODIC

HEIGHTS = (0.1, 0.1, 0.3)


def draw() -> Figure:
    """Draw figure 2."""
    figure, axes = rk.plot.panels(rows=3, height=2.2)
    for ax, case, height in zip(axes, PERIODIC, HEIGHTS, strict=True):
        rk.plot.time_history(case.motion(), ax, cycles=case.shown)
        rk.plot.title(ax, case.name)
        ax.set_ylim(-height, height)
    return figure
