"""Stroboscopic points."""

import math

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from rocking.model import (
    MAX_PHASE,
    Block,
    reals,
    refusal,
    whole,
    within,
)
from rocking.motion import Motion
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import quantities


def section(
    result: Motion | ArrayLike,
    ax: Axes | None = None,
    block: Block | None = None,
    phase: float | None = None,
    transient: int = 0,
) -> Axes:
    """Draws the states of a motion at one phase of the forcing, cycle after cycle (Poincaré map).

    Parameters
    ----------
    result : Motion or array of shape (n, 2)
        A motion (recorded with ``record="section"`` or ``"all"``), or points (Θ, Θ').
    ax : matplotlib Axes, optional
        Drawn into; a new figure, a column wide, if not given.
    block : Block, optional
        Gives SI axes, degrees and degrees per second; otherwise the axes are normalised.
    phase : float, optional
        Forcing phase of the section, rad; by default the forcing's own, at which the motion started.
    transient : int
        How many points are left out at the start; at least one must stay.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If `result` holds no points, `transient` leaves none, or an argument is of another kind.

    See Also
    --------
    impact_section : Plot the impacts.
    orbit_diagram : Plot sections over a parameter.
    rocking.simulate : Compute a motion.

    Notes
    -----
    Every point is drawn; marks shrink from 5 pt (10 points) to a fraction of a point (10⁶), points met again not counted.
    More than 2,000 are an image inside a vector file, so that the file stays small.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=6.5, period=0.4), restitution=0.925)
    >>> ax = rk.plot.section(rk.simulate(system, cycles=600), transient=300)
    >>> len(ax.lines[0].get_xdata())
    301
    """
    if phase is not None:
        phase = within("phase", phase, -MAX_PHASE, MAX_PHASE)
    points = result.section(phase) if isinstance(result, Motion) else _points(result)
    points = points[whole("transient", transient, 0, len(points) - 1) :]
    if isinstance(result, Motion) and phase is None:
        phase = result.system.forcing.phase
    shown = quantities(block)
    ax = style.own(ax, height=2.9)
    ax.plot(
        shown.angle(points[:, 0]),
        shown.velocity(points[:, 1]),
        linestyle="none",
        marker="o",
        markersize=style.point_size(style.places(*points.T)),
        markeredgewidth=0,
        color=style.MOTION,
        rasterized=len(points) > style.MAX_MARKS,
        gid="section",
    )
    style.label(ax, shown.angle_label, shown.velocity_label)
    if phase is not None:
        style.note(ax, at_phase(phase))
    return ax


def _points(result) -> NDArray:
    allowed = "be a Motion or points of shape (n, 2), one at least"
    try:
        points = np.asarray(reals("result", result))
    except TypeError:
        raise TypeError(refusal("result", allowed, result)) from None
    if points.ndim != 2 or points.shape[1] != 2 or not len(points):
        raise ValueError(refusal("result", allowed, result))
    return points


def at_phase(phase: float) -> str:
    """At which forcing phase a section is taken."""
    return rf"$\psi = {phase % (2 * math.pi):.4g}$ (mod $2\pi$)"
