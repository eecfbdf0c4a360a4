"""Bifurcation curves of periodic orbits in the plane of two parameters."""

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes

from rocking.model.block import Block
from rocking.model.validation import refuse_if
from rocking.orbits.bifurcation_curve import BifurcationCurve
from rocking.plot import palette
from rocking.plot.parts import codimension_two, style
from rocking.plot.parts.axis_units import parameter
from rocking.plot.parts.branch_lines import several, unless_there

LOOKS: dict[str, tuple[str, Any]] = {
    "fold": (palette.FOLD, "-"),
    "symmetry-breaking": (palette.SYMMETRY_BREAKING, (0, (5, 2))),
    "period-doubling": (palette.PERIOD_DOUBLING, (0, (6, 2, 1, 2))),
    "grazing": (style.INK, (0, (1, 1.5))),
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
        Block for SI axes. Default: normalised axes.

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
    codimension_two.mark(ax, each, across, upright)
    style.label(ax, x_label, y_label)
    style.key(ax)
    return ax
