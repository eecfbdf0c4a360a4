"""Schematic of the block on its base, with the symbols of its dimensions and angles."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Polygon, Rectangle
from numpy.typing import NDArray

from rocking.model.block import Block
from rocking.model.validation import instance, within
from rocking.plot import palette
from rocking.plot.parts import style
from rocking.plot.parts.film_scene import corners

STOUT = Block(height=2.0, width=1.0)
# Base motion and angle: readable on the colour of the block.
SHAKEN = palette.SERIES[3]


def schematic(ax: Axes | None = None, block: Block | None = None, lean: float = 0.5) -> Axes:
    """Draw the block of Eq. (1) (Yim & Lin 1991) tilted about its corner O, with H, B, R, θ, θcr, O, O' and the base motion.

    Parameters
    ----------
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block that gives the proportions. Default: a stout block of 2 to 1, whose angles are large enough to see.
    lean : float
        Angle drawn, as a fraction of the critical angle, in [−1, 1]. Default: 0.5.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If `lean` lies outside its range.

    See Also
    --------
    animation : Animate a motion of the block.

    Notes
    -----
    Angles and the base acceleration a_g are positive as drawn: clockwise, and to the right. A base accelerated to the
    right therefore tilts the block to the left.

    Examples
    --------
    >>> import rocking as rk
    >>> ax = rk.plot.schematic(block=rk.Block(height=3.0, width=1.0))
    >>> ax.get_aspect()
    1.0
    """
    block = STOUT if block is None else instance("block", block, Block)
    height, width = block.height, block.width
    critical = math.atan2(width, height)
    angle = within("lean", lean, -1.0, 1.0) * critical
    tilted = corners(height, width, angle)
    ax = style.own(ax, height=3.6)
    _base(ax, height, width)
    ax.add_patch(
        Polygon(tilted, facecolor=style.BLOCK, edgecolor=style.INK, linewidth=style.LINE, gid="block")
    )
    _sides(ax, tilted, height)
    _centre(ax, tilted, height)
    _angles(ax, tilted, height, critical, angle)
    for corner, name in ((tilted[1], "$O$"), (tilted[0], "$O'$")):
        ax.plot(*corner, "o", color=style.INK, markersize=3.5)
        _write(ax, name, (corner[0], -0.08 * height))
    ax.set_aspect("equal")
    ax.set_axis_off()
    return ax


def _base(ax: Axes, height: float, width: float) -> None:
    half, deep = width / 2 + 0.45 * height, 0.16 * height
    ax.add_patch(Rectangle((-half, -deep), 2 * half, deep, facecolor=style.TABLE, edgecolor="none"))
    ax.plot([-half, half], [0, 0], color=style.INK, linewidth=style.LINE)
    ax.set_xlim(-half, half)
    ax.set_ylim(-2.5 * deep, 1.3 * height)
    _arrow(ax, (-0.22 * height, -1.4 * deep), (0.22 * height, -1.4 * deep), SHAKEN, "-|>")
    _write(ax, r"$a_g = a_x \cos(\omega t + \varphi)$", (0.0, -2.1 * deep), SHAKEN)


def _sides(ax: Axes, tilted: NDArray, height: float) -> None:
    """Draw the dimension lines: H along the left side of the block, B above its top."""
    foot_left, foot_right, top_right, top_left = tilted
    gap = 0.08 * height
    for first, last, opposite, name in (
        (foot_left, top_left, foot_right, "$H$"),
        (top_left, top_right, foot_left, "$B$"),
    ):
        outward = (first - opposite) / np.linalg.norm(first - opposite)
        _arrow(ax, first + gap * outward, last + gap * outward, style.INK, "<|-|>")
        _write(ax, name, (first + last) / 2 + 1.9 * gap * outward)


def _centre(ax: Axes, tilted: NDArray, height: float) -> None:
    """Draw the centre of mass, its distance R from the corner O, and the weight."""
    pivot, centre = tilted[1], tilted.mean(axis=0)
    ax.plot(*zip(pivot, centre, strict=True), color=style.MOTION, linewidth=style.LINE)
    _write(ax, "$R$", pivot + 0.4 * (centre - pivot) - (0.06 * height, 0.0), style.MOTION)
    _arrow(ax, centre, centre - (0.0, 0.22 * height), style.INK, "-|>")
    _write(ax, "$Mg$", centre - (0.09 * height, 0.17 * height))
    ax.plot(*centre, "o", color=style.MOTION, markersize=4)


def _angles(ax: Axes, tilted: NDArray, height: float, critical: float, angle: float) -> None:
    """Draw θ between the vertical through O and the tilted side, and θcr between that side and the line to the centre of mass."""
    pivot = tilted[1]
    ax.plot(
        [pivot[0]] * 2,
        [0.0, 1.1 * height],
        color=style.INK,
        linestyle="dotted",
        linewidth=style.LINE,
    )
    side = 90.0 - math.degrees(angle)
    for radius, last, name, colour in (
        (0.72 * height, 90.0, r"$\theta$", SHAKEN),
        (0.36 * height, side + math.degrees(critical), r"$\theta_\mathrm{cr}$", style.MOTION),
    ):
        ax.add_patch(
            Arc(
                tuple(pivot),
                2 * radius,
                2 * radius,
                theta1=side,
                theta2=last,
                color=colour,
                linewidth=style.LINE,
            )
        )
        middle = math.radians((side + last) / 2)
        _write(
            ax,
            name,
            pivot + (radius + 0.08 * height) * np.array([math.cos(middle), math.sin(middle)]),
            colour,
            style.BLOCK,
        )


def _arrow(ax: Axes, tail, head, colour: str, shape: str) -> None:
    how = {"arrowstyle": shape, "color": colour, "linewidth": style.LINE, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", head, tail, arrowprops=how | {"mutation_scale": 8})


def _write(ax: Axes, text: str, place, colour: str = style.INK, behind: str = "none") -> None:
    box = {"facecolor": behind, "edgecolor": "none", "pad": 0.5}
    ax.text(
        place[0], place[1], text, color=colour, fontsize=style.TEXT + 1, ha="center", va="center", bbox=box
    )
