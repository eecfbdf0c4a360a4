"""Figures of the page as SVG text: the block drawn to scale, and any figure of `rocking.plot`."""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from attrs import frozen

from rocking.model.block import Block

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SCALES = (1, 2, 5, 10, 20, 25, 50, 100, 200, 500, 1000, 2000, 5000, 10_000)
"""Scales 1 : n, the largest that fits is taken."""
PAPER = (0.06, 0.06)
"""Largest width and height of the drawn block on paper, m."""
SIDE, BELOW, ABOVE = 0.024, 0.018, 0.008
"""Margins of the drawing on paper, m: at both sides, below the base and above the block."""
DEEP, GAP = 0.004, 0.0015
"""Depth of the base, and distance of texts from lines, on paper, m."""
BESIDE = 0.0185
"""Distance of the line of the height from a side with the value of an angle, on paper, m."""
INCH = 0.0254


@frozen
class Drawing:
    """Figure as SVG, with its size on paper in mm."""

    svg: str
    width: float
    text: str


def svg_of(draw: Callable[[], Any]) -> str:
    """Return the figure that a function makes as the text of an SVG file, the same for the same figure."""
    from matplotlib import rc_context

    from rocking.plot.figures import METADATA, apart

    stream = io.StringIO()
    with apart(), rc_context({"svg.hashsalt": "rocking"}):
        draw().figure.savefig(stream, format="svg", metadata=METADATA[".svg"])
    return stream.getvalue()


def scale_of(block: Block) -> int:
    """Return n of the scale 1 : n at which a block fits on the page.

    Examples
    --------
    >>> scale_of(Block(2.0, 0.6)), scale_of(Block(0.3, 0.1))
    (50, 5)
    """
    needed = max(block.width / PAPER[0], block.height / PAPER[1])
    return next((scale for scale in SCALES if scale >= needed), SCALES[-1])


def millimetres(metres: float) -> str:
    """Return a length in mm, to four digits at least.

    Examples
    --------
    >>> millimetres(2.0), millimetres(0.0123456)
    ('2,000 mm', '12.35 mm')
    """
    value = 1e3 * metres
    return f"{value:,.0f} mm" if abs(value - round(value)) < 1e-6 or abs(value) >= 1000 else f"{value:.4g} mm"


def block_to_scale(block: Block) -> Drawing:
    """Return the drawing of a block: outline, mass centre, critical angles and sizes, at a stated scale."""
    from matplotlib.figure import Figure

    scale = scale_of(block)
    paper = block.width / scale + 2 * SIDE, block.height / scale + BELOW + ABOVE

    def draw() -> Figure:
        figure = Figure(figsize=(paper[0] / INCH, paper[1] / INCH))
        ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        ax.set_axis_off()
        ax.set_xlim(-block.width / 2 - SIDE * scale, block.width / 2 + SIDE * scale)
        ax.set_ylim(-BELOW * scale, block.height + ABOVE * scale)
        _outline(ax, block, scale)
        _angles(ax, block, scale)
        _sizes(ax, block, scale)
        return figure

    edges = "" if block.offset == 0 else f", {millimetres(block.edges[1])} from the left edge"
    wall = "" if block.wall is None else ", against a wall at its left"
    at = f"mass centre {millimetres(block.centre_height)} above the base{edges}{wall}"
    return Drawing(svg_of(draw), 1e3 * paper[0], f"Block, drawn to scale 1 : {scale:,}; {at}.")


def _outline(ax: Axes, block: Block, scale: int) -> None:
    """Draw the base, the block and its wall."""
    from matplotlib.patches import Rectangle

    from rocking.plot import style
    from rocking.plot.film import wall_of

    half, deep = block.width / 2, DEEP * scale
    start, end = -half - 0.8 * SIDE * scale, half + 0.8 * SIDE * scale
    ax.add_patch(Rectangle((start, -deep), end - start, deep, color=style.TABLE, linewidth=0))
    ax.plot((start, end), (0, 0), color=style.INK, linewidth=style.LINE)
    look: dict[str, Any] = {"facecolor": style.BLOCK, "edgecolor": style.INK, "linewidth": style.LINE}
    ax.add_patch(Rectangle((-half, 0), block.width, block.height, **look))
    if block.wall is not None:
        ax.add_patch(wall_of(block))


def _angles(ax: Axes, block: Block, scale: int) -> None:
    """Draw the mass centre and the critical angles: that of the left edge with its value if it differs, and none at a wall."""
    from matplotlib.patches import Arc

    from rocking.plot import style

    centre = block.offset, block.centre_height
    reach = min(0.4 * block.centre_height, 0.03 * scale)
    right, left = map(math.degrees, block.critical_angles)
    corners = [
        (block.width / 2, right, 90.0, 90.0 + right, "left"),
        (-block.width / 2, left, 90.0 - left, 90.0, "right"),
    ]
    for corner, angle, start, end, side in corners[: 2 if block.wall is None else 1]:
        ax.plot((corner, centre[0]), (0, centre[1]), color=style.MOTION, linewidth=style.LINE)
        ax.add_patch(Arc((corner, 0), 2 * reach, 2 * reach, theta1=start, theta2=end, color=style.INK))
        if side == "left" or block.is_unsymmetric:
            at = corner + math.copysign(GAP * scale, corner), reach
            text = rf"$\theta_\mathrm{{cr}}$ = {angle:.1f}°"
            ax.annotate(text, at, ha=side, va="center", fontsize=style.SMALL)
    ax.plot(*centre, "o", color=style.MOTION, markersize=style.MARK)


def _sizes(ax: Axes, block: Block, scale: int) -> None:
    """Draw the height at the left, or at the free side of a block against a wall, and the width below, with their values."""
    from rocking.plot import style

    arrow: dict[str, Any] = {
        "arrowstyle": "<|-|>",
        "color": style.INK,
        "linewidth": style.THIN,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    half, height = block.width / 2, block.height
    small: dict[str, Any] = {"fontsize": style.SMALL}
    apart, below = (4 * GAP if block.left is None else BESIDE) * scale, -2 * DEEP * scale
    side, aligned = (-1, "right") if block.wall is None else (1, "left")
    along = side * (half + apart)
    ax.annotate("", (along, 0), (along, height), arrowprops=arrow)
    at = along + side * GAP * scale, height / 2
    ax.annotate(millimetres(height), at, ha=aligned, va="center", rotation=90, **small)
    ax.annotate("", (-half, below), (half, below), arrowprops=arrow)
    ax.annotate(millimetres(block.width), (0, below - GAP * scale), ha="center", va="top", **small)
