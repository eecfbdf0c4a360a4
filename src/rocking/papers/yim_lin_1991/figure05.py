"""Figure 5: quasi-periodic response, A = 4, T = 0.4, e = 1, from rest with φ = 0: (a) time history, (b) phase diagram.

It winds around the three points of a symmetric (1, 3) mode. Without losses no part of it is transient: ours shows 60
cycles of the time history and 120 of the phase diagram, from the start. An impact with e = 1 changes no velocity, so
the marks before and after it coincide.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991.cases import QUASI_PERIODIC
from rocking.papers.yim_lin_1991.history_and_portrait import draw_pair


def draw() -> Figure:
    """Draws figure 5."""
    return draw_pair(QUASI_PERIODIC, history=(0, 60), portrait=(0, 120))
