"""Figures beyond those of the paper; the docstring of each is its caption."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedFormatter, FixedLocator, FormatStrFormatter

import rocking as rk
from rocking.model.text import percent
from rocking.papers.catalogue import YIM_LIN_1991
from rocking.papers.report.claim import small
from rocking.papers.yim_lin_1991 import surveys

if TYPE_CHECKING:
    import xarray as xr

    from rocking.model.survey_results import BasinMap


@YIM_LIN_1991.additional("chaos", cost=1.5)
def chaos() -> Figure:
    """Fraction of chaotic responses among random periods and amplitudes, over the coefficient of restitution e.

    Responses from rest, T from 0.2 to 3, A from 0 to 16, n = 400 systems for each e, with 95 % intervals. The paper found
    chaotic responses only for e above 0.95. Here about every fifth system is chaotic at e = 0.2. The fraction decreases
    as e grows to 0.8. Hollow marks with one-sided intervals: no chaotic system was found at e = 0.8, 0.9, 0.925, 0.95 and
    0.97. The decrease does not continue to the end: a few systems are chaotic at e = 1.
    """
    figure, (ax,) = rk.plot.panels(height=3.0)
    rk.plot.chaos_share(surveys.chaos(), ax)
    return figure


@YIM_LIN_1991.additional("cascade", cost=0.8, pixels=True)
def cascade() -> Figure:
    """Period doubling to chaos over the amplitude, T = 1.721328, e = 0.8.

    (a) The symmetric orbit loses its symmetry at A = 7.333, as the closed form predicts. Two asymmetric orbits, mirror
    images of each other, branch off: the sweep up follows one of them, the sweep down the other. Period doubling begins
    at A = 10.47. (b) End of the cascade: period doublings at ever smaller distances, then chaos. Above A = 10.75 or so
    the block overturns. (c) Responses from rest: another orbit, of period 3, doubles its period and becomes chaotic by A
    = 10.10. By A = 10.11 it has disappeared. Bars at the bottom mark overturning.
    """
    system = rk.System(rk.Harmonic(amplitude=9.0, period=1.721328), restitution=0.8)
    ranges = (
        (6.5, 10.8, "both", "sweeps up and down"),
        (10.4, 10.76, "up", "sweep up"),
        (10.04, 10.115, "rest", "from rest"),
    )
    figure, axes = rk.plot.panels(rows=3, height=2.6)
    for ax, (low, high, sweep, name) in zip(axes, ranges, strict=True):
        amplitudes = np.linspace(low, high, 500)
        diagram = rk.orbit_diagram(system, amplitude=amplitudes, sweep=sweep, transient=600, cycles=120)
        rk.plot.orbit_diagram(diagram, ax)
        rk.plot.title(ax, name)
        ax.yaxis.set_major_formatter(FormatStrFormatter("%.2f"))
        if sweep != "both":
            ax.get_legend().remove()
    return figure


CYCLES, LEFT_OUT = 20_000, 100
"""Cycles of the figure of a crisis, and cycles at their beginning without a point."""
MAX_FORCING_PERIOD = 16
NEAR = 1e-3
"""Distance below which points of a section count as equal."""


@YIM_LIN_1991.additional("crisis", cost=0.4, pixels=True)
def crisis() -> Figure:
    """Long chaos, which may be a transient, e = 0.99, T = 0.33, from rest.

    Poincaré sections (ψ = 0) of two simulated runs over 2·10⁴ cycles: (a) A = 4.86, (b) A = 4.88. The first 100 cycles
    are omitted. If a run becomes periodic, its later points are orange, and the title gives the period and the cycle. A run
    that does not is either chaos for ever or a transient that lasts longer. The end of a chaotic transient depends on rounding:
    another run of the same system, such as that of a verdict, may become periodic in another cycle.
    """
    figure, axes = rk.plot.panels(columns=2, height=3.2)
    for ax, amplitude in zip(axes, (4.86, 4.88), strict=True):
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


@YIM_LIN_1991.additional("threshold", cost=0.4)
def threshold() -> Figure:
    """Exact tangency amplitude A* and Melnikov's amplitude A_M over the period, e = 0.5, 0.8 and 0.925.

    A* is the amplitude at which the manifolds of the two saddle orbits touch, in closed form. A_M of Eq. (22) is its
    first-order approximation in A and 1 − e. A_M is too low for slow forcing and too high for fast forcing; A_M and A*
    agree in the limit e → 1. Colour distinguishes A* and A_M, the dash the coefficient of restitution.
    """
    figure, (ax,) = rk.plot.panels(height=3.4)
    curves = {}
    periods = np.linspace(*surveys.PERIODS, 561)
    for e in (0.5, 0.8, 0.925):
        curves[f"$A^*$, $e = {e:g}$"] = rk.theory.heteroclinic_amplitude(periods, e)
        curves[f"$A_M$, $e = {e:g}$"] = rk.theory.melnikov_amplitude(periods, e)
    rk.plot.thresholds(periods, curves, ax)
    ax.set(xlim=surveys.PERIODS, ylim=surveys.AMPLITUDES)
    return figure


COUNT = 240
"""Points of the basins and of each enlargement, along an axis."""


@YIM_LIN_1991.additional("coexistence", cost=1.4, pixels=True)
def coexistence() -> Figure:
    """Basins of attraction at A = 5.5, T = 0.5, e = 0.925, φ = 0, the system of figure 2c.

    Basins over the initial states (Θ₀, Θ'₀), 240 × 240 points, with area fractions of 0.1 % or more. A line leads to the
    point of each basin that is farthest from its boundary. Several periodic responses coexist with overturning; the
    initial state alone selects one of them. The uncertainty exponents of the boundaries stand below the figure, with 95 %
    intervals. The fraction of states with an uncertain response is proportional to the uncertainty of the initial state
    to the power of the exponent. The exponent is 1 for a smooth boundary and smaller for a fractal one.
    """
    axis = np.linspace(-1.0, 1.0, COUNT)
    system = rk.System(rk.Harmonic(amplitude=5.5, period=0.5), restitution=0.925)
    basins = rk.basin_map(system, angle=axis, velocity=axis, boundary_runs=20_000)
    figure, (ax,) = rk.plot.panels(height=4.2)
    figure.set_size_inches(5.2, 4.4)
    rk.plot.basins(basins, ax)
    ax.get_legend().remove()
    _label(ax, basins)
    ax.text(
        0.0,
        -0.17,
        "uncertainty exponent\n"
        f"of all boundaries: {basins.attractor_exponent}\n"
        f"of the boundary of overturning: {basins.uncertainty_exponent}",
        transform=ax.transAxes,
        va="top",
        fontsize=8.0,
    )
    return figure


def _label(ax: Axes, basins: BasinMap, least: float = 1e-3) -> None:
    """Write name and area fraction of each attractor at the right, with a line to the innermost point of its basin.

    `least` is the smallest area fraction with a label.
    """
    from scipy.ndimage import distance_transform_edt

    attractor = basins.dataset.attractor.transpose("velocity", "angle")
    anchors = []
    for number, (each, share) in enumerate(zip(basins.attractors, basins.fractions, strict=True)):
        if share.value >= least:
            inside = distance_transform_edt(np.pad(attractor.values == number, 1))[1:-1, 1:-1]
            row, column = np.unravel_index(int(inside.argmax()), inside.shape)
            place = float(attractor.velocity[row]), float(attractor.angle[column])
            anchors.append((*place, f"{each.name}\n{percent(share.value)}"))
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


CENTRE = (1.0914985576, 5.3120190162)
"""Period and amplitude in the middle of the enlargements."""


@YIM_LIN_1991.additional("zoom", cost=1.3, pixels=True)
def zoom() -> Figure:
    """Boundary of overturning of figure 11, and a part of it enlarged a thousand times, e = 0.925.

    (a) Part of the map above A*, around T₀ = 1.0914985576 and A₀ = 5.3120190162, 0.8 wide and 4 high, 240 × 240 points.
    (b) The part in the middle of (a), a thousandth as wide and as high, with as many points. The square in (a) marks its
    position, enlarged. Strips of overturning alternate with strips of bounded responses, in (b) as in (a). Both also have
    large regions without a change. The titles give the fraction of neighbouring points, at the same amplitude, of which
    one overturns and the other does not. A single smooth boundary from top to bottom would give 1 in 239, or 0.42 %.
    """
    figure, axes = rk.plot.panels(columns=2, height=3.8)
    for ax, (width, height) in zip(axes, ((0.8, 4.0), (8e-4, 4e-3)), strict=True):
        period, amplitude = CENTRE
        part = rk.parametric_map(
            surveys.SYSTEM,
            period=period + width * np.linspace(-0.5, 0.5, COUNT),
            amplitude=amplitude + height * np.linspace(-0.5, 0.5, COUNT),
        ).dataset
        rk.plot.parametric_map(part, ax)
        rk.plot.title(ax, f"{100 * _divided(part):.1f} % of neighbouring points differ")
    left, right = axes
    for colour, thickness in (("white", 3.0), (rk.plot.palette.INK, 1.2)):
        left.plot(
            *CENTRE, "s", markersize=8.0, markerfacecolor="none", markeredgecolor=colour, markeredgewidth=thickness
        )  # fmt: skip
    _measure_from_centre(right)
    return figure


def _divided(part: xr.Dataset) -> float:
    """Return the fraction of points adjacent in period of which one overturns and the other does not."""
    over = part.kind.transpose("amplitude", "period").values == rk.Kind.OVERTURNED.code
    return float((over[:, 1:] != over[:, :-1]).mean())


def _measure_from_centre(ax: Axes) -> None:
    """Label the axes with the distances from the centre, in powers of ten."""
    units, ticks = (1e-4, 1e-3), ((-4, -2, 0, 2, 4), (-2, -1, 0, 1, 2))
    for axis, symbol, centre, unit, numbers in zip(
        (ax.xaxis, ax.yaxis), "TA", CENTRE, units, ticks, strict=True
    ):
        axis.set_major_locator(FixedLocator([centre + unit * number for number in numbers]))
        labels = [f"{number}".replace("-", "−") for number in numbers]
        axis.set_major_formatter(FixedFormatter(labels))
        axis.set_label_text(f"${symbol} - {symbol}_0$ ({small(unit)})")


GRID = 12
"""Points along an axis at which the search for bifurcation curves begins."""


@YIM_LIN_1991.additional("bifurcations", cost=23.0, pixels=True)
def bifurcations() -> Figure:
    """Bifurcation curves of orbits up to period 3 over the map of figure 11, e = 0.925.

    (a) The map, and all curves that a search on a grid of 12 × 12 points finds above A = 1.3. (b) A part of it. Each curve
    is followed by continuation, independently of the map. The line is thinner for period 2, and thinnest for period 3.
    Marks show points of codimension two. A dot marks such a point at a grazing. Above the symmetry breaking of period 1 the
    response from rest is no longer symmetric. Many curves leave no trace in the map: there a block that starts from rest
    reaches another attractor. The lower edge of the region of period 3 is no bifurcation. Its orbit stays stable below, but
    a block from rest no longer reaches it.
    """
    system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    curves = rk.bifurcation_set(system, 3, grid=GRID, period=(0.2, 3.0), amplitude=(1.3, 16.0))
    figure, axes = rk.plot.panels(columns=2, height=5.0)
    for ax in axes:
        rk.plot.parametric_map(surveys.damped(), ax)
        rk.plot.bifurcation_set(curves, ax)
    whole, part = axes
    part.get_legend().remove()  # it is that of the whole
    rk.plot.title(whole, f"{len(curves.curves)} curves")
    part.set(xlim=(0.2, 2.0), ylim=(1.3, 5.0))
    rk.plot.title(part, "a part of it")
    return figure
