"""Plots of sweeps of a parameter: orbit diagrams and response diagrams."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.patheffects import Normal, Stroke

from rocking.model.block import Block
from rocking.model.orbit import Stability
from rocking.model.validation import Refusal, WrongType, instance, members, one_of
from rocking.model.verdict import Kind
from rocking.orbits.branch import Branch
from rocking.orbits.diagrams import OrbitDiagram, ResponseDiagram
from rocking.plot import branch_lines, figures, style
from rocking.plot.axes import parameter, units_of
from rocking.plot.palette import COLOURS, LOOKS, Look, looks

SWEEPS = {
    "up": ("swept up", style.MOTION),
    "down": ("swept down", style.IMPACT),
    "rest": ("from the initial state", style.MOTION),
}
# Room below the points for the bars that mark overturning, and their distance, as fractions of the axes' height.
ROOM, BAR = 0.07, 0.025
THICK, EDGE = 2.0, 1.2
ASIDE = 0.03
# A stable branch is visible on both sides of the points on it.
OUTLINE = 1.8
# Distance of distinct points, as a fraction of the height of the diagram.
FINEST = 1e-4
# Size of a mark relative to the usual size, because the points lie close together in lines.
MARK = 0.6


def orbit_diagram(
    result: OrbitDiagram,
    ax: Axes | None = None,
    block: Block | None = None,
    *,
    branches: Sequence[Branch] = (),
    quantity: str = "angle",
) -> Axes:
    """Plot an orbit (bifurcation) diagram; bars at the bottom mark overturning.

    Parameters
    ----------
    result : OrbitDiagram
        Result of `rocking.orbit_diagram`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.
    branches : sequence of Branch
        Branches of periodic orbits over the same parameter, from `rocking.continue_orbit`: stable solid, unstable dashed,
        neutral dash-dotted. Default: none.
    quantity : {"angle", "velocity", "peak"}
        Quantity to draw: Θ or Θ' at the section, or the largest |Θ| between sections. Default: "angle".

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not an OrbitDiagram, or an argument has the wrong type.
    ValueError
        If a branch has another parameter, or `quantity` is unknown.

    See Also
    --------
    branch : Plot branches alone.
    rocking.orbit_diagram : Compute the diagram.
    rocking.continue_orbit : Compute a branch.

    Notes
    -----
    Points at one value closer than 1/10,000 of the height are drawn once. Marks shrink as their number grows, and more than
    2,000 become an image inside a vector file, as in `section`.

    Examples
    --------
    >>> import numpy as np, rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=10.0, period=1.721328), restitution=0.8)
    >>> ax = rk.plot.orbit_diagram(rk.orbit_diagram(system, amplitude=np.linspace(10.4, 10.8, 40), sweep="up"))
    >>> ax.get_xlabel(), len(ax.lines[0].get_xdata()) > 250
    ('amplitude $A$', True)
    """
    instance("result", result, OrbitDiagram)
    quantity = one_of("quantity", quantity, branch_lines.QUANTITIES)
    followed = [
        _checked(result, branch) for branch in members("branches", branches, "be a sequence of Branch")
    ]
    units = units_of(block)
    across, x_label = parameter(result.parameter, block)
    upright = units.velocity if quantity == "velocity" else units.angle
    lines = [
        branch_lines.branch_line(one, quantity, result.section_phase).scaled(across, upright)
        for one in followed
    ]
    ax = style.own(ax, height=3.0)
    sizes = [
        _points(ax, result, row, sweep, quantity, across, upright) for row, sweep in enumerate(result.sweeps)
    ]
    for line in ax.lines[-len(sizes) :]:
        line.set_markersize(min(sizes))
    for stability in Stability:
        _branches(ax, lines, stability)
    style.label(ax, x_label, branch_lines.height_label(quantity, units))
    _bars(ax, result, across)
    ends = across(result.values[[0, -1]])
    if ends[1] > ends[0]:  # if all runs overturned there are no points; branches may extend farther
        margin = ASIDE * (ends[1] - ends[0])
        ax.set_xlim(ends[0] - margin, ends[1] + margin)
    style.key(ax)
    return ax


def _points(ax: Axes, result: OrbitDiagram, row: int, sweep: str, quantity: str, across, upright) -> float:
    """Draw the points of one sweep; return the size of their marks."""
    name, colour = SWEEPS[sweep]
    heights = (
        result.peak[row][:, None]
        if quantity == "peak"
        else result.points[row, :, :, branch_lines.COLUMNS[quantity]]
    )
    values, heights = _distinct(result.values, heights)
    count = len(values)
    size = MARK * style.point_size(count)
    ax.plot(
        across(values),
        upright(heights),
        linestyle="none",
        marker="o",
        markersize=size,
        markeredgewidth=0,
        color=colour,
        rasterized=count > style.MAX_MARKS,
        label=name,
        gid=sweep,
        zorder=2.0 - 0.1 * row,
    )
    return size


def _distinct(values: np.ndarray, heights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return every distinguishable point once, because a periodic motion repeats its points."""
    heights = np.sort(heights, axis=1)
    span = np.nanmax(heights, initial=-np.inf) - np.nanmin(heights, initial=np.inf)
    place = np.round(heights / (FINEST * span)) if span > 0.0 else heights
    new = np.isfinite(heights)
    new[:, 1:] &= place[:, 1:] != place[:, :-1]
    return np.repeat(values, new.sum(axis=1)), heights[new]


