"""Figure 12: up to where the symmetric (1,1) mode is stable, and from where Melnikov's function has zeros, e = 0.8 and 0.9.

Ours are A_SB, where symmetry breaks, and A_M of eq. 22 in closed form. The paper's axes are not known; ours are those of our maps.

Where ours differs: the paper takes A_M for a lower bound for chaotic response, and the region between the curves, which grows
with e, for the one where chaos is likely. A_M is the first order of the amplitude A* at which the manifolds of the saddle orbits
touch (below A* for slow forcing, above it for fast). Crossing manifolds make the boundary of what overturns fractal; they make no
motion chaotic that stays.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk

PERIODS = np.linspace(0.2, 3.0, 561)
AMPLITUDES = (0.0, 16.0)


def draw() -> Figure:
    """Draws figure 12."""
    figure, (ax,) = rk.plot.panels(height=3.4)
    breaking = {
        f"(1,1) stable below $A_{{SB}}$, $e = {e:g}$": rk.theory.symmetry_breaking_amplitude(PERIODS, e, 1)
        for e in (0.8, 0.9)
    }
    zeros = {f"$A_M$, $e = {e:g}$": rk.theory.melnikov_amplitude(PERIODS, e) for e in (0.8, 0.9)}
    rk.plot.thresholds(PERIODS, breaking | zeros, ax)
    ax.set(xlim=(PERIODS[0], PERIODS[-1]), ylim=AMPLITUDES)
    return figure
