"""Figure 4: scales that overturn a block under a recorded motion: not one threshold, but a fractal set.

R = 1 m, θcr = 0.25, Housner's coefficient of restitution; the record is that of figure 3. (a) Largest angle over
PGA/(gθcr), 10,001 scales; a bar at the upper edge marks a scale at which the block overturns. (b) Number of switches
between standing and overturning along the range of (a), over the step between two scales. It grows at all steps, down
to the smallest one. The dashed line has the slope of a set in which each halving of the step doubles the number.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.pulses_and_earthquakes import records
from rocking.papers.pulses_and_earthquakes.axes import FIRST, INK, SECOND, finish

TOP = 1.06


def draw() -> Figure:
    """Draw the angles and the number of switches."""
    figure, (left, right) = rk.plot.panels(columns=2, height=3.0, ratios=(2, 1))
    found = records.scales()
    over = records.fallen(found)
    left.plot(
        records.RATIOS[~over], found.peak.values[~over], ".", ms=1.2, mew=0, color=FIRST, rasterized=True
    )
    left.plot(
        records.RATIOS[over],
        np.full(over.sum(), TOP),
        "|",
        ms=7,
        mew=0.25,
        color=rk.plot.palette.OVERTURNED[0],
        rasterized=True,
    )
    left.set(xlim=(records.RATIOS[0], records.RATIOS[-1]), ylim=(0.0, TOP + 0.06))
    rk.plot.title(left, "bars: overturned")
    finish(left, r"PGA/($g\,\theta_{cr}$)", r"largest $|\theta|/\theta_{cr}$")
    steps = np.array(records.STRIDES) * (records.RATIOS[1] - records.RATIOS[0])
    counts = [records.switches(over[::stride]) for stride in records.STRIDES]
    right.loglog(steps, counts, "o-", ms=4, lw=0.9, color=INK)
    right.loglog(steps, counts[-1] * steps[-1] / steps, "--", lw=0.8, color=SECOND)
    rk.plot.title(right, "switches")
    finish(right, "step of PGA/($g\\,\\theta_{cr}$)", "number of switches")
    return figure
