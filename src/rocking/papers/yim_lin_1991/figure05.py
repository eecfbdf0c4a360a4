"""Figure 5: quasi-periodic response from rest, A = 4, T = 0.4, e = 1: (a) time history, (b) phase portrait.

The motion, from φ = 0, turns about the three points of a symmetric (1, 3) mode. It has no transient, because an
undamped motion has none: (a) shows the first 60 cycles, (b) the first 21. Orange marks are impacts, at which the
velocity does not change because e = 1. The arrow gives the direction of motion.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991.cases import QUASI_PERIODIC
from rocking.papers.yim_lin_1991.history_and_portrait import draw_pair


def draw() -> Figure:
    """Draw figure 5."""
    return draw_pair(QUASI_PERIODIC, history=(0, 60), portrait=(0, 21), arrows=(16.93,))
