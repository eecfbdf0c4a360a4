"""Scene of an animation: the block, its braces and the moving table, in front of fixed ground."""

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon, Rectangle
from matplotlib.transforms import Affine2D
from numpy.typing import NDArray

from rocking.model.block import Block
from rocking.plot.parts import style


class Scene:
    """Block on a moving table, drawn frame by frame.

    Parameters
    ----------
    ax : Axes
        Axes to draw into; they get equal scales and no frame.
    block : Block
        Block that gives the proportions.
    angles, base : arrays of shape (frames,)
        Angle of the block (rad, clockwise positive) and displacement of the table (m), as drawn.
    brace : float, optional
        Angle (rad) at which the braces stop the block, as drawn. Default: no braces.
    """

    def __init__(
        self, ax: Axes, block: Block, angles: NDArray, base: NDArray, brace: float | None = None
    ) -> None:
        self.base = base
        self.outlines = np.array([corners(block.height, block.width, angle) for angle in angles])
        deep, post = 0.1 * block.height, 0.03 * block.height
        contact = None if brace is None else block.width / 2 + block.height * math.sin(brace)
        reach = np.abs([self.outlines[..., 0].min(), self.outlines[..., 0].max()])
        left, right = np.maximum(reach, (contact or 0.0) + post) + 0.15 * block.height
        far = float(np.abs(base).max())
        self.shift = Affine2D()
        self.body = Polygon(
            self.outlines[0], facecolor=style.BLOCK, edgecolor=style.INK, linewidth=style.LINE
        )
        self.parts: list[Artist] = [
            Rectangle((-left, -deep), left + right, deep, facecolor=style.TABLE),
            self.body,
        ]
        if contact is not None:
            for side in (-contact - post, contact):
                self.parts.append(Rectangle((side, 0), post, 1.04 * block.height, facecolor=style.BRACE))
        # This mark passes the marks on the ground and shows the motion of the table.
        self.parts.append(Line2D([0], [-0.6 * deep], marker="v", color=style.IMPACT, markersize=8))
        for part in self.parts:
            ax.add_artist(part)
            part.set_transform(self.shift + ax.transData)
            part.set_animated(True)
        _ground(ax, deep, 10 * block.height)
        top = 1.02 * max(float(self.outlines[..., 1].max()), 1.04 * block.height)
        ax.margins(0)
        ax.update_datalim([(-left - far, -2 * deep), (right + far, top)])
        ax.set_aspect("equal", adjustable="datalim")
        ax.set_axis_off()

    def move(self, frame: int) -> list[Artist]:
        """Place block and table for a frame; return the artists in the order in which they are drawn."""
        self.shift.clear().translate(self.base[frame], 0.0)
        self.body.set_xy(self.outlines[frame])
        return self.parts


def _ground(ax: Axes, deep: float, far: float) -> None:
    """Draw the ground with a mark at each tenth of the block's height; the mark at the origin is longer."""
    ax.axhline(-deep, color=style.INK, linewidth=style.LINE)
    marks = np.arange(-far, far, deep)
    lengths = np.where(np.abs(marks) < deep / 2, 0.7, 0.3) * deep
    lines = [[(mark, -deep - length), (mark, -deep)] for mark, length in zip(marks, lengths, strict=True)]
    ax.add_collection(LineCollection(lines, color=style.INK, linewidth=style.THIN), autolim=False)


def corners(height: float, width: float, angle: float) -> NDArray:
    """Return the corners of a block tilted by `angle` (rad, clockwise positive).

    Positive angles turn the block about its right corner O, negative angles about its left corner O' (Eqs. (1a), (1b) of
    Yim & Lin 1991). The origin is the middle of the foot at rest.

    Returns
    -------
    array of shape (4, 2)
        Foot left O', foot right O, top right and top left, m.
    """
    upright = np.array([[-width / 2, 0.0], [width / 2, 0.0], [width / 2, height], [-width / 2, height]])
    pivot = upright[1] if angle >= 0 else upright[0]
    cosine, sine = np.cos(angle), np.sin(angle)
    return pivot + (upright - pivot) @ np.array([[cosine, -sine], [sine, cosine]])
