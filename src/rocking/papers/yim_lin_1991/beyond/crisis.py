"""A crisis: chaos that lasts and chaos that does not, e = 0.99, T = 0.33, from rest.

Left A = 4.86: what looks chaotic ends, after some thousand to some hundred thousand cycles, in a response of period 3. Right A = 4.88:
beyond the crisis near A = 4.868 it stays. Points of the section over the first 2·10⁴ cycles; no run of that length tells the two apart.
"""

from matplotlib.figure import Figure

import rocking as rk

AMPLITUDES = (4.86, 4.88)
CYCLES = 20_000


def draw() -> Figure:
    """Draws both sections."""
    figure, axes = rk.plot.panels(columns=2, height=3.2)
    for ax, amplitude in zip(axes, AMPLITUDES, strict=True):
        system = rk.System(rk.Harmonic(amplitude, period=0.33), restitution=0.99)
        rk.plot.section(rk.simulate(system, cycles=CYCLES, record="section"), ax, transient=100)
        found = rk.classify(system, max_cycles=300_000)
        kind = f"{found.kind}" + (f", period {found.period}" if found.period else "")
        # beside the second line stands the phase of the section
        rk.plot.title(ax, f"after {found.cycles:,} cycles {kind}\n$A = {amplitude:g}$")
    return figure
