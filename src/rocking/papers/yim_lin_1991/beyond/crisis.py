"""A crisis: chaos that ends and chaos that is not seen to end, e = 0.99, T = 0.33, from rest.

Poincaré sections of two simulated runs over 2·10⁴ cycles, (a) A = 4.86 and (b) A = 4.88; the first 100 cycles are left out. If a run
becomes periodic, its points from then on are orange, and the title gives the cycle. When a chaotic transient ends depends on rounding.
Another run of the same system, such as that of `classify`, may end in another cycle.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk

AMPLITUDES = (4.86, 4.88)
CYCLES, LEFT_OUT = 20_000, 100
MAX_FORCING_PERIOD = 16
NEAR = 1e-3
"""Points of the section that are nearer to each other than this count as the same."""


def draw() -> Figure:
    """Draw both sections."""
    figure, axes = rk.plot.panels(columns=2, height=3.2)
    for ax, amplitude in zip(axes, AMPLITUDES, strict=True):
        system = rk.System(rk.Harmonic(amplitude, period=0.33), restitution=0.99)
        points = rk.simulate(system, cycles=CYCLES, record="section").section()
        cycle, period = settled(points)
        rk.plot.section(points[LEFT_OUT:cycle], ax, phase=0.0)
        text = f"not periodic within {CYCLES:,} cycles"
        if period:
            text = f"period {period} from cycle {cycle:,} on"
            ax.plot(
                *points[cycle:].T,
                linestyle="none",
                marker="o",
                markersize=1.0,
                color="#E69F00",
                gid="settled",
            )
        # beside the second line stands the phase of the section
        rk.plot.title(ax, f"{text}\n$A = {amplitude:g}$")
    return figure


def settled(points: np.ndarray) -> tuple[int, int]:
    """(cycle, period) from which on a run repeats itself to its end; (number of points, 0) if it does not.

    At least half of LEFT_OUT cycles must repeat themselves.
    """
    for period in range(1, MAX_FORCING_PERIOD + 1):
        apart = np.hypot(*(points[period:] - points[:-period]).T)
        cycle = int(np.flatnonzero(np.append(True, apart > NEAR))[-1])
        if cycle < len(apart) - LEFT_OUT // 2:
            return cycle, period
    return len(points), 0
