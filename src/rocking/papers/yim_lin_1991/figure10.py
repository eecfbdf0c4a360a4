"""Figure 10: response of a block initially at rest as a function of period and amplitude, e = 1.

(a) 160 × 160 points, with the fraction of each type of response; each point is simulated for at most 10⁴ cycles. (b)
The symbols of the paper at 27 × 27 of these points; a dot is a type of response that the paper's legend lacks. The
paper's axes are not known; here T runs from 0.2 to 3 and A from 0 to 16.

Difference from the paper: the paper takes this map as evidence that no stable periodic response exists. The
quasi-periodic motions lie on islands around periodic ones that are neutrally stable, as in figure 5. Four fifths of
the map overturn, and a few per cent are chaotic. Both types, quasi-periodic and chaotic, refer to the cycles
simulated. Undetermined motions stay near the edges of islands for longer than that.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991 import cached_surveys
from rocking.papers.yim_lin_1991.map_layout import draw_map


def draw() -> Figure:
    """Draw figure 10."""
    return draw_map(cached_surveys.undamped(), "10")
