"""Figure 4: overturning, A = 1.75, T = 2, e = 0.95, from rest with φ = 0: (a) time history, (b) phase diagram.

After four impacts, in its sixth cycle, the block is past return. Ours follows it to three times the critical angle.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991.cases import OVERTURNING
from rocking.papers.yim_lin_1991.history_and_portrait import draw_pair


def draw() -> Figure:
    """Draws figure 4."""
    return draw_pair(OVERTURNING)
