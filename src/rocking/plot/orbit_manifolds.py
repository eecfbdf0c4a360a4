"""Stable and unstable manifolds of a saddle orbit on a section."""

from matplotlib.axes import Axes
from matplotlib.patheffects import Normal, Stroke

from rocking.model.block import Block
from rocking.model.validation import instance
from rocking.orbits.orbit_manifolds import OrbitManifolds
from rocking.plot.bifurcation_set import EDGE
from rocking.plot.manifolds import STABLE, UNSTABLE
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import quantities
from rocking.plot.parts.branch_lines import unless_there
from rocking.plot.section import at_phase


def orbit_manifolds(result: OrbitManifolds, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the stable and unstable manifolds of a saddle orbit, with the points of the orbit marked.

    Parameters
    ----------
    result : OrbitManifolds
        Result of `rocking.orbit_manifolds`.
    ax : matplotlib Axes, optional
        Axes to draw into, for example those of `basins`, which shows the phase φ of the forcing. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes. Default: normalised axes.

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
    shown = quantities(block)
    is_new = ax is None
    ax = style.own(ax, height=2.9)
    for name, colour, halves in (("stable", STABLE, result.stable), ("unstable", UNSTABLE, result.unstable)):
        for one in halves:
            ax.plot(
                shown.angle(one.points[:, 0]),
                shown.velocity(one.points[:, 1]),
                color=colour,
                linewidth=style.THIN,
                path_effects=[Stroke(linewidth=style.THIN + EDGE, foreground="white"), Normal()],
                rasterized=len(one.points) > style.MAX_CORNERS,
                label=unless_there(ax, name),
                gid=name,
            )
    ax.plot(
        shown.angle(result.points[:, 0]),
        shown.velocity(result.points[:, 1]),
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
        style.label(ax, shown.angle_label, shown.velocity_label)
    style.note(ax, at_phase(result.phase))
    style.key_beside(ax)
    return ax
