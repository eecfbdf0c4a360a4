"""Poincaré sections: stroboscopic points of a motion."""

import math

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray

from rocking.model.block import Block
from rocking.model.forcing import MAX_PHASE
from rocking.model.validation import WrongType, reals, refuse_if, whole, within
from rocking.motion.motion import Motion
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import quantities


def section(
    result: Motion | ArrayLike,
    ax: Axes | None = None,
    block: Block | None = None,
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
        Block for SI axes, degrees and degrees per second. Default: normalised axes.
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
        phase = within("phase", phase, -MAX_PHASE, MAX_PHASE)
    points = result.section(phase) if isinstance(result, Motion) else _points(result)
    points = points[whole("transient", transient, 0, len(points) - 1) :]
    if isinstance(result, Motion) and phase is None:
        phase = result.system.periodic.phase
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
        raise WrongType("result", allowed, result) from None
    refuse_if(points.ndim != 2 or points.shape[1] != 2 or not len(points), "result", allowed, result)
    return points


def at_phase(phase: float) -> str:
    """Return a note with the forcing phase of a section."""
    return rf"$\psi = {phase % (2 * math.pi):.4g}$ (mod $2\pi$)"
