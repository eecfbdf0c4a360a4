"""Response diagrams: type of response, largest exponent and rotation number over a parameter."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rocking.model.block import Block
from rocking.model.validation import instance
from rocking.orbits.response_diagram_result import ResponseDiagram
from rocking.plot.parts import branch_lines, figures, style
from rocking.plot.parts.axis_units import parameter, quantities
from rocking.plot.parts.legend import LOOKS, Look, looks

HEIGHT, ROW = 4.4, 0.16
RATIOS = (1, 8, 8)
# Size of a mark relative to the usual size, because the points lie close together in lines.
MARK = 0.6
ASIDE = 0.03
# Height of the triangles that mark an exponent of −∞, as a fraction of the axes' height.
BELOW = 0.03


def response_diagram(result: ResponseDiagram, block: Block | None = None) -> Figure:
    """Plot the type of response, the largest Lyapunov exponent and the rotation number over a parameter.

    Parameters
    ----------
    result : ResponseDiagram
        Result of `rocking.response_diagram`.
    block : Block, optional
        Block for SI axes. Default: normalised axes.

    Returns
    -------
    matplotlib Figure
        Three panels: bands in the colours of the types of response, as in `parametric_map`; exponents; rotation numbers.

    Raises
    ------
    TypeError
        If `result` is not a ResponseDiagram, or `block` is not a Block.

    See Also
    --------
    orbit_diagram : Plot section points over a parameter.
    rocking.response_diagram : Compute the diagram.

    Notes
    -----
    A band ends half-way to the next value. Bars are standard errors. A hollow mark is a value without a finite error, and a
    triangle at the bottom an exponent of −∞. A value that is not known has no mark.

    Examples
    --------
    >>> import numpy as np, rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=9.0, period=1.721328), restitution=0.8)
    >>> found = rk.response_diagram(system, "amplitude", np.linspace(10.0, 11.0, 21))
    >>> [text.get_text() for text in rk.plot.response_diagram(found).axes[2].get_legend().get_texts()]
    ['period 1, asymmetric', 'even period', 'chaotic', 'overturned']
    """
    instance("result", result, ResponseDiagram)
    shown = quantities(block)
    across, x_label = parameter(result.parameter, block)
    codes = looks(
        np.array([verdict.kind.code for verdict in result.verdicts]), result.period, result.symmetric
    )
    keys = np.unique(codes)
    figure = figures.new(style.COLUMN, HEIGHT + ROW * (-(-len(keys) // 2)))
    bands, exponents, rotation = figure.subplots(3, 1, sharex=True, height_ratios=RATIOS)
    values = across(result.values)
    _bands(bands, values, codes)
    _points(
        exponents, values, shown.frequency(result.exponent), shown.frequency(result.exponent_error), codes
    )
    exponents.axhline(0.0, color=style.INK, linewidth=style.THIN, zorder=1, gid="zero")
    _triangles(exponents, values[np.isneginf(result.exponent)])
    _points(rotation, values, result.rotation, result.rotation_error, codes)
    style.label(exponents, "", r"exponent $\lambda_1$ " + (r"per $\tau$" if block is None else "(1/s)"))
    style.label(rotation, x_label, "rotation number\n(impacts per cycle)")
    if values[-1] > values[0]:
        margin = ASIDE * (values[-1] - values[0])
        rotation.set_xlim(values[0] - margin, values[-1] + margin)
    for letter, ax in zip("abc", (bands, exponents, rotation), strict=True):
        style.title(ax, f"({letter})")
    style.patches(rotation, [_key(LOOKS[code]) for code in keys])
    return figure


def _bands(ax: Axes, values: np.ndarray, codes: np.ndarray) -> None:
    """Draw the intervals of each category. Their outlines keep the narrowest ones visible."""
    for code in np.unique(codes):
        look = LOOKS[code]
        ends = branch_lines.spans(values, codes == code).reshape(-1, 3)
        ax.broken_barh(
            [(low, high - low) for low, high, _ in ends.tolist()],
            (0.0, 1.0),
            facecolor=look.colour,
            edgecolor=look.hatch or look.colour,
            hatch="////" if look.hatch else None,
            linewidth=0.0 if look.hatch else style.THIN,
            gid=look.name,
        )
    ax.set(ylim=(0.0, 1.0), yticks=[])
    ax.tick_params(bottom=False, labelbottom=False)
    for spine in ax.spines.values():
        spine.set_visible(False)


def _points(ax: Axes, values: np.ndarray, heights: np.ndarray, errors: np.ndarray, codes: np.ndarray) -> None:
    """Draw one mark per known value in the colour of its category, hollow without a finite error, and bars of the errors."""
    size = MARK * style.point_size(len(values))
    for code in np.unique(codes):
        here, sure = (codes == code) & np.isfinite(heights), np.isfinite(errors)
        colour, edge = LOOKS[code].colour, LOOKS[code].hatch or LOOKS[code].colour
        barred = here & sure & (errors > 0.0)
        ax.errorbar(
            values[barred],
            heights[barred],
            yerr=errors[barred],
            fmt="none",
            ecolor=edge,
            elinewidth=style.THIN,
            gid="error",
        )
        for where, face in ((here & sure, colour), (here & ~sure, "white")):
            if where.any():
                ax.plot(
                    values[where],
                    heights[where],
                    linestyle="none",
                    marker="o",
                    markersize=size,
                    markeredgewidth=0.4,
                    markeredgecolor=edge,
                    markerfacecolor=face,
                    rasterized=where.sum() > style.MAX_MARKS,
                    gid=LOOKS[code].name,
                )


def _triangles(ax: Axes, values: np.ndarray) -> None:
    """Mark exponents of −∞ at the bottom of the axes."""
    if len(values):
        ax.plot(
            values,
            np.full(len(values), BELOW),
            transform=ax.get_xaxis_transform(),
            linestyle="none",
            marker="v",
            markersize=MARK * style.MARK,
            markeredgewidth=0,
            color=style.INK,
            gid="superstable",
        )


def _key(look: Look) -> Patch:
    return Patch(
        facecolor=look.colour,
        edgecolor=look.hatch or look.colour,
        hatch="////" if look.hatch else None,
        linewidth=0.0,
        label=look.name,
    )
