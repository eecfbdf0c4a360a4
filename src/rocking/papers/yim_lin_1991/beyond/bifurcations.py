"""Bifurcation curves of orbits up to period 3 over the map of figure 11, e = 0.925.

(a) The map, and all curves that a search on a grid of 12 × 12 points finds above A = 1.3. (b) A part of it. Each curve
is followed by continuation, independently of the map. The line is thinner for period 2, and thinnest for period 3.
Marks show points of codimension two. A dot marks such a point at a grazing. Above the symmetry breaking of period 1 the
response from rest is no longer symmetric. Many curves leave no trace in the map: there a block that starts from rest
reaches another attractor. The lower edge of the region of period 3 is no bifurcation. Its orbit stays stable below, but
a block from rest no longer reaches it.
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991 import cached_surveys

PERIODS, AMPLITUDES = (0.2, 3.0), (1.3, 16.0)
MAX_PERIOD, GRID = 3, 12
PART = (0.2, 2.0), (1.3, 5.0)


def draw() -> Figure:
    """Draw the curves over the map, and a part of it."""
    shown = cached_surveys.damped()
    system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    found = rk.bifurcation_set(system, MAX_PERIOD, grid=GRID, period=PERIODS, amplitude=AMPLITUDES)
    figure, axes = rk.plot.panels(columns=2, height=5.0)
    for ax in axes:
        rk.plot.parametric_map(shown, ax)
        rk.plot.bifurcation_set(found, ax)
    whole, part = axes
    part.get_legend().remove()  # it is that of the whole
    rk.plot.title(whole, f"{len(found.curves)} curves")
    part.set_xlim(*PART[0])
    part.set_ylim(*PART[1])
    rk.plot.title(part, "a part of it")
    return figure
