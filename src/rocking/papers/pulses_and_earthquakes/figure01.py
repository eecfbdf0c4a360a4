"""Figure 1: one sine pulse: amplitudes that overturn the slender block over the frequency of the pulse, e = 0.9.

A is the amplitude in units of gθcr, Ω the frequency of the pulse over the frequency parameter of the block. Grey: the
simulated block overturns, on a grid of 90 × 90 points; light blue: it stands. Dark blue: closed form of mode 2, Zhang & Makris
(2001), Eq. (47). Above it the block overturns without an impact. Orange: both ends of mode 1, with an impact after the pulse. Dashed: the
lowest amplitude of the simulation, where the impact falls into the pulse. Black: printed numbers of Zhang & Makris at
Ω = 5 and at 15.7 rad/s. Rings: the block stands. Dots: it overturns. The dotted line is the printed end
of mode 1, Ω = 6.59. Teal: 1 + Ω/6, Makris & Roussos (2000).

Difference from the paper: the printed numbers differ from the exact boundaries in the third digit. The difference is
too small to be seen here.
"""

import math

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.pulses_and_earthquakes import thresholds
from rocking.papers.pulses_and_earthquakes.axes import FIRST, INK, SECOND, THIRD, finish

RESTITUTION = 0.9
FREQUENCIES, AMPLITUDES = np.linspace(0.5, 8.0, 90), np.linspace(0.5, 14.0, 90)
STANDS = ((5.0, 3.00), (5.0, 6.33), (5.0, 7.17))
FALLS = ((5.0, 3.01), (5.0, 6.32), (5.0, 7.18), (15.7 / 2.14, 3.24 / 0.25))
PRINTED_END = 6.59


def overturned() -> np.ndarray:
    """Return whether the block overturns, by amplitude and frequency."""
    return np.array(
        [
            [thresholds.falls("one-sine", amplitude, frequency, RESTITUTION) for frequency in FREQUENCIES]
            for amplitude in AMPLITUDES
        ]
    )


def draw() -> Figure:
    """Draw the boundaries."""
    figure, (ax,) = rk.plot.panels(height=3.6)
    ax.pcolormesh(
        FREQUENCIES,
        AMPLITUDES,
        overturned(),
        cmap=ListedColormap([rk.plot.palette.STANDS, rk.plot.palette.OVERTURNED[0]]),
        shading="nearest",
        rasterized=True,
    )
    rates = np.linspace(FREQUENCIES[0], FREQUENCIES[-1], 400)
    low, high = rk.theory.one_sine_impact_amplitudes(math.tau / rates, RESTITUTION)
    ax.plot(rates, rk.theory.one_sine_pulse_amplitude(math.tau / rates), color=FIRST, lw=1.2, label="mode 2")
    ax.plot(rates, low, color=SECOND, lw=1.2, label="mode 1")
    ax.plot(rates, high, color=SECOND, lw=1.2)
    slow = np.linspace(FREQUENCIES[0], 4.79, 90)
    ax.plot(
        slow,
        thresholds.lowest_of("one-sine", slow, RESTITUTION),
        color=SECOND,
        lw=1.0,
        ls="--",
        label="impact in the pulse",
    )
    line = np.linspace(FREQUENCIES[0], 3.0, 2)
    ax.plot(line, 1 + line / 6, color=THIRD, lw=1.2, label=r"$1 + \Omega/6$")
    # Numbers of a pair are closer than a mark is wide: the ring surrounds the dot.
    for points, face, size, name in (
        (STANDS, "none", 7.0, "printed: stands"),
        (FALLS, INK, 3.0, "printed: overturns"),
    ):
        ax.plot(*zip(*points, strict=True), "o", ms=size, mfc=face, mec=INK, mew=0.8, label=name)
    ax.axvline(PRINTED_END, color=INK, lw=0.8, ls=":")
    ax.set(xlim=(FREQUENCIES[0], FREQUENCIES[-1]), ylim=(0.5, 14.0))
    finish(ax, r"frequency $\Omega$ of the pulse", "amplitude $A$")
    return figure
