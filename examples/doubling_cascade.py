"""Period doublings to chaos: a branch of orbits continued through them, drawn over the orbit diagram.

Run ``python examples/doubling_cascade.py [FILE]``. It prints the amplitudes of the doublings and the ratios of their distances,
and writes the figure to FILE. Default: ``doubling-cascade.png`` in the current folder.
"""

import sys

import numpy as np

import rocking as rk

PERIOD, RESTITUTION = 1.721328, 0.8
DOUBLINGS = 6
# Limit of the ratios in every period-doubling cascade (Feigenbaum 1978).
FEIGENBAUM = 4.669201609102990


def system(amplitude):
    """Return the system at an amplitude."""
    return rk.System(rk.Harmonic(amplitude=amplitude, period=PERIOD), restitution=RESTITUTION)


def cascade():
    """Continue the symmetric orbit, an asymmetric one that branches off, and the orbits of each doubling."""
    symmetric = rk.continue_orbit(rk.classify(system(7.0)).orbit, "amplitude", (5.0, 11.0))
    breaking = next(point for point in symmetric.special if point.kind == "symmetry-breaking")
    # Two mirror images branch off. This is the one on which the sweep lies.
    born = max(rk.switch_branch(breaking, (7.0, 11.0)), key=lambda one: one.section()[-1, 0, 0])
    branches, doublings, near = [symmetric, born], [], 0.5
    while len(doublings) < DOUBLINGS:
        doublings.append(next(point for point in branches[-1].special if point.kind == "period-doubling"))
        here = doublings[-1].parameter
        if len(doublings) > 1:  # The next doubling is closer by a factor of almost five.
            near = 0.5 * (here - doublings[-2].parameter)
        # Doublings come closer and closer, so short steps are needed not to skip the next one.
        branches.append(rk.switch_branch(doublings[-1], (here - near, here + near), step=0.001)[0])
    return branches, doublings


def table(doublings):
    """Print the amplitudes at which the period doubles, and the ratios of the distances between them."""
    amplitudes = [point.parameter for point in doublings]
    gaps = np.diff(amplitudes)
    print("period      amplitude     ratio of distances")
    for k, amplitude in enumerate(amplitudes):
        ratio = f"{gaps[k - 2] / gaps[k - 1]:.4f}" if k > 1 else ""
        print(f"{2**k:2d} → {2 ** (k + 1):2d}   {amplitude:.9f}   {ratio}")
    print(f"Feigenbaum's constant:   {FEIGENBAUM:.4f}")


def draw(branches):
    """Draw the branch over the diagram, and an enlarged view of the cascade."""
    figure, (wide, near) = rk.plot.panels(columns=2, height=3.6)
    for ax, values in ((wide, np.linspace(7.0, 10.9, 500)), (near, np.linspace(10.4, 10.76, 500))):
        diagram = rk.orbit_diagram(system(7.0), amplitude=values, sweep="up", transient=2_000, cycles=200)
        rk.plot.orbit_diagram(diagram, ax, branches=branches)
    near.set_ylim(1.44, 1.56)
    rk.plot.title(wide, "swept upwards")
    rk.plot.title(near, "period doublings")
    return figure


if __name__ == "__main__":
    result, points = cascade()
    table(points)
    print(rk.plot.save(draw(result), sys.argv[1] if len(sys.argv) > 1 else "doubling-cascade.png"))
