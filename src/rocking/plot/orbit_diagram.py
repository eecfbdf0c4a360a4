"""Orbit (bifurcation) diagrams: stroboscopic points over a parameter, with branches of periodic orbits."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import Normal, Stroke

from rocking.model.block import Block
from rocking.model.orbit import Stability
from rocking.model.validation import Refusal, WrongType, instance, members, one_of
from rocking.model.verdict import Kind
from rocking.orbits.branch import Branch
from rocking.orbits.orbit_diagram_result import OrbitDiagram
from rocking.plot.parts import branch_lines, style
from rocking.plot.parts.axis_units import parameter, quantities
from rocking.plot.parts.legend import COLOURS

WAYS = {
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
    branches: Sequence[Branch] = (),
    quantity: str = "angle",
    block: Block | None = None,
) -> Axes:
    """Plot an orbit (bifurcation) diagram; bars at the bottom mark overturning.

    Parameters
    ----------
    result : OrbitDiagram
        Result of `rocking.orbit_diagram`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    branches : sequence of Branch
        Branches of periodic orbits over the same parameter, from `rocking.continue_orbit`: stable solid, unstable dashed,
        neutral dash-dotted. Default: none.
    quantity : {"angle", "velocity", "peak"}
        Quantity to draw: Θ or Θ' at the section, or the largest |Θ| between sections. Default: "angle".
    block : Block, optional
        Block for SI axes. Default: normalised axes.

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
    >>> ax = rk.plot.orbit_diagram(rk.orbit_diagram(system, "amplitude", np.linspace(10.4, 10.8, 40), sweep="up"))
    >>> ax.get_xlabel(), len(ax.lines[0].get_xdata()) > 250
    ('amplitude $A$', True)
    """
    instance("result", result, OrbitDiagram)
    quantity = one_of("quantity", quantity, branch_lines.QUANTITIES)
    followed = [
        _checked(result, branch) for branch in members("branches", branches, "be a sequence of Branch")
    ]
    shown = quantities(block)
    across, x_label = parameter(result.parameter, block)
    upright = shown.velocity if quantity == "velocity" else shown.angle
    lines = [
        branch_lines.line(one, quantity, result.section_phase).shown(across, upright) for one in followed
    ]
    ax = style.own(ax, height=3.0)
    sizes = [
        _points(ax, result, row, way, quantity, across, upright) for row, way in enumerate(result.sweeps)
    ]
    for line in ax.lines[-len(sizes) :]:
        line.set_markersize(min(sizes))
    for stability in Stability:
        _branches(ax, lines, stability)
    style.label(ax, x_label, branch_lines.height_label(quantity, shown))
    _bars(ax, result, across)
    ends = across(result.values[[0, -1]])
    if ends[1] > ends[0]:  # if all runs overturned there are no points; branches may extend farther
        margin = ASIDE * (ends[1] - ends[0])
        ax.set_xlim(ends[0] - margin, ends[1] + margin)
    style.key(ax)
    return ax


def _points(ax: Axes, result: OrbitDiagram, row: int, way: str, quantity: str, across, upright) -> float:
    """Draw the points of one sweep; return the size of their marks."""
    name, colour = WAYS[way]
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
        gid=way,
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
    for row, way in enumerate(result.sweeps):
        if not result.overturned[row].any():
            continue
        ends = branch_lines.spans(result.values, result.overturned[row])
        edge = WAYS[way][1] if len(result.sweeps) > 1 else style.INK
        ax.plot(
            across(ends),
            np.full(len(ends), BAR * (row + 0.6)),
            transform=ax.get_xaxis_transform(),
            color=COLOURS[Kind.OVERTURNED],
            linewidth=THICK,
            solid_capstyle="projecting",
            path_effects=[Stroke(linewidth=THICK + EDGE, foreground=edge), Normal()],
            label="overturned" + (f", {way}" if len(result.sweeps) > 1 else ""),
            gid=f"overturned {way}",
        )
