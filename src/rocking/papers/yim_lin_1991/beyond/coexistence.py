"""Basins of attraction at A = 5.5, T = 0.5, e = 0.925, φ = 0, the system of figure 2c.

Basins over the initial states (Θ₀, Θ'₀), 240 × 240 points, with area fractions of 0.1 % or more. A line leads to the
point of each basin that is farthest from its boundary. Several periodic responses coexist with overturning; the
initial state alone selects one of them. The uncertainty exponents of the boundaries stand below the figure, with 95 %
intervals. The fraction of states with an uncertain response is proportional to the uncertainty of the initial state
to the power of the exponent. The exponent is 1 for a smooth boundary and smaller for a fractal one.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.ndimage import distance_transform_edt

import rocking as rk
from rocking.model.survey_results import BasinMap
from rocking.model.text import percent

SYSTEM = rk.System(rk.Harmonic(amplitude=5.5, period=0.5), restitution=0.925)
COUNT = 240
SIZE = (5.2, 4.4)
LEAST = 1e-3
"""Smallest area fraction with a label."""


def draw() -> Figure:
    """Draw the basins."""
    axis = np.linspace(-1.0, 1.0, COUNT)
    found = rk.basin_map(SYSTEM, angle=axis, velocity=axis, boundary_runs=20_000)
    figure, (ax,) = rk.plot.panels(height=4.2)
    figure.set_size_inches(SIZE)
    rk.plot.basins(found, ax)
    ax.get_legend().remove()
    _label(ax, found)
    ax.text(
        0.0,
        -0.17,
        "uncertainty exponent\n"
        f"of all boundaries: {found.attractor_exponent}\n"
        f"of the boundary of overturning: {found.uncertainty_exponent}",
        transform=ax.transAxes,
        va="top",
        fontsize=8.0,
    )
    return figure


def _label(ax: Axes, found: BasinMap) -> None:
    """Write name and area fraction of each attractor at the right, with a line to the innermost point of its basin."""
    places = found.dataset.attractor.transpose("velocity", "angle")
    anchors = []
    for number, (each, share) in enumerate(zip(found.attractors, found.fractions, strict=True)):
        if share.value >= LEAST:
            inside = distance_transform_edt(np.pad(places.values == number, 1))[1:-1, 1:-1]
            row, column = np.unravel_index(int(inside.argmax()), inside.shape)
            anchors.append(
                (
                    float(places.velocity[row]),
                    float(places.angle[column]),
                    f"{each.name}\n{percent(share.value)}",
                )
            )
    for height, (up, across, text) in zip(
        np.linspace(0.96, 0.04, len(anchors)), sorted(anchors, reverse=True), strict=True
    ):
        ax.annotate(
            text,
            (across, up),
            (1.06, height),
            textcoords="axes fraction",
            va="center",
            fontsize=8.0,
            arrowprops={
                "arrowstyle": "-",
                "linewidth": 0.6,
                "shrinkA": 1,
                "shrinkB": 0,
                "relpos": (0.0, 0.5),
            },
        )
        ax.plot(across, up, "o", color=rk.plot.palette.INK, markersize=2.5)
