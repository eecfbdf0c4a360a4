"""Block in an earthquake: time history under the same record, weaker and stronger.

The record is that of Loma Prieta 1989 that comes with the package. A block of 2 m × 0.5 m overturns at a
peak of 1.17 g. It stands at 0.6 g, and again at 1.2 g. Run ``python examples/earthquake.py [FILE]``. It writes the figure to FILE. Default:
``earthquake.png`` in the current folder.
"""

import sys

import rocking as rk


def draw():
    """Draw a panel per peak acceleration, with the outcome in its title."""
    block, ground = rk.Block(height=2.0, width=0.5), rk.example_ground_motion()
    figure, axes = rk.plot.panels(rows=3, height=2.0)
    for ax, pga in zip(axes, (0.6, 1.17, 1.2), strict=True):
        motion = rk.simulate(block.system(ground.scaled(pga=pga * 9.80665)))
        rk.plot.time_history(motion, ax, block)
        rk.plot.title(ax, f"peak {pga:g} g: {motion.outcome}")
        ax.set(xlim=(5.0, 35.0), ylim=(-20.0, 20.0))
    return figure


if __name__ == "__main__":
    print(rk.plot.save(draw(), sys.argv[1] if len(sys.argv) > 1 else "earthquake.png"))
