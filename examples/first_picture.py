"""First figure of the README: a block, its motion, its phase portrait, and chaos between braces.

Run it as ``python examples/first_picture.py [FILE]``. Default file: ``first-picture.png`` in the current folder.
"""

import sys

import rocking as rk


def draw():
    """Draw the four panels, all in SI units."""
    block = rk.Block(height=2.0, width=0.5)
    shaken = rk.simulate(block.system(acceleration=4.0, frequency_hz=1.2), cycles=40)
    braced = rk.System(
        rk.Harmonic(amplitude=15.0, period=2.0), restitution=0.925, braces=rk.Braces(angle=1.0)
    )
    chaos = rk.simulate(braced, cycles=300_000, record="section")
    strong, hertz = block.acceleration(braced.forcing.amplitude), 1.0 / block.seconds(braced.forcing.period)

    figure, (base, history, portrait, section) = rk.plot.panels(rows=2, columns=2, height=3.1, ratios=(2, 3))
    rk.plot.schematic(base, lean=0.6)
    rk.plot.time_history(shaken, history, block, cycles=(0, 15))
    rk.plot.phase_portrait(shaken, portrait, block, cycles=(30, 40))
    rk.plot.section(chaos.section(), section, block, transient=1_000)
    rk.plot.title(base, "the block (not to scale)")
    rk.plot.title(history, "2 m × 0.5 m, 4 m/s² at 1.2 Hz")
    rk.plot.title(portrait, "cycles 30 to 40")
    rk.plot.title(section, f"chaos between braces, {strong:.0f} m/s² at {hertz:.2g} Hz")
    return figure


if __name__ == "__main__":
    print(rk.plot.save(draw(), sys.argv[1] if len(sys.argv) > 1 else "first-picture.png"))
