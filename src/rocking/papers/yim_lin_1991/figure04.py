"""Figure 4: overturning from rest, A = 1.75, T = 2, e = 0.95, φ = 0: (a) time history, (b) phase portrait.

After four impacts, in the sixth cycle, overturning is certain. The motion is shown up to Θ = −1.6. Dotted lines in
(a) mark the critical angle, arrows in (b) the direction of motion.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991.cases import OVERTURNING
from rocking.papers.yim_lin_1991.history_and_portrait import draw_pair

LOWEST = -1.6


def draw() -> Figure:
    """Draw figure 4."""
    figure = draw_pair(OVERTURNING, arrows=(0.9, 2.4, 4.2, 5.8), legend=True)
    left, right = figure.axes
    left.set_ylim(LOWEST, 1.2)
    right.set(xlim=(LOWEST, 1.2), ylim=(-1.7, 1.7))
    return figure
