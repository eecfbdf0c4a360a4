"""Plots of bifurcation curves in the plane of two parameters, and of the transition at a grazing."""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import Normal, Stroke

from rocking.model.block import Block
from rocking.model.validation import Refusal, instance, refuse_if
from rocking.orbits.bifurcation_curve import BifurcationCurve
from rocking.orbits.bifurcation_set import BifurcationSet
from rocking.orbits.grazing_transition import GrazingTransition
from rocking.orbits.special_points import FOLD, GRAZING, PERIOD_DOUBLING, SYMMETRY_BREAKING
from rocking.plot import palette, style
from rocking.plot.axes import parameter
from rocking.plot.branch_lines import several, unless_there

# Marker, size in points, and name in the legend.
AT_GRAZING = ("o", 3.0, "at a grazing")
MARKS = {
    "cusp": ("D", 3.0, "cusp"),
    "degenerate-period-doubling": ("*", 5.5, "degenerate doubling"),
    "degenerate-symmetry-breaking": ("P", 4.5, "degenerate breaking"),
}


def mark(
    ax: Axes, curves: Iterable[BifurcationCurve], across: Callable[[Any], Any], upright: Callable[[Any], Any]
) -> None:
    """Draw one mark per point of codimension two, and one entry of the legend per type of mark."""
    points = [point for curve in curves for point in curve.special]
    for kind in dict.fromkeys(point.kind for point in points):
        marker, size, name = MARKS.get(kind, AT_GRAZING)
        x, y = np.array([point.values for point in points if point.kind == kind]).T
        ax.plot(
            across(x),
            upright(y),
            linestyle="none",
            marker=marker,
            color=style.INK,
            markeredgecolor=style.INK,
            markeredgewidth=0.3,
            markersize=size,
            zorder=3,
            label=unless_there(ax, name),
            gid="codimension-2",
        )


LOOKS: dict[str, tuple[str, Any]] = {
    FOLD: (palette.FOLD, "-"),
    SYMMETRY_BREAKING: (palette.SYMMETRY_BREAKING, (0, (5, 2))),
    PERIOD_DOUBLING: (palette.PERIOD_DOUBLING, (0, (6, 2, 1, 2))),
    GRAZING: (style.INK, (0, (1, 1.5))),
}


def bifurcation_curve(
    result: BifurcationCurve | Sequence[BifurcationCurve], ax: Axes | None = None, block: Block | None = None
) -> Axes:
    """Plot one or several bifurcation curves in the plane of their two parameters, one colour and dash per type.

    A mark shows each point of codimension two.

    Parameters
    ----------
    result : BifurcationCurve or sequence of BifurcationCurve
        Results of `rocking.bifurcation_curve`, all over the same two parameters.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` holds anything but bifurcation curves.
    ValueError
        If the curves have different parameters.

    See Also
    --------
    branch : Plot branches.
    rocking.bifurcation_curve : Compute a curve.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=15.0, period=1.0), restitution=0.9)
    >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10, 30))
    >>> curve = rk.bifurcation_curve(branch.special[0], "period", "amplitude", ((1, 2), (1, 30)))
    >>> rk.plot.bifurcation_curve(curve).get_ylabel()
    'amplitude $A$'
    """
    each = several(result, BifurcationCurve)
    plane = each[0].names
    for one in each:
        refuse_if(
            one.names != plane, "result", f"hold curves of one plane, {plane[0]} and {plane[1]}", one.names
        )
    (across, x_label), (upright, y_label) = (parameter(name, block) for name in plane)
    ax = style.own(ax, height=2.9)
    for one in each:
        colour, dashes = LOOKS[one.kind]
        ax.plot(
            across(one.points[:, 0]),
            upright(one.points[:, 1]),
            color=colour,
            linestyle=dashes,
            linewidth=style.LINE,
            label=unless_there(ax, f"{one.kind.replace('-', ' ')}, period {one.period}"),
            gid=one.kind,
        )
    mark(ax, each, across, upright)
    style.label(ax, x_label, y_label)
    style.key(ax)
    return ax


# White edge around a line, so that it stands out from the colours of a map; in points.
EDGE = 2.2


