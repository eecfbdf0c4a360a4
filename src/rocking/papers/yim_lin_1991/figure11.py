"""Figure 11: response of a block from rest over period and amplitude, e = 0.925, with stability boundaries.

(a) 400 × 400 points, with the fraction of each type of response; types below 0.01 % are not listed. (b) The symbols
of the paper at 29 × 29 of these points; a dot is a response that the paper's legend lacks. The curves are closed
forms. The (1, 1) and the (1, 3) mode are stable up to A_SB; Melnikov's function has zeros above A_M. A curve is
dotted where the closed-form mode is inadmissible: it would pass through Θ = 0 within the half-cycle. The paper's axes
are not known; here T runs from 0.2 to 3 and A from 0 to 16.

Difference from the paper: the paper takes the curve of the (1, 3) mode as its upper bound throughout. Where the curve
is dotted, below T = 0.8 or so, the mode ends at a smaller amplitude, in a grazing impact. Beyond the curve of the (1,
1) mode most points overturn; nearly all others have period 1 and are asymmetric. A_M is not a lower bound for chaos:
most of the map lies above it, and almost none of that is chaotic (see figure 12).
"""

from matplotlib.figure import Figure

from rocking.papers.yim_lin_1991 import cached_surveys
from rocking.papers.yim_lin_1991.map_layout import draw_map

CURVES = ("symmetry-breaking-1", "symmetry-breaking-3", "melnikov")


def draw() -> Figure:
    """Draw figure 11."""
    return draw_map(cached_surveys.damped(), "11", CURVES)
