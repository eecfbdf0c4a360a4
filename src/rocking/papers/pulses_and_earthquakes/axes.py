"""Labels and legends of the figures, in the sizes of the package's figures."""

from __future__ import annotations

from matplotlib.axes import Axes

import rocking as rk

TEXT, SMALL = 9.0, 8.0
FIRST, SECOND, THIRD = rk.plot.palette.SERIES[:3]
INK = rk.plot.palette.INK


def finish(ax: Axes, across: str, up: str, columns: int = 2) -> None:
    """Label both axes, and draw the legend below them."""
    ax.set_xlabel(across, fontsize=TEXT, color=INK)
    ax.set_ylabel(up, fontsize=TEXT, color=INK)
    ax.tick_params(labelsize=SMALL, width=0.6, color=INK, labelcolor=INK)
    for side, spine in ax.spines.items():
        spine.set(visible=side in ("left", "bottom"), linewidth=0.6, edgecolor=INK)
    if ax.get_legend_handles_labels()[0]:
        ax.legend(
            loc="upper center",
            bbox_to_anchor=(0.5, 0.0),
            borderaxespad=3.8,
            fontsize=SMALL,
            labelcolor=INK,
            frameon=False,
            ncols=columns,
            handletextpad=0.6,
            columnspacing=1.2,
        )
