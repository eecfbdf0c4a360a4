"""Figure 5: wrong verdicts of integration in fixed steps, over the number of steps between two samples of the record.

Classical Runge–Kutta method of fourth order against the exact motion. The block has R = 1 m and θcr = 0.15. Four
synthetic motions have samples every 0.02 s, and 150 scales each, PGA/(gθcr) from 1.05 to 4. Only certified verdicts are
counted. Bars are 95 % intervals. Impacts are placed at the end of a step, as simple programs do, or within it by linear interpolation.
The end of each run is judged by the exact condition. Twenty times as many steps do not remove the error: the motion is
chaotic, and small errors grow from impact to impact.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.pulses_and_earthquakes import records
from rocking.papers.pulses_and_earthquakes.axes import FIRST, SECOND, finish


def draw() -> Figure:
    """Draw the shares of wrong verdicts."""
    figure, (ax,) = rk.plot.panels(height=3.0)
    wrong = records.wrong_verdicts()
    for shares, colour, name, shift in (
        (wrong.at_end, SECOND, "impact at the step's end", 0.97),
        (wrong.interpolated, FIRST, "impact interpolated", 1.03),
    ):
        middle = np.array([100 * share.value for share in shares])
        ends = np.array([[100 * share.low, 100 * share.high] for share in shares]).T
        ax.errorbar(
            shift * np.array(records.SUBSTEPS),
            middle,
            np.abs(ends - middle),
            fmt="o-",
            ms=4,
            lw=0.9,
            capsize=2,
            color=colour,
            label=name,
        )
    ax.set_xscale("log")
    ax.set_xticks(records.SUBSTEPS, [str(number) for number in records.SUBSTEPS])
    ax.minorticks_off()
    ax.set_ylim(0.0, None)
    finish(ax, "steps between two samples", "wrong verdicts (%)", columns=1)
    return figure
