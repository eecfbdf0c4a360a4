"""Figure 6: chaotic response, A = 2, T = 0.4, e = 1, from rest with φ = 0: (a) time history, (b) phase diagram.

Ours shows 60 cycles of the time history and 120 of the phase diagram, from the start. Neighbouring motions part by a
factor e in some seven cycles: these 120 do not yet depend on rounding, cycles after about 250 would.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991.cases import CHAOTIC
from rocking.papers.yim_lin_1991.history_and_portrait import draw_pair


def draw() -> Figure:
    """Draws figure 6."""
    return draw_pair(CHAOTIC, history=(0, 60), portrait=(0, 120))
