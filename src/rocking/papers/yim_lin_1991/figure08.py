"""Figure 8: power spectral densities of the three responses of figure 7.

Welch averages of exact samples of Θ over 8,192 cycles, in segments of an eighth of that. (a) has 8,190 cycles after a
transient of 600, so that segments hold whole responses. The spectra are shown up to three times the forcing frequency
f; dotted lines mark f, 2f and 3f. (a) (1, 3) mode: all lines are odd multiples of f/3, because the response is
symmetric. (b) Quasi-periodic response: all lines are combinations of f/3 and of the rotation frequency f_r =
0.17519497 f, which is (1 − 0.4744150886)/3. It is the frequency of the motion about the centre of the island. (c)
Chaotic response: a broad band, with a line at the forcing frequency.

Difference from the paper: the paper states a single dominant frequency for (a). The line at f/3 is the strongest, but
the line at f has three eighths of its variance. The paper gives neither units nor the length of its records.
"""

from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.yim_lin_1991.cases import CHAOTIC, PERIODIC, QUASI_PERIODIC

SHOWN = ((PERIODIC[1], 600, 8_190), (QUASI_PERIODIC, 0, 8_192), (CHAOTIC, 0, 8_192))


def draw() -> Figure:
    """Draw figure 8."""
    figure, axes = rk.plot.panels(rows=3, height=2.7)
    for ax, (case, transient, length) in zip(axes, SHOWN, strict=True):
        motion = rk.simulate(case.system, case.start, cycles=transient + length)
        rk.plot.spectrum(rk.spectral_density(motion, transient=transient), ax)
        rk.plot.title(ax, case.name)
    lows, highs = zip(*(ax.get_ylim() for ax in axes), strict=True)
    for ax in axes:
        ax.set_ylim(min(lows), max(highs))
    return figure
