"""Figure 6: chaotic response from rest, A = 2, T = 0.4, e = 1, φ = 0: (a) time history, (b) phase portrait.

(a) shows the first 60 cycles, (b) the first 30. Orange marks are impacts, at which the velocity does not change
because e = 1. The arrow gives the direction of motion. Nearby trajectories diverge by a factor of 2.7 in some seven
cycles: the cycles shown do not depend on rounding, cycles after about 250 do.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991.cases import CHAOTIC
from rocking.papers.yim_lin_1991.history_and_portrait import draw_pair


def draw() -> Figure:
    """Draw figure 6."""
    return draw_pair(CHAOTIC, history=(0, 60), portrait=(0, 30), arrows=(5.49,))