def _checked(result: OrbitDiagram, branch: Branch) -> Branch:
    if not isinstance(branch, Branch):
        raise WrongType("branches", "be a sequence of branches from continue_orbit", branch)
    if branch.name != result.parameter:
        raise Refusal("branches", f"run over {result.parameter}, as the diagram does", branch.name)
    return branch


def _branches(ax: Axes, lines: Sequence[branch_lines.Line], stability: Stability) -> None:
    """Draw the parts of the branches that have one stability."""
    width = style.THIN if stability is Stability.UNSTABLE else OUTLINE
    for line in lines:
        branch_lines.part(
            ax,
            line,
            stability,
            f"{stability} orbits",
            color=style.INK,
            linewidth=width,
            gid=f"{stability} branch",
            zorder=1.8,
        )


def _bars(ax: Axes, result: OrbitDiagram, across) -> None:
    """Draw one bar per sweep below the points, along the values at which the block overturned."""
    low, high = ax.get_ylim()
    ax.set_ylim(low - ROOM * (high - low), high)
    for row, sweep in enumerate(result.sweeps):
        if not result.overturned[row].any():
            continue
        ends = branch_lines.spans(result.values, result.overturned[row])
        edge = SWEEPS[sweep][1] if len(result.sweeps) > 1 else style.INK
        ax.plot(
            across(ends),
            np.full(len(ends), BAR * (row + 0.6)),
            transform=ax.get_xaxis_transform(),
            color=COLOURS[Kind.OVERTURNED],
            linewidth=THICK,
            solid_capstyle="projecting",
            path_effects=[Stroke(linewidth=THICK + EDGE, foreground=edge), Normal()],
            label="overturned" + (f", {sweep}" if len(result.sweeps) > 1 else ""),
            gid=f"overturned {sweep}",
        )


HEIGHT, ROW = 4.4, 0.16
RATIOS = (1, 8, 8)
# Size of a mark relative to the usual size, because the points lie close together in lines.
# Height of the triangles that mark an exponent of −∞, as a fraction of the axes' height.
BELOW = 0.03


def response_diagram(result: ResponseDiagram, block: Block | None = None) -> Figure:
    """Plot the type of response, the largest Lyapunov exponent and the rotation number over a parameter.

    Parameters
    ----------
    result : ResponseDiagram
        Result of `rocking.response_diagram`.
    block : Block, optional
        Block for SI axes. Default: that of the result. None: normalised axes.

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
    >>> result = rk.response_diagram(system, amplitude=np.linspace(10.0, 11.0, 21))
    >>> [text.get_text() for text in rk.plot.response_diagram(result).axes[2].get_legend().get_texts()]
    ['period 1, asymmetric', 'even period', 'chaotic', 'overturned']
    """
    instance("result", result, ResponseDiagram)
    units = units_of(block)
    across, x_label = parameter(result.parameter, block)
    codes = looks(
        np.array([verdict.kind.code for verdict in result.verdicts]), result.period, result.symmetric
    )
    keys = np.unique(codes)
    figure = figures.new(style.COLUMN, HEIGHT + ROW * (-(-len(keys) // 2)))
    bands, exponents, rotation = figure.subplots(3, 1, sharex=True, height_ratios=RATIOS)
    values = across(result.values)
    _bands(bands, values, codes)
    _response_points(
        exponents, values, units.frequency(result.exponent), units.frequency(result.exponent_error), codes
    )
    exponents.axhline(0.0, color=style.INK, linewidth=style.THIN, zorder=1, gid="zero")
    _triangles(exponents, values[np.isneginf(result.exponent)])
    _response_points(rotation, values, result.rotation, result.rotation_error, codes)
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


def _response_points(
    ax: Axes, values: np.ndarray, heights: np.ndarray, errors: np.ndarray, codes: np.ndarray
) -> None:
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
