"""Transition at a grazing: distance of the attractor beyond it from the grazing orbit."""

import math

import numpy as np
from matplotlib.axes import Axes

from rocking.model.validation import Refusal, instance
from rocking.orbits.grazing_transition import GrazingTransition
from rocking.plot.parts import style


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
    shown = np.isfinite(result.farthest)
    if not shown.any():
        raise Refusal("result", "hold a motion that does not overturn to be drawn", "none")
    x, far, near = (values[shown] for values in (result.distances, result.farthest, result.nearest))
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
