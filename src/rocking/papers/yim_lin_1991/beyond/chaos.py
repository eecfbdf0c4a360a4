"""Chaos grows as the losses do: its share among random periods and amplitudes, over the restitution.

From rest, T 0.2 to 3, A 0 to 16, with 95 % intervals. The paper found chaotic responses only for e above 0.95. At e = 0.2 it is
about every fifth system; the chaos lies in a band between period doublings and overturning, for which weak impacts leave no room.
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991 import surveys


def draw() -> Figure:
    """Draws the share over e."""
    figure, (ax,) = rk.plot.panels(height=3.0)
    rk.plot.chaos_share(surveys.chaos(), ax)
    return figure
