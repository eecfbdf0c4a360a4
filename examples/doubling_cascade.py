"""From one orbit to chaos: a branch followed through its period doublings, laid over the orbit diagram.

Run it as ``python examples/doubling_cascade.py [FILE]``; it prints where the doublings are, with the ratios of their distances, and
writes ``doubling-cascade.png`` into the current folder unless told otherwise.
"""

import sys

import numpy as np

import rocking as rk

PERIOD, RESTITUTION = 1.721328, 0.8
DOUBLINGS = 6
# 4.669201609…: what the ratios tend to in every such cascade (Feigenbaum 1978).
FEIGENBAUM = 4.669201609102990


def system(amplitude):
    """The block at an amplitude."""
    return rk.System(rk.Harmonic(amplitude=amplitude, period=PERIOD), restitution=RESTITUTION)


def cascade():
    """(branches, doublings): the symmetric orbit, the unsymmetric one born from it, and what is born at each doubling."""
    symmetric = rk.continue_orbit(rk.classify(system(7.0)).orbit, "amplitude", (5.0, 11.0))
    breaking = next(point for point in symmetric.special if point.kind == "symmetry-breaking")
    # of the two that are born, mirror images of each other, the one that the sweep takes
    born = max(rk.switch_branch(breaking, (7.0, 11.0)), key=lambda one: one.section()[-1, 0, 0])
    branches, doublings, near = [symmetric, born], [], 0.5
    while len(doublings) < DOUBLINGS:
        doublings.append(next(point for point in branches[-1].special if point.kind == "period-doubling"))
        here = doublings[-1].parameter
        if len(doublings) > 1:  # the next is nearer by a factor of almost five
            near = 0.5 * (here - doublings[-2].parameter)
        # Neighbouring orbits part less and less, so that steps must be shorter not to pass over the next doubling.
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
    """Draws the whole branch over the diagram, and the cascade nearer."""
    figure, (wide, near) = rk.plot.panels(columns=2, height=3.6)
    for ax, values in ((wide, np.linspace(7.0, 10.9, 500)), (near, np.linspace(10.4, 10.76, 500))):
        diagram = rk.orbit_diagram(system(7.0), "amplitude", values, sweep="up", transient=2_000, cycles=200)
        rk.plot.orbit_diagram(diagram, ax, branches=branches)
    near.set_ylim(1.44, 1.56)
    rk.plot.title(wide, "swept up")
    rk.plot.title(near, "the doublings")
    return figure


if __name__ == "__main__":
    found, points = cascade()
    table(points)
    print(rk.plot.save(draw(found), sys.argv[1] if len(sys.argv) > 1 else "doubling-cascade.png"))
