"""Safe fraction of initial states over the amplitude, with the thresholds A* and A_M."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from rocking.model.block import Block
from rocking.model.survey_results import SafeBasin
from rocking.model.validation import instance
from rocking.plot.parts import style
from rocking.plot.parts.axis_units import parameter


def safe_basin(found: SafeBasin, ax: Axes | None = None, block: Block | None = None) -> Axes:
    """Plot the fraction of initial states that do not overturn, with its 95 % interval, over the amplitude.

    Parameters
    ----------
    found : SafeBasin
        Result of `rocking.safe_basin`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes and a title. Default: normalised axes.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `found` is not a SafeBasin, or an argument has the wrong type.

    See Also
    --------
    basins : Plot the basins at one amplitude.
    rocking.safe_basin : Compute the fractions.

    Examples
    --------
    >>> import rocking as rk
    >>> found = rk.safe_basin(amplitude=[3.3, 3.7, 5.5], period=1.0, restitution=0.8, samples=200)
    >>> rk.plot.safe_basin(found).get_ylabel()
    'safe fraction (%)'
    """
    instance("found", found, SafeBasin)
    level, x_label = parameter("amplitude", block)
    ax = style.own(ax, height=2.9)
    style.block_title(ax, block)
    data = found.dataset
    across = level(data.amplitude.values)
    ax.fill_between(
        across, 100 * data.safe_low, 100 * data.safe_high, color=style.MOTION, alpha=0.3, linewidth=0
    )
    ax.plot(
        across,
        100 * data.safe,
        color=style.MOTION,
        linewidth=style.LINE,
        marker="o",
        markersize=style.point_size(across.size),
        label="safe, 95 % interval",
        clip_on=False,  # points at 100 % lie on the frame
        gid="safe",
    )
    if np.isfinite(found.heteroclinic_amplitude):
        ax.axvline(
            level(found.heteroclinic_amplitude),
            color=style.IMPACT,
            linewidth=style.LINE,
            label="exact tangency $A^*$",
        )
        ax.axvline(
            level(found.melnikov_amplitude),
            color=style.INK,
            linewidth=style.LINE,
            linestyle=(0, (5, 2)),
            label="Melnikov's $A_M$",
        )
    style.label(ax, x_label, "safe fraction (%)")
    ax.set_ylim(bottom=0.0)
    style.key(ax)
    return ax
