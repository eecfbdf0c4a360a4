"""Figure 10: what the response from rest is over period and amplitude, e = 1: quasi-periodic, chaotic, none, overturning.

The paper's axes are not known; ours are T 0.2 to 3 and A 0 to 16, as in all our maps, each point followed for at most 10⁴ cycles.

Where ours differs: the paper takes what it shows for the absence of stable periodic response. The quasi-periodic motions are the
islands around periodic ones that are neutrally stable, as in figure 5. Four fifths of this map overturn, and chaos is a few
percent. Both names hold for the cycles that were followed. Some points stay undetermined: their motions stick to the islands'
edges for longer than they were followed.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991 import cached_surveys
from rocking.papers.yim_lin_1991.map_layout import draw_map


def draw() -> Figure:
    """Draws figure 10."""
    return draw_map(cached_surveys.undamped(), "10", "$e = 1$")
