"""Bifurcation set: the curves of all types in the plane of two parameters, alone or over a map."""

from matplotlib.axes import Axes
from matplotlib.patheffects import Normal, Stroke

from rocking.model.block import Block
from rocking.model.validation import instance
from rocking.orbits.bifurcation_set import BifurcationSet
from rocking.plot.bifurcation_curve import LOOKS
from rocking.plot.parts import codimension_two, style
from rocking.plot.parts.axis_units import parameter
from rocking.plot.parts.branch_lines import unless_there

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
        Block for SI axes. Default: normalised axes.

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
    >>> found = rk.bifurcation_set(system, 1, grid=3, period=(1.5, 2.5), amplitude=(3.0, 12.0))
    >>> [text.get_text() for text in rk.plot.bifurcation_set(found).get_legend().get_texts()]
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
    codimension_two.mark(ax, result.curves, across, upright)
    style.label(ax, x_label, y_label)
    if result.curves:
        style.key_beside(ax)
    if is_new:
        ax.set_xlim(*(float(across(end)) for end in result.bounds[0]))
        ax.set_ylim(*(float(upright(end)) for end in result.bounds[1]))
    return ax
