"""Plots of the stable and unstable manifolds of saddle orbits."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import Normal, Stroke

from rocking.model.block import Block
from rocking.model.validation import instance
from rocking.orbits.manifolds import OrbitManifolds, SaddleManifolds
from rocking.plot import style
from rocking.plot.axes import units_of
from rocking.plot.branch_lines import unless_there
from rocking.plot.curves import EDGE
from rocking.plot.sections import at_phase

UNSTABLE, STABLE = style.IMPACT, style.MOTION
WIDER = 1.15


def manifolds(result: SaddleManifolds, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the stable and unstable manifolds of both saddle orbits, with the saddles marked.

    Parameters
    ----------
    result : SaddleManifolds
        Result of `rocking.saddle_manifolds`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes, degrees and degrees per second. Default: that of the result. None: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a SaddleManifolds, or an argument has the wrong type.

    See Also
    --------
    heteroclinic : Plot the undamped case without forcing.
    rocking.saddle_manifolds : Compute the manifolds.

    Notes
    -----
    The axes show the saddles and the region between them; the curves continue beyond the axes. Lines are solid for the
    saddle near Θ = 1 and dashed for the saddle near Θ = −1.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=4.0, period=1.0), restitution=0.8)
    >>> ax = rk.plot.manifolds(rk.saddle_manifolds(system, cycles=3))
    >>> [line.get_gid() for line in ax.lines]
    ['stable +1', 'stable -1', 'unstable +1', 'unstable -1', 'saddles']
    """
    instance("result", result, SaddleManifolds)
    units = units_of(block)
    ax = style.own(ax, height=2.9)
    for name, colour, pair in (("stable", STABLE, result.stable), ("unstable", UNSTABLE, result.unstable)):
        for one in pair:
            ax.plot(
                units.angle(one.points[:, 0]),
                units.velocity(one.points[:, 1]),
                color=colour,
                linewidth=style.THIN,
                linestyle="-" if one.side > 0 else (0, (4, 1.2)),
                rasterized=len(one.points) > style.MAX_CORNERS,
                label=f"{name}, Θ ≈ {one.side:+d}".replace("-", "−"),
                gid=f"{name} {one.side:+d}",
            )
    ax.plot(
        units.angle(result.saddles[:, 0]),
        units.velocity(result.saddles[:, 1]),
        linestyle="none",
        marker="x",
        markersize=style.MARK,
        markeredgewidth=1.2,
        color=style.INK,
        label="saddles",
        gid="saddles",
        zorder=3,
    )
    style.label(ax, units.angle_label, units.velocity_label)
    _frame(ax, result, units)
    style.note(ax, at_phase(result.phase))
    style.key(ax)
    return ax


def _frame(ax: Axes, result: SaddleManifolds, units) -> None:
    """Set the limits: slightly beyond the saddles, and beyond the speeds at which their tangents meet Θ = 0."""
    sizes = np.abs(result.saddles)
    wide, fast = WIDER * sizes[:, 0].max(), WIDER * sizes.sum(axis=1).max()
    ax.set_xlim(*(float(units.angle(side * wide)) for side in (-1, 1)))
    ax.set_ylim(*(float(units.velocity(side * fast)) for side in (-1, 1)))


def orbit_manifolds(result: OrbitManifolds, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the stable and unstable manifolds of a saddle orbit, with the points of the orbit marked.

    Parameters
    ----------
    result : OrbitManifolds
        Result of `rocking.orbit_manifolds`.
    ax : matplotlib Axes, optional
        Axes to draw into, for example those of `basins`, which shows the phase φ of the forcing. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not an OrbitManifolds.

    See Also
    --------
    manifolds : Plot the manifolds of the saddle orbits without impacts.
    rocking.orbit_manifolds : Compute the manifolds.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=8.0, period=2.0), restitution=0.925)
    >>> saddle = next(orbit for orbit in rk.find_orbits(system, 1) if orbit.symmetric)
    >>> ax = rk.plot.orbit_manifolds(rk.orbit_manifolds(saddle, length=2.0))
    >>> [line.get_gid() for line in ax.lines]
    ['stable', 'stable', 'unstable', 'unstable', 'saddle']
    """
    instance("result", result, OrbitManifolds)
    units = units_of(block)
    is_new = ax is None
    ax = style.own(ax, height=2.9)
    for name, colour, halves in (("stable", STABLE, result.stable), ("unstable", UNSTABLE, result.unstable)):
        for one in halves:
            ax.plot(
                units.angle(one.points[:, 0]),
                units.velocity(one.points[:, 1]),
                color=colour,
                linewidth=style.THIN,
                path_effects=[Stroke(linewidth=style.THIN + EDGE, foreground="white"), Normal()],
                rasterized=len(one.points) > style.MAX_CORNERS,
                label=unless_there(ax, name),
                gid=name,
            )
    ax.plot(
        units.angle(result.points[:, 0]),
        units.velocity(result.points[:, 1]),
        linestyle="none",
        marker="x",
        markersize=style.MARK,
        markeredgewidth=1.2,
        color=style.INK,
        label=f"saddle of period {result.orbit.period}",
        gid="saddle",
        zorder=3,
    )
    if is_new:
        style.label(ax, units.angle_label, units.velocity_label)
    style.note(ax, at_phase(result.phase))
    style.key_beside(ax)
    return ax
