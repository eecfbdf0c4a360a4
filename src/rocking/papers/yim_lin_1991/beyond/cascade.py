"""Period doubling to chaos over the amplitude, T = 1.721328, e = 0.8.

(a) The symmetric orbit loses its symmetry at A = 7.333, as the closed form predicts. Two asymmetric orbits, mirror
images of each other, branch off: the sweep up follows one of them, the sweep down the other. Period doubling begins
at A = 10.47. (b) End of the cascade: period doublings at ever smaller distances, then chaos. Above A = 10.75 or so
the block overturns. (c) Responses from rest: another orbit, of period 3, doubles its period and becomes chaotic by A
= 10.10. By A = 10.11 it has disappeared. Bars at the bottom mark overturning.
"""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FormatStrFormatter

import rocking as rk

SYSTEM = rk.System(rk.Harmonic(amplitude=9.0, period=1.721328), restitution=0.8)
RANGES = (
    (6.5, 10.8, "both", "sweeps up and down"),
    (10.4, 10.76, "up", "sweep up"),
    (10.04, 10.115, "rest", "from rest"),
)


def draw() -> Figure:
    """Draw the orbit diagram in three parts."""
    figure, axes = rk.plot.panels(rows=3, height=2.6)
    for ax, (low, high, sweep, name) in zip(axes, RANGES, strict=True):
        found = rk.orbit_diagram(
            SYSTEM, amplitude=np.linspace(low, high, 500), sweep=sweep, transient=600, cycles=120
        )
        rk.plot.orbit_diagram(found, ax)
        rk.plot.title(ax, name)
        ax.yaxis.set_major_formatter(FormatStrFormatter("%.2f"))
        if sweep != "both":
            ax.get_legend().remove()
    return figure
