"""Frequency response: branches of (1, n) orbits, and responses from rest."""

from itertools import cycle

import numpy as np
from matplotlib.axes import Axes

from rocking.model.block import Block
from rocking.model.orbit import Stability
from rocking.model.validation import instance
from rocking.model.verdict import Kind
from rocking.orbits.frequency_response_result import FrequencyResponse
from rocking.plot import palette
from rocking.plot.parts import branch_lines, style
from rocking.plot.parts.axis_units import parameter, quantities
from rocking.plot.parts.legend import COLOURS

# One colour for each n.
LINES = palette.SERIES[:-1]
# Position of the bar that marks overturning, and the room for it below the lines, as fractions of the axes' height.
BAR, ROOM = 0.02, 0.06
THICK = 2.0


def frequency_response(result: FrequencyResponse, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the largest |Θ| over period or frequency: stable orbits solid, unstable dashed, responses from rest as rings.

    Parameters
    ----------
    result : FrequencyResponse
        Result of `rocking.frequency_response`.
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
        If `result` is not a FrequencyResponse, or an argument has the wrong type.

    See Also
    --------
    branch : Plot branches.
    rocking.frequency_response : Compute the curve.

    Notes
    -----
    A ring shows the largest |Θ| of the response if it is periodic or at rest. For other responses it shows the largest |Θ| of
    the motion from its start. A bar at the bottom marks overturning from rest.

    Examples
    --------
    >>> import numpy as np, rocking as rk
    >>> found = rk.frequency_response(period=np.linspace(0.5, 2.5, 9), amplitude=2.0, restitution=0.925)
    >>> [text.get_text() for text in rk.plot.frequency_response(found).get_legend().get_texts()]
    ['(1, 1), stable', '(1, 3), stable', '(1, 3), unstable', 'from rest: periodic', 'from rest: overturned']
    """
    instance("result", result, FrequencyResponse)
    shown = quantities(block)
    across, x_label = parameter(result.parameter, block)
    ax = style.own(ax, height=3.0)
    for n, colour in zip(result.modes, cycle(LINES), strict=False):
        for stability in Stability:
            name = f"(1, {n}), {stability}"
            for branch in result.of(n):
                line = branch_lines.line(branch, "peak", 0.0).shown(across, shown.angle)
                branch_lines.part(ax, line, stability, name, color=colour, linewidth=style.LINE, gid=name)
    _from_rest(ax, result, across, shown.angle)
    style.label(ax, x_label, branch_lines.height_label("peak", shown))
    low, high = ax.get_ylim()
    ax.set_ylim(min(low, 0.0) - ROOM * (high - low), high)
    style.key(ax)
    return ax


def _from_rest(ax: Axes, result: FrequencyResponse, across, upright) -> None:
    """Draw a ring for each response from rest, in the colour of its type, and bars where the block overturns."""
    rest, values = result.rest, result.values
    heights = np.where(np.isnan(rest["steady_peak"]), rest["peak"], rest["steady_peak"])
    for kind, colour in COLOURS.items():
        here = rest["kind"] == kind.value
        if kind is Kind.OVERTURNED or not here.any():
            continue
        ax.plot(
            across(values[here]),
            upright(heights[here]),
            linestyle="none",
            marker="o",
            markersize=0.75 * style.MARK,
            markerfacecolor="none",
            markeredgecolor=colour,
            markeredgewidth=0.6,
            label=f"from rest: {kind.value}",
            gid=f"rest {kind.value}",
            zorder=2.5,
        )
    fell = rest["kind"] == Kind.OVERTURNED.value
    if fell.any():
        ends = branch_lines.spans(values, fell)
        ax.plot(
            across(ends),
            np.full(len(ends), BAR),
            transform=ax.get_xaxis_transform(),
            color=COLOURS[Kind.OVERTURNED],
            linewidth=THICK,
            solid_capstyle="butt",
            label="from rest: overturned",
            gid="overturned",
        )
