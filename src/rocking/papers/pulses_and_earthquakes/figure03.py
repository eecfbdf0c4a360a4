"""Figure 3: rocking spectrum of a recorded motion, scaled to 0.6 g: largest angle over 2π/α.

The record is that of San Francisco, 1295 Shafter, in the Loma Prieta earthquake of 1989, which comes with the package.
Slendernesses θcr of 10, 15 and 20°, with Housner's coefficient of restitution. The largest angle is in units of θcr.
Bars at the upper edge mark sizes at which the block overturns. Larger blocks are not always safer: between sizes that
overturn there are sizes that stand. The form of the diagram is that of Makris & Konstantinidis (2003), whose records do
not come with the package.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.pulses_and_earthquakes import records
from rocking.papers.pulses_and_earthquakes.axes import FIRST, SECOND, THIRD, finish

TOP = 1.02


def draw() -> Figure:
    """Draw the spectrum."""
    figure, (ax,) = rk.plot.panels(height=3.2)
    found = records.spectrum().transpose("slenderness", "size")
    periods = 2 * np.pi / found["frequency_parameter"].values
    rows = zip(found.peak.values, records.fallen(found), np.degrees(found["slenderness"].values), strict=True)
    for number, ((peak, over, degrees), colour) in enumerate(zip(rows, (FIRST, SECOND, THIRD), strict=True)):
        ax.plot(
            periods,
            np.where(over, np.nan, peak),
            color=colour,
            lw=0.9,
            label=rf"$\theta_{{cr}}$ = {degrees:.0f}°",
        )
        ax.plot(periods[over], np.full(over.sum(), TOP + 0.035 * number), "|", ms=4, mew=0.9, color=colour)
    ax.set(xlim=(records.PERIODS[0], records.PERIODS[-1]), ylim=(0.0, TOP + 0.1))
    rk.plot.title(ax, f"PGA {records.SPECTRUM_PGA:g} g; bars: overturned")
    finish(ax, r"$2\pi/\alpha$ (s)", r"largest $|\theta|/\theta_{cr}$", columns=3)
    return figure
