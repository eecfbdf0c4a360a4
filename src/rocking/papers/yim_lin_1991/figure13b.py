"""Figure 13b: response of a block initially at rest between braces over period and amplitude, e = 0.925, r = 1.

The braces stand at the critical angle, Θb = 1. (a) 50 × 50 points, with the fraction of each type of response. (b)
The symbols of the paper at 25 × 25 of these points; a dot is a response that the paper's legend lacks. The paper's
axes are not known; here T runs from 0.2 to 3 and A from 0 to 16. Points are simulated for up to 10⁵ cycles, because
motions between braces count as chaotic only then. Most motions that appear chaotic for a thousand cycles become
periodic later.

Difference from the paper: the paper's legend has no symbol for asymmetric responses of odd period, which fill much of
the map. Here they have the symbol of their period. Chaos does not dominate where brace impacts are frequent: chaotic
points are few even there.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991 import cached_surveys
from rocking.papers.yim_lin_1991.map_layout import draw_map


def draw() -> Figure:
    """Draw figure 13b."""
    return draw_map(cached_surveys.braced(), "13b")
