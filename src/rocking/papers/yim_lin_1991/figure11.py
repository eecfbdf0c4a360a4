"""Figure 11: what the response from rest is over period and amplitude, e = 0.925, with what theory says of it.

The curves are A_SB, up to which the (1,1) and the (1,3) mode are stable, and A_M, from which Melnikov's function has zeros, both
in closed form. Dots continue a curve where its mode is not there to lose its stability: the closed form has it, but the block
would not keep its side for the half cycle. The paper's axes are not known; ours are T 0.2 to 3 and A 0 to 16, as in all our maps.

Where ours differs: the paper takes the curve of the (1,3) mode for its upper bound throughout. Where it is dotted, below T = 0.8 or
so, the mode ends at a smaller amplitude, in a grazing impact. Beyond the curve of the (1,1) mode most points overturn; nearly all
others have period 1 and are unsymmetric. And A_M is no bound on chaos: above it lies most of the map, and next to none of it is
chaotic (see figure 12).
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991 import cached_surveys
from rocking.papers.yim_lin_1991.map_layout import draw_map

CURVES = ("symmetry-breaking-1", "symmetry-breaking-3", "melnikov")


def draw() -> Figure:
    """Draws figure 11."""
    return draw_map(cached_surveys.damped(), "11", "$e = 0.925$", CURVES)
