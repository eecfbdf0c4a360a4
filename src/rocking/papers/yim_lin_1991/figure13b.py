"""Figure 13b: what the response from rest is over period and amplitude between braces, e = 0.925, Θb = 1, r = 1.

The paper's axes are not known; ours are T 0.2 to 3 and A 0 to 16, as in all our maps. Points that stay open are followed for
10⁵ cycles, before which a motion between braces is not called chaotic: most of those that look so for a thousand cycles are
on their way to a periodic one.

Where ours differs: nothing in the paper's legend stands for what is unsymmetric though its period is odd, which is much of the
map; here it has the symbol of its period. Chaos does not dominate where the block hits its braces often: chaotic points are few
even there.
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991 import cached_surveys
from rocking.papers.yim_lin_1991.map_layout import draw_map


def draw() -> Figure:
    """Draws figure 13b."""
    return draw_map(cached_surveys.braced(), "13b", r"braces at 1, $r = 1$, $e = 0.925$")
