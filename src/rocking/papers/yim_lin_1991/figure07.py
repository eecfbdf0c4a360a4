"""Figure 7: Poincaré maps of (a) the (1, 3) mode, (b) the quasi-periodic and (c) the chaotic response.

Parameters: (a) A = 6.5, T = 0.4, e = 0.925. (b) A = 4, T = 0.4, e = 1. (c) A = 2, T = 0.4, e = 1. All start from rest
with φ = 0. The section lies at the forcing phase ψ = 0, just after any event at that instant. (a) shows 12 cycles
after a transient of 600: three points, four times each. (b) shows 3·10⁴ and (c) 10⁵ cycles from the start, because an
undamped motion has no transient.

Difference from the paper: the paper says that (b) forms three tori and (c) a strange attractor. The three closed
curves, visited in turn, are the intersections of one torus with the section. Undamped motions conserve area, so that
nothing attracts. Panel (c) is a chaotic sea around islands. The paper gives neither the phase of its sections nor the
number of points.
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import CHAOTIC, PERIODIC, QUASI_PERIODIC

SHOWN = ((PERIODIC[1], (600, 612)), (QUASI_PERIODIC, (0, 30_000)), (CHAOTIC, (0, 100_000)))


def draw() -> Figure:
    """Draw figure 7."""
    figure, axes = rk.plot.panels(rows=3, height=2.8)
    for ax, (case, shown) in zip(axes, SHOWN, strict=True):
        motion = rk.simulate(case.system, case.start, cycles=shown[1], record="section")
        rk.plot.section(motion, ax, transient=shown[0] + 1)
        rk.plot.title(ax, case.name)
    return figure
