"""Figure 7: Poincaré maps of (a) the (1, 3) mode, (b) the quasi-periodic and (c) the chaotic response.

(a) A = 6.5, T = 0.4, e = 0.925; (b) A = 4, T = 0.4, e = 1; (c) A = 2, T = 0.4, e = 1; from rest with φ = 0, at the forcing
phase 0, just after any event at that instant. Ours shows (a) 12 cycles after 600 that are left out: three points, four
times each; (b) 3·10⁴ and (c) 10⁵ cycles, from the start, for without losses nothing is transient.

Where ours differs: the paper says that (b) forms three tori and (c) a strange attractor. On a Poincaré map a torus is a closed
curve: there are three, visited in turn. Without losses areas are kept, so that nothing attracts: (c) is a chaotic sea
with islands that it does not enter. The paper gives neither the phase of its sections nor the number of points.
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import CHAOTIC, PERIODIC, QUASI_PERIODIC, cycles

SHOWN = ((PERIODIC[1], (600, 612)), (QUASI_PERIODIC, (0, 30_000)), (CHAOTIC, (0, 100_000)))


def draw() -> Figure:
    """Draws figure 7."""
    figure, axes = rk.plot.panels(rows=3, height=2.9)
    for ax, (case, shown) in zip(axes, SHOWN, strict=True):
        motion = rk.simulate(case.system, case.start, cycles=shown[1], record="section")
        rk.plot.section(motion, ax, transient=shown[0] + 1)
        rk.plot.title(ax, f"{case.name}, {cycles(shown)}\n{case.parameters}")
    return figure
