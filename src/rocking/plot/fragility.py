"""Fragility curves: fractions with intervals and lognormal fits with bands, over the intensity of the ground motion."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from rocking.model import Fragility, counted, instance, refuse_if
from rocking.plot.parts import style
from rocking.plot.parts.intensity import level_label, limit_label

COLOURS = (style.MOTION, style.BRACE, style.BLOCK, style.IMPACT)
MARKS = ("o", "s", "^", "D")
APART = 0.12
"""Distance between the marks of neighbouring limits at one level, in units of the distance between levels."""


def fragility(found: Fragility, ax: Axes | None = None) -> Axes:
    """Plot fractions of runs that exceed each limit with their 95 % intervals, and the lognormal fits with their bands.

    Parameters
    ----------
    found : Fragility
        Result of `rocking.fragility`, with at most three limits and overturning.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If `found` is not a Fragility, `ax` is not Axes, or there are more than three limits.

    See Also
    --------
    incremental_dynamic_analysis : Plot the peaks of each record.
    rocking.fragility : Compute the fractions.

    Notes
    -----
    Marks of different limits lie slightly beside each other. A curve joins the fit at the levels by straight lines. A hollow
    mark has a fraction of 0 or 1.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(8, seed=1)
    >>> found = rk.fragility(records, rk.Block(2.0, 0.5), np.linspace(2, 10, 9))
    >>> rk.plot.fragility(found).get_ylabel()
    'probability (%)'
    """
    instance("found", found, Fragility)
    data = found.dataset
    count = data.sizes["limit"]
    refuse_if(count > len(COLOURS), "found", f"have at most {len(COLOURS) - 1} limits to be drawn", count - 1)
    ax = style.own(ax, height=3.3)
    style.block_title(ax, found.block)
    levels = data.scale.values
    shades = [*COLOURS[: count - 1], COLOURS[-1]]
    step = APART * float(np.diff(levels).min())
    for number, (colour, mark) in enumerate(zip(shades, [*MARKS[: count - 1], MARKS[-1]], strict=True)):
        of = data.isel(limit=number)
        beside = levels + step * (number - (count - 1) / 2)
        value, low, high = (100 * of[name].values for name in ("fraction", "fraction_low", "fraction_high"))
        ax.fill_between(
            levels, 100 * of.fit_low, 100 * of.fit_high, color=colour, alpha=0.2, linewidth=0, gid="band"
        )
        ax.plot(levels, 100 * of.fit, color=colour, linewidth=style.LINE, gid="fit")
        bars = np.array([value - low, high - value])
        ax.errorbar(
            beside,
            value,
            yerr=bars,
            color=colour,
            fmt="none",
            elinewidth=style.THIN,
            capsize=1.5,
            gid="interval",
        )
        label = limit_label(float(of.limit), found.block)
        for where, face in (((value > 0) & (value < 100), colour), ((value == 0) | (value == 100), "white")):
            ax.plot(
                beside[where],
                value[where],
                linestyle="none",
                marker=mark,
                markersize=0.8 * style.MARK,
                markeredgecolor=colour,
                markeredgewidth=style.THIN,
                markerfacecolor=face,
                label=label if face == colour else None,
                clip_on=False,
                zorder=3,
                gid="fraction",
            )
    style.label(ax, level_label(data.scale), "probability (%)")
    ax.set_ylim(-2.0, 102.0)
    blocks = f" × {counted(data.sizes['sample'], 'block')}" if "sample" in data.sizes else ""
    style.note(ax, counted(data.sizes["record"], "record") + blocks)
    style.key(ax)
    return ax
