"""Figure 2: time histories of three periodic responses, e = 0.925.

(a) A = 2, T = 1: mode (1, 1), symmetric, 2 impacts per cycle. (b) A = 6.5, T = 0.4: mode (1, 3), symmetric, 2 impacts
per 3 cycles. (c) A = 5.5, T = 0.5 from Θ' = 0.15 with forcing phase φ = 1.8: period 10, unsymmetric, 4 impacts per
10 cycles. The first two start at rest with φ = 0. All three are shown once the transient is gone: (a) from cycle 200,
(b) and (c) from cycle 600.

Where ours differs: the paper's caption gives the start of (c) as (θ, φ) = (0.15, 1.8), that of figure 3 as (θ̇, φ). We
read it as the velocity; as an angle it leads to a symmetric response of period 7. The paper calls (c) a (1, 10) mode;
it has four impacts, so two rocking cycles, in ten of the forcing: (2, 10).
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import PERIODIC


def draw() -> Figure:
    """Draws figure 2."""
    figure, axes = rk.plot.panels(rows=3, height=2.3)
    for ax, case in zip(axes, PERIODIC, strict=True):
        rk.plot.time_history(case.motion(), ax, cycles=case.shown)
        rk.plot.title(ax, case.title)
    return figure
