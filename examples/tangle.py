"""Heteroclinic tangle: manifolds of the saddles below, at and above the amplitude of their tangency.

Above that amplitude the boundary of overturning is fractal. Run ``python examples/tangle.py [FILE]``. It writes the
figure to FILE. Default: ``tangle.png`` in the current folder.
"""

import sys

import rocking as rk


def draw():
    """Draw three panels: separate, tangent and intersecting manifolds."""
    touching = rk.tangency_amplitude(rk.System(rk.Harmonic(amplitude=1.0, period=1.0), restitution=0.8))
    figure, axes = rk.plot.panels(columns=3, height=3.6)
    for ax, share in zip(axes, (0.8, 1.0, 1.2), strict=True):
        system = rk.System(rk.Harmonic(amplitude=share * touching, period=1.0), restitution=0.8)
        rk.plot.manifolds(rk.saddle_manifolds(system, cycles=3), ax)
        rk.plot.title(ax, f"A = {share * touching:.3f}")
        ax.get_legend().remove()
    return figure


if __name__ == "__main__":
    print(rk.plot.save(draw(), sys.argv[1] if len(sys.argv) > 1 else "tangle.png"))
