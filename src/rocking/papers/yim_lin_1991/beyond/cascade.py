"""The period doublings behind a chaotic response, T = 1.721328, e = 0.8.

(a) The symmetric response loses its symmetry at A = 7.333, which theory has in closed form, and doubles its period from A = 10.47 on.
(b) Its end: doublings ever closer, chaos, and from A = 10.75 or so on the block overturns. (c) Beside it, from rest, another response
of period 3 that doubles its period and becomes chaotic by A = 10.10; by A = 10.11 it is gone.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk

SYSTEM = rk.System(rk.Harmonic(amplitude=9.0, period=1.721328), restitution=0.8)
RANGES = ((6.5, 10.8, "both"), (10.4, 10.76, "up"), (10.04, 10.115, "rest"))


def draw() -> Figure:
    """Draws the orbit diagram in three parts."""
    figure, axes = rk.plot.panels(rows=3, height=2.6)
    for ax, (low, high, sweep) in zip(axes, RANGES, strict=True):
        found = rk.orbit_diagram(
            SYSTEM, "amplitude", np.linspace(low, high, 500), sweep=sweep, transient=600, cycles=120
        )
        rk.plot.orbit_diagram(found, ax)
        rk.plot.title(ax, f"$A = {low:g}$ to ${high:g}$" + (", each from rest" if sweep == "rest" else ""))
    return figure
