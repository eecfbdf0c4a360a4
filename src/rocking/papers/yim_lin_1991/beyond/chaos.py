"""Fraction of chaotic responses among random periods and amplitudes, over the coefficient of restitution e.

Responses from rest, T from 0.2 to 3, A from 0 to 16, n = 400 systems for each e, with 95 % intervals. The paper found
chaotic responses only for e above 0.95. Here about every fifth system is chaotic at e = 0.2. The fraction decreases
as e grows to 0.8. Hollow marks with one-sided intervals: no chaotic system was found at e = 0.8, 0.9, 0.925, 0.95 and
0.97. The decrease does not continue to the end: a few systems are chaotic at e = 1.
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991 import cached_surveys


def draw() -> Figure:
    """Draw the fraction over e."""
    figure, (ax,) = rk.plot.panels(height=3.0)
    rk.plot.chaos_share(cached_surveys.chaos(), ax)
    return figure
