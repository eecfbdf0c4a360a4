"""Long chaos, which may be a transient, e = 0.99, T = 0.33, from rest.

Poincaré sections (ψ = 0) of two simulated runs over 2·10⁴ cycles: (a) A = 4.86, (b) A = 4.88. The first 100 cycles
are omitted. If a run becomes periodic, its later points are orange, and the title gives the period and the cycle. A run
that does not is either chaos for ever or a transient that lasts longer. The end of a chaotic transient depends on rounding:
another run of the same system, such as the run of `classify`, may become periodic in another cycle.
"""

import numpy as np
from matplotlib.figure import Figure

import rocking as rk

AMPLITUDES = (4.86, 4.88)
CYCLES, LEFT_OUT = 20_000, 100
MAX_FORCING_PERIOD = 16
NEAR = 1e-3
"""Distance below which points of the section count as equal."""


def draw() -> Figure:
    """Draw both sections."""
    figure, axes = rk.plot.panels(columns=2, height=3.2)
    for ax, amplitude in zip(axes, AMPLITUDES, strict=True):
        system = rk.System(rk.Harmonic(amplitude, period=0.33), restitution=0.99)
        points = rk.simulate(system, cycles=CYCLES, record="section").section()
        cycle, period = settled(points)
        rk.plot.section(points[LEFT_OUT:cycle], ax)
        text = f"not periodic within {CYCLES:,} cycles"
        if period:
            text = f"period {period} from cycle {cycle:,} on"
            ax.plot(
                *points[cycle:].T,
                linestyle="none",
                marker="o",
                markersize=4.0,
                color=rk.plot.palette.IMPACT,
                gid="settled",
            )
        rk.plot.title(ax, f"$A = {amplitude:g}$: {text}")
    return figure


def settled(points: np.ndarray) -> tuple[int, int]:
    """Return the cycle from which a run repeats itself up to its end, for at least half of LEFT_OUT cycles.

    Returns
    -------
    tuple of (int, int)
        Cycle and period; the number of points and 0 if the run does not repeat itself.
    """
    for period in range(1, MAX_FORCING_PERIOD + 1):
        apart = np.hypot(*(points[period:] - points[:-period]).T)
        cycle = int(np.flatnonzero(np.append(True, apart > NEAR))[-1])
        if cycle < len(apart) - LEFT_OUT // 2:
            return cycle, period
    return len(points), 0
