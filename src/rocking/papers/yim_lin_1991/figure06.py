"""Figure 6: chaotic response, A = 2, T = 0.4, e = 1, from rest with φ = 0: (a) time history, (b) phase diagram.

Ours shows 60 cycles of the time history and 300 of the phase diagram, from the start. Neighbouring motions part by a
factor e in some eight cycles, so after about 300 the sequence is that of our rounding, and only its statistics are
those of the paper.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991.cases import CHAOTIC
from rocking.papers.yim_lin_1991.pair import draw_pair


def draw() -> Figure:
    """Draws figure 6."""
    return draw_pair(CHAOTIC, history=(0, 60), portrait=(0, 300))
