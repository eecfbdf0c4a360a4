"""Figure 2: half sine and rectangular pulse: amplitude that overturns a block at rest.

(a) Half sine over its frequency Ω = π/T. The exact condition is that of Shi et al. (1996) and Makris & Roussos (2000),
Eq. (27). Housner (1963), Eq. (12), gives √(1 + Ω²), and Makris & Roussos, Eq. (28), the line 1 + Ω/2 for Ω < 3. Both
lie above the exact amplitude: a block overturns although they predict that it stands. (b) Rectangular pulse over its
duration T: A = 1/(1 − e⁻ᵀ), which solves Housner's Eq. (9). Marks: thresholds of the simulation by bisection.
"""

import math

import numpy as np
from matplotlib.figure import Figure

import rocking as rk
from rocking.papers.pulses_and_earthquakes import thresholds
from rocking.papers.pulses_and_earthquakes.axes import FIRST, INK, SECOND, THIRD, finish

FREQUENCIES, DURATIONS = (0.5, 1.0, 2.0, 3.0, 4.0, 5.0), (0.3, 0.7, 1.0, 2.0, 3.0, 4.0)


def simulated(kind: str, frequencies: tuple[float, ...]) -> list[float]:
    """Return the thresholds of the simulation."""
    return [thresholds.lowest(kind, frequency, 0.9) for frequency in frequencies]


def draw() -> Figure:
    """Draw both pulses."""
    figure, (left, right) = rk.plot.panels(columns=2, height=3.2)
    rates, line = np.linspace(0.05, 5.2, 300), np.array([0.0, 3.0])
    left.plot(rates, np.sqrt(1 + rates**2), color=SECOND, lw=1.2, label="Housner, Eq. (12)")
    left.plot(rates, rk.theory.half_sine_pulse_amplitude(math.pi / rates), color=FIRST, lw=1.2, label="exact")
    left.plot(line, 1 + line / 2, color=THIRD, lw=1.2, ls="--", label=r"$1 + \Omega/2$")
    left.plot(FREQUENCIES, simulated("half-sine", FREQUENCIES), "o", ms=4, color=INK, label="simulated")
    left.set(xlim=(0.0, 5.2), ylim=(0.8, 5.5))
    rk.plot.title(left, "half sine")
    finish(left, r"frequency $\Omega$ of the pulse", "amplitude $A$")
    times = np.linspace(0.18, 4.2, 300)
    right.plot(
        times,
        rk.theory.rectangular_pulse_amplitude(times),
        color=FIRST,
        lw=1.2,
        label="exact, as Housner, Eq. (9)",
    )
    found = simulated("rectangular", tuple(math.pi / duration for duration in DURATIONS))
    right.plot(DURATIONS, found, "o", ms=4, color=INK, label="simulated")
    right.set(xlim=(0.0, 4.2), ylim=(0.8, 5.5))
    rk.plot.title(right, "rectangular")
    finish(right, r"duration $T$ of the pulse ($\tau$)", "amplitude $A$")
    return figure
