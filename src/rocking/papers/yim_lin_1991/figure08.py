"""Figure 8: spectral densities of (a) the (1, 3) mode, (b) the quasi-periodic and (c) the chaotic response of figure 7.

Ours are Welch's averages over exact samples of Θ from 8,192 cycles (8,190 in (a), after 600 that are left out, so that
segments hold whole responses), in segments of an eighth of that. (a) The lines are odd multiples of f/3, a third of
the forcing frequency, and no others: the response is symmetric. (b) All lines are combinations of f/3 and of one
rotation frequency, f_r = 0.17519497 f, which is (1 − 0.4744150886)/3: the motion about the island's centre. (c) A broad
band, out of which the line of the forcing rises.

Where ours differs: the paper speaks of a single dominant frequency in (a). The strongest line is that of f/3; f has three
eighths of its variance. It gives neither units nor the length of its records.
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import CHAOTIC, PERIODIC, QUASI_PERIODIC

SHOWN = ((PERIODIC[1], 600, 8_190), (QUASI_PERIODIC, 0, 8_192), (CHAOTIC, 0, 8_192))


def draw() -> Figure:
    """Draws figure 8."""
    figure, axes = rk.plot.panels(rows=3, height=2.6)
    for ax, (case, transient, length) in zip(axes, SHOWN, strict=True):
        motion = rk.simulate(case.system, case.start, cycles=transient + length)
        rk.plot.spectrum(rk.spectral_density(motion, transient=transient), ax)
        rk.plot.title(ax, f"{case.name}, {case.parameters}")
    return figure