def bifurcation_set(result: BifurcationSet, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot all curves of a bifurcation set, one colour and dash per type, thinner for longer periods.

    A mark shows each point of codimension two. A dot marks such a point at a grazing, such as an end of a curve.

    Parameters
    ----------
    result : BifurcationSet
        Result of `rocking.bifurcation_set`.
    ax : matplotlib Axes, optional
        Axes to draw into, for example those of `parametric_map` over the same parameters. Default: a new figure, one column
        wide.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a bifurcation set.
    ValueError
        If `ax` shows other quantities.

    See Also
    --------
    bifurcation_curve : Plot single curves.
    parametric_map : Plot the map below the curves.
    rocking.bifurcation_set : Compute the set.

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=4.0, period=2.0), restitution=0.9)
    >>> result = rk.bifurcation_set(system, 1, grid=3, period=(1.5, 2.5), amplitude=(3.0, 12.0))
    >>> [text.get_text() for text in rk.plot.bifurcation_set(result).get_legend().get_texts()]
    ['period doubling', 'symmetry breaking']
    """
    instance("result", result, BifurcationSet)
    (across, x_label), (upright, y_label) = (parameter(name, block) for name in result.names)
    is_new = ax is None
    ax = style.own(ax, height=2.9)
    style.check_labels(ax, x_label, y_label)
    for curve in result.curves:
        colour, dashes = LOOKS[curve.kind]
        width = style.LINE / curve.period**0.5
        ax.plot(
            across(curve.points[:, 0]),
            upright(curve.points[:, 1]),
            color=colour,
            linestyle=dashes,
            linewidth=width,
            path_effects=[Stroke(linewidth=width + EDGE, foreground="white"), Normal()],
            label=unless_there(ax, curve.kind.replace("-", " ")),
            gid=curve.kind,
        )
    mark(ax, result.curves, across, upright)
    style.label(ax, x_label, y_label)
    if result.curves:
        style.key_beside(ax)
    if is_new:
        ax.set_xlim(*(float(across(end)) for end in result.bounds[0]))
        ax.set_ylim(*(float(upright(end)) for end in result.bounds[1]))
    return ax


def grazing_transition(result: GrazingTransition, ax: Axes | None = None) -> Axes:
    """Plot the distances of the attractor from the grazing orbit over the distance of the parameter from the grazing.

    Parameters
    ----------
    result : GrazingTransition
        Result of `rocking.grazing_transition`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a GrazingTransition, or `ax` has the wrong type.
    ValueError
        If the block overturns at all values of the parameter.

    See Also
    --------
    branch : Plot branches.
    rocking.grazing_transition : Compute the transition.

    Notes
    -----
    Both axes are logarithmic. The dashed line is the square root of the distance of the parameter, through the last point. An
    attractor that shrinks onto the grazing orbit follows it. After a jump the points lie on a horizontal line, and no dashed line
    is drawn.

    Examples
    --------
    >>> import rocking as rk
    >>> braces = rk.Braces(angle=0.3, restitution=0.7)
    >>> system = rk.System(rk.Harmonic(amplitude=4.0, period=1.0), 0.8, braces)
    >>> branch = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (0.5, 15.0))
    >>> rk.plot.grazing_transition(rk.grazing_transition(branch.special[-1])).get_xlabel()
    'relative distance in amplitude'
    """
    instance("result", result, GrazingTransition)
    units = np.isfinite(result.farthest)
    if not units.any():
        raise Refusal("result", "hold a motion that does not overturn to be drawn", "none")
    x, far, near = (values[units] for values in (result.distances, result.farthest, result.nearest))
    ax = style.own(ax, height=2.9)
    if result.kind in ("local", "undecided"):
        ax.plot(
            x,
            far[-1] * np.sqrt(x / x[-1]),
            color=style.INK,
            linewidth=style.LINE,
            linestyle=(0, (5, 2)),
            label="square root",
            gid="square-root",
        )
    for values, marker, filled, name in ((far, "o", True, "farthest"), (near, "s", False, "nearest")):
        ax.plot(
            x,
            values,
            marker,
            color=style.MOTION,
            markerfacecolor=style.MOTION if filled else "none",
            markersize=style.MARK if filled else 1.6 * style.MARK,
            label=f"{name} point",
            gid=name,
        )
    name = result.special.name.replace("_", " ")
    style.label(ax, f"relative distance in {name}", "distance from the grazing orbit")
    ax.set_xscale("log")
    ax.set_yscale("log")
    low, high = ax.get_ylim()
    if high < 10.0 * low:
        # points after a jump are almost equal: over less than a decade their differences would seem large
        ax.set_ylim(math.sqrt(0.1 * low * high), math.sqrt(10.0 * low * high))
    style.logarithmic(ax.xaxis)
    style.logarithmic(ax.yaxis)
    style.key(ax)
    return ax
