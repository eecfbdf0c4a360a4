"""Plots of sections: Poincaré sections, impacts, and the correlation sum of their points."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator
from numpy.typing import ArrayLike, NDArray

from rocking.model.block import Block
from rocking.model.quantity import PHASE
from rocking.model.text import counted
from rocking.model.validation import Refusal, WrongType, instance, reals, refuse_if, whole
from rocking.motion.motion import Motion
from rocking.plot import style
from rocking.plot.axes import units_of
from rocking.response.correlation_dimension import CorrelationDimension
from rocking.response.impact_section import impact_section as impacts_of


def section(
    result: Motion | ArrayLike,
    ax: Axes | None = None,
    block: Block | None = None,
    *,
    phase: float | None = None,
    transient: int = 0,
) -> Axes:
    """Plot the Poincaré section of a motion: its states at one forcing phase, once per cycle.

    Parameters
    ----------
    result : Motion or array of shape (n, 2)
        Motion recorded with ``record="section"`` or ``"all"``, or points (Θ, Θ').
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes, degrees and degrees per second. Default: that of the result. None: normalised axes.
    phase : float, optional
        Forcing phase ψ of the section, rad. Default: the phase of the forcing, at which the motion started.
    transient : int
        Number of points discarded at the start; at least one point must remain. Default: 0.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is neither a Motion nor points, or an argument has the wrong type.
    ValueError
        If `result` holds no points, or `transient` leaves none.

    See Also
    --------
    impact_section : Plot the impacts.
    orbit_diagram : Plot sections over a parameter.
    rocking.simulate : Compute a motion.

    Notes
    -----
    Every point is drawn. Marks shrink from 5 pt (10 distinct points) to a fraction of a point (10⁶). More than 2,000
    points become an image inside a vector file, which keeps the file small.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> ax = rk.plot.section(rk.simulate(system, cycles=600), transient=300)
    >>> len(ax.lines[0].get_xdata())
    301
    """
    if phase is not None:
        phase = PHASE.checked(phase)
    points = result.section(phase) if isinstance(result, Motion) else _points(result)
    points = points[whole("transient", transient, 0, len(points) - 1) :]
    if isinstance(result, Motion) and phase is None:
        phase = result.system.periodic.phase
    units = units_of(block)
    ax = style.own(ax, height=2.9)
    ax.plot(
        units.angle(points[:, 0]),
        units.velocity(points[:, 1]),
        linestyle="none",
        marker="o",
        markersize=style.point_size(style.places(*points.T)),
        markeredgewidth=0,
        color=style.MOTION,
        rasterized=len(points) > style.MAX_MARKS,
        gid="section",
    )
    style.label(ax, units.angle_label, units.velocity_label)
    if phase is not None:
        style.note(ax, at_phase(phase))
    return ax


def _points(result) -> NDArray:
    allowed = "be a Motion or points of shape (n, 2), one at least"
    try:
        points = np.asarray(reals("result", result))
    except TypeError:
        raise WrongType("result", allowed, result) from None
    refuse_if(points.ndim != 2 or points.shape[1] != 2 or not len(points), "result", allowed, result)
    return points


def at_phase(phase: float) -> str:
    """Return a note with the forcing phase of a section."""
    return rf"$\psi = {phase % (2 * math.pi):.4g}$ (mod $2\pi$)"


SIDES = ((1, r"onto $\Theta > 0$", style.MOTION), (-1, r"onto $\Theta < 0$", style.IMPACT))
QUARTERS = ("0", r"$\pi/2$", r"$\pi$", r"$3\pi/2$", r"$2\pi$")


def impact_section(
    result: Motion | np.ndarray, ax: Axes | None = None, block: Block | None = None, *, transient: int = 0
) -> Axes:
    """Plot the impacts at Θ = 0: speed after the impact against forcing phase, one colour per side.

    Parameters
    ----------
    result : Motion or structured array
        Motion recorded with ``record="all"``, or the result of `rocking.impact_section`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for the speed in degrees per second. Default: that of the result. None: normalised speed.
    transient : int
        Number of forcing cycles discarded at the start. Default: 0.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If `result` holds no impact after the transient.

    See Also
    --------
    section : Plot the stroboscopic section.
    rocking.impact_section : Compute the impacts.

    Notes
    -----
    Phase, speed and side are the complete state of the block just after an impact. Every point is drawn. Marks shrink as
    their number grows, and more than 2,000 become an image inside a vector file, as in `section`.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> ax = rk.plot.impact_section(rk.simulate(system, cycles=900), transient=600)
    >>> [len(line.get_xdata()) for line in ax.lines]
    [100, 100]
    """
    impacts = _impacts(result, transient)
    units = units_of(block)
    ax = style.own(ax, height=2.9)
    size = style.point_size(style.places(impacts["phase"], impacts["after"]))
    for side, name, colour in SIDES:
        onto = impacts[np.sign(impacts["after"]) == side]
        if not len(onto):
            continue
        ax.plot(
            onto["phase"],
            units.velocity(np.abs(onto["after"])),
            linestyle="none",
            marker="o",
            markersize=size,
            markeredgewidth=0,
            color=colour,
            rasterized=len(impacts) > style.MAX_MARKS,
            label=name,
            gid=f"impact section {side:+d}",
        )
    style.label(ax, r"forcing phase $\psi$ (rad)", units.speed_label)
    ax.set_xlim(-0.1, 2 * math.pi + 0.1)
    ax.xaxis.set_major_locator(FixedLocator([quarter * math.pi / 2 for quarter in range(5)]))
    ax.set_xticklabels(QUARTERS)
    ax.set_ylim(0.0, 1.08 * float(units.velocity(np.abs(impacts["after"]).max())) or 1.0)
    style.key(ax)
    return ax


def _impacts(result, transient) -> np.ndarray:
    if isinstance(result, Motion):
        impacts = impacts_of(result, transient=transient)
    elif isinstance(result, np.ndarray) and {"cycle", "phase", "after"} <= set(result.dtype.names or ()):
        last = int(result["cycle"].max(initial=0))
        impacts = result[result["cycle"] >= whole("transient", transient, 0, last)]
    else:
        raise WrongType("result", "be a Motion or what impact_section gives", result)
    refuse_if(not len(impacts), "result", "hold an impact after the transient", len(impacts))
    return impacts


def correlation_dimension(result: CorrelationDimension, ax: Axes | None = None) -> Axes:
    """Plot the correlation sum against the radius, its local slopes on the right axis, and the scaling region.

    Parameters
    ----------
    result : CorrelationDimension
        Result of `correlation_dimension`, not of isolated points, whose pairs do not scale.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a CorrelationDimension, or `ax` is not Axes.
    ValueError
        If `result` describes isolated points.

    See Also
    --------
    section : Plot the points.
    rocking.correlation_dimension : Compute the dimension.

    Notes
    -----
    Bars are standard errors of the slopes. The grey band is the scaling region. The coloured band across it is the interval
    of the dimension.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> points = np.random.default_rng(1).random((6_000, 2))
    >>> ax = rk.plot.correlation_dimension(rk.correlation_dimension(points))
    >>> ax.get_xscale(), ax.get_yscale()
    ('log', 'log')
    """
    instance("result", result, CorrelationDimension)
    if result.isolated:
        raise Refusal("result", "hold pairs that scale", counted(result.isolated, "isolated point"))
    ax = style.own(ax, height=2.8)
    ax.set(xscale="log", yscale="log")
    ax.axvspan(*result.scaling_region, color=style.TABLE, alpha=0.4, linewidth=0, gid="scaling-region")
    ax.plot(
        result.radii,
        result.sums,
        color=style.MOTION,
        linewidth=style.LINE,
        label=r"$C(r)$",
        gid="correlation-sum",
    )
    right = ax.twinx()
    right.errorbar(
        (result.radii[1:] * result.radii[:-1]) ** 0.5,
        result.slopes,
        result.slope_errors,
        color=style.IMPACT,
        linestyle="none",
        marker="o",
        markersize=2.0,
        elinewidth=style.THIN,
        label=r"local slope",
        gid="slopes",
    )
    low, high = result.interval
    right.fill_between(
        result.scaling_region, low, high, color=style.IMPACT, alpha=0.25, linewidth=0, gid="interval"
    )
    right.set_ylim(0.0, 1.25 * max(high, float(result.slopes.max())))
    style.label(ax, r"radius $r$ / standard deviation", r"correlation sum $C(r)$")
    ax.yaxis.label.set_color(style.MOTION)
    style.label(right, "", r"$\mathrm{d} \ln C / \mathrm{d} \ln r$")
    for axis in (ax.xaxis, ax.yaxis):
        style.logarithmic(axis)
    right.spines["right"].set(visible=True)
    right.spines["left"].set(visible=False)
    right.yaxis.label.set_color(style.IMPACT)
    style.note(ax, f"dimension {result.value:.2f}, in [{low:.2f}, {high:.2f}]")
    return ax
