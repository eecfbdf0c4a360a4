"""Fragility curves: fractions with intervals and lognormal fits with bands, over the intensity of the ground motion."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rocking.model.record_results import Fragility, LognormalFit
from rocking.model.text import counted
from rocking.model.validation import instance, refuse_if
from rocking.plot import palette
from rocking.plot.parts import style
from rocking.plot.parts.intensity import level_label, limit_label

COLOURS = palette.SERIES[:4]
MARKS = ("o", "s", "^", "D")
APART = 0.12
"""Distance between the marks of neighbouring limits at one level, in units of the distance between levels."""
ALONE = 0.1
"""Distance that takes the place of that between levels if there is one level, in units of the level."""
POINTS = 200
"""Number of levels at which a fit is drawn."""
SHADE = 0.2
"""Opacity of a band."""


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
    Marks of different limits lie slightly beside each other. A hollow mark has a fraction of 0 or 1. The fit is drawn from its
    median and dispersion. The fraction of the runs that rock, which multiplies it, is interpolated linearly between the
    levels. The band is known at the levels; monotone cubic interpolation joins its ends.

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
    ax = style.own(ax, height=3.7)
    style.block_title(ax, found.block, full=found.dataset.attrs.get("model") == "full")
    levels = data.scale.values
    shades = [*COLOURS[: count - 1], COLOURS[-1]]
    step = APART * float(np.diff(levels).min() if levels.size > 1 else ALONE * levels[0])
    for number, (colour, mark) in enumerate(zip(shades, [*MARKS[: count - 1], MARKS[-1]], strict=True)):
        of = data.isel(limit=number)
        beside = levels + step * (number - (count - 1) / 2)
        value, low, high = (100 * of[name].values for name in ("fraction", "fraction_low", "fraction_high"))
        if not found.fits[number].problem:
            _draw_fit(ax, found.fits[number], of, colour)
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
                clip_on=False,
                zorder=3,
                gid="fraction",
            )
    style.label(ax, level_label(data.scale), "probability (%)")
    ax.set_ylim(-2.0, 102.0)
    blocks = f" × {counted(data.sizes['sample'], 'block')}" if "sample" in data.sizes else ""
    style.note(ax, counted(data.sizes["record"], "record") + blocks)
    if levels.size == 1:
        ax.set_xticks(levels)  # marks beside each other have the same level
    _key(ax, found, shades)
    return ax


def _draw_fit(ax: Axes, fit: LognormalFit, of: Any, colour: str) -> None:
    """Draw the fit of one limit and its band."""
    from scipy.interpolate import PchipInterpolator

    levels = of.scale.values
    fine = np.union1d(levels, np.linspace(levels[0], levels[-1], POINTS))
    low, high = (PchipInterpolator(levels, 100.0 * of[name].values)(fine) for name in ("fit_low", "fit_high"))
    ax.fill_between(fine, low, high, color=colour, alpha=SHADE, linewidth=0, gid="band")
    rocking = np.interp(fine, levels, of.rocking.values)
    ax.plot(fine, 100.0 * rocking * fit.probability(fine), color=colour, linewidth=style.LINE, gid="fit")


def _key(ax: Axes, found: Fragility, shades: list[str]) -> None:
    """Draw the legend: the limits by their marks, then the kinds of lines and marks that are there."""
    drawn = {each.get_gid() for each in (*ax.lines, *ax.collections)}
    fractions = found.dataset.fraction.values
    looks: dict[str, Any] = {"linestyle": "none", "markersize": style.MARK, "markeredgewidth": style.THIN}
    limits = found.dataset.limit.values.tolist()
    handles: list[Any] = [
        Line2D([], [], marker=mark, color=colour, label=limit_label(limit, found.block), **looks)
        for limit, colour, mark in zip(limits, shades, (*MARKS[: len(limits) - 1], MARKS[-1]), strict=True)
    ]
    handles.append(
        Line2D([], [], marker="|", color=style.INK, label="95 % interval", **{**looks, "markersize": 8.0})
    )
    if "fit" in drawn:
        handles += [
            Line2D([], [], color=style.INK, linewidth=style.LINE, label="lognormal fit"),
            Patch(facecolor=style.INK, alpha=SHADE, label="95 % band of the fit"),
        ]
    if np.isin(fractions, (0.0, 1.0)).any():
        handles.append(
            Line2D(
                [],
                [],
                marker="o",
                color=style.INK,
                markerfacecolor="white",
                label="0 or 100 % of the runs",
                **looks,
            )
        )
    style.patches(ax, handles)
