"""What a film shows: the block, its braces and the table they stand on, before ground that stays where it is."""

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon, Rectangle
from matplotlib.transforms import Affine2D
from numpy.typing import NDArray

from rocking.model import Block
from rocking.plot.parts import style


class Scene:
    """A block on a moving table, one frame after the other.

    Parameters
    ----------
    ax : Axes
        Drawn into, with equal scales and without a frame.
    block : Block
        The proportions.
    angles, base : arrays of shape (frames,)
        The block's angle (rad, clockwise positive) and the table's displacement (m), both as they shall be drawn.
    brace : float, optional
        The angle (rad) at which braces stop the block, as it shall be drawn.
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
        # This mark passes those on the ground, so that the table is seen to move.
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
        """Puts everything where it belongs in this frame; returns what has to be drawn, in that order."""
        self.shift.clear().translate(self.base[frame], 0.0)
        self.body.set_xy(self.outlines[frame])
        return self.parts


def _ground(ax: Axes, deep: float, far: float) -> None:
    """A line under the table with a mark every tenth of the block's height, a long one where the table's middle rests."""
    ax.axhline(-deep, color=style.INK, linewidth=style.LINE)
    marks = np.arange(-far, far, deep)
    lengths = np.where(np.abs(marks) < deep / 2, 0.7, 0.3) * deep
    lines = [[(mark, -deep - length), (mark, -deep)] for mark, length in zip(marks, lengths, strict=True)]
    ax.add_collection(LineCollection(lines, color=style.INK, linewidth=style.THIN), autolim=False)


def corners(height: float, width: float, angle: float) -> NDArray:
    """Corners of a block that leans by `angle` (rad, clockwise positive), (4, 2): foot left O', foot right O, top right, top left.

    The origin is the middle of its foot at rest. Positive angles turn it about its right corner O, negative ones about
    the left one O' (eqs. 1a, 1b of Yim and Lin 1991).
    """
    upright = np.array([[-width / 2, 0.0], [width / 2, 0.0], [width / 2, height], [-width / 2, height]])
    pivot = upright[1] if angle >= 0 else upright[0]
    cosine, sine = np.cos(angle), np.sin(angle)
    return pivot + (upright - pivot) @ np.array([[cosine, -sine], [sine, cosine]])
