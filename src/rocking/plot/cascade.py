"""Cascade of period doublings: the distance of each to the next one."""

import numpy as np
from matplotlib.axes import Axes

from rocking.model.block import Block
from rocking.model.validation import Refusal, instance
from rocking.orbits.cascade import Cascade
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import parameter

FEIGENBAUM = 4.669201609
"""Limit of the ratio of neighbouring distances with losses (Feigenbaum 1978, J. Stat. Phys. 19, 25)."""
AREA_PRESERVING = 8.721097201
"""Limit of this ratio without losses (Greene et al. 1981, Physica D 3, 468)."""


def cascade(result: Cascade, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the distance of each period doubling to the next one over the period, and the universal ratio of these distances.

    Parameters
    ----------
    result : Cascade
        Result of `rocking.cascade`, with two period doublings or more.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes and a title. Default: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a Cascade, or an argument has the wrong type.
    ValueError
        If there are fewer than two period doublings, so that there is no distance.

    See Also
    --------
    branch : Plot branches.
    rocking.cascade : Follow a cascade.

    Notes
    -----
    Both axes are logarithmic, so that a constant ratio is a straight line. The dashed line passes through the last distance. Its
    ratio is 4.669 with losses (Feigenbaum 1978) and 8.721 without (Greene et al. 1981).

    Examples
    --------
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=10.46, period=1.721328), restitution=0.8)
    >>> doubling = rk.continue_orbit(rk.classify(system).orbit, "amplitude", (10.3, 10.9)).special[0]
    >>> rk.plot.cascade(rk.cascade(doubling, (10.3, 10.9), doublings=4)).get_ylabel()
    'distance in amplitude $A$'
    """
    instance("result", result, Cascade)
    if len(result.special) < 2:
        raise Refusal("result", "hold two period doublings or more to be drawn", len(result.special))
    special = result.special[0]
    turn, shown_as = parameter(special.name, block)
    distances = np.abs(np.diff(turn(result.values)))
    periods = result.periods[:-1]
    system = special.orbit.system
    braces = 1.0 if system.braces is None else system.braces.restitution
    ratio = AREA_PRESERVING if system.restitution == braces == 1.0 else FEIGENBAUM
    ax = style.own(ax, height=2.9)
    style.block_title(ax, block)
    ax.plot(
        periods,
        distances[-1] * ratio ** np.log2(periods[-1] / periods),
        color=style.INK,
        linewidth=style.LINE,
        linestyle=(0, (5, 2)),
        label=f"ratio {ratio:.3f}",
        gid="universal",
    )
    ax.plot(
        periods,
        distances,
        "o",
        color=style.MOTION,
        markersize=style.MARK,
        label="to next doubling",
        gid="distances",
    )
    # in one line, the label of a coefficient of restitution is longer than the figure is high
    distance = f"distance in {shown_as}".replace(" coefficient", "\ncoefficient")
    style.label(ax, "period of the orbit (forcing cycles)", distance)
    ax.set_xscale("log", base=2)
    ax.set_xticks(periods, [f"{period}" for period in periods])
    ax.set_yscale("log")
    style.logarithmic(ax.yaxis)
    style.key(ax)
    return ax
