"""Figure 12: stability bound A_SB of the (1, 1) mode and Melnikov's amplitude A_M, e = 0.8 and 0.9.

The (1, 1) mode is stable below A_SB, where its symmetry breaks. Melnikov's function has zeros above A_M (Eq. (22)).
Both are closed forms; colour distinguishes the amplitudes, the dash the coefficient of restitution. The paper's axes
are not known; here T runs from 0.2 to 3 and A from 0 to 16.

Difference from the paper: the paper takes A_M as a lower bound for chaotic responses. It regards chaos as likely
between the curves, in a region that grows with e. A_M is the first-order approximation of the amplitude A* at which
the manifolds of the saddle orbits touch. It lies below A* for slow forcing and above it for fast forcing.
Intersecting manifolds make the boundary of overturning fractal; they do not make bounded motions chaotic.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk

PERIODS = np.linspace(0.2, 3.0, 561)
AMPLITUDES = (0.0, 16.0)
RESTITUTIONS = (0.8, 0.9)


def draw() -> Figure:
    """Draw figure 12."""
    figure, (ax,) = rk.plot.panels(height=3.4)
    curves = {}
    for e in RESTITUTIONS:
        curves[f"$A_{{SB}}$, $e = {e:g}$"] = rk.theory.symmetry_breaking_amplitude(PERIODS, e, 1)
        curves[f"$A_M$, $e = {e:g}$"] = rk.theory.melnikov_amplitude(PERIODS, e)
    rk.plot.thresholds(PERIODS, curves, ax)
    ax.set(xlim=(PERIODS[0], PERIODS[-1]), ylim=AMPLITUDES)
    # A_M has the same colour as in the figure of the exact threshold, A_SB a colour of its own
    for line in (*ax.lines, *ax.get_legend().legend_handles):
        if "SB" in str(line.get_label()):
            line.set_color(rk.plot.palette.SERIES[2])
    return figure
