"""Plots of surveys under ground motions: fragility, incremental dynamic analysis, overturning sets."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rocking.model.record_results import (
    FRACTILES,
    Fragility,
    IncrementalDynamicAnalysis,
    LognormalFit,
    OverturningSet,
    checked_fractions,
)
from rocking.model.text import counted
from rocking.model.validation import Refusal, instance, refuse_if
from rocking.plot import palette, style
from rocking.plot.axes import level_label, limit_label
from rocking.plot.style import shortened

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


def fragility(result: Fragility, ax: Axes | None = None) -> Axes:
    """Plot fractions of runs that exceed each limit with their 95 % intervals, and the lognormal fits with their bands.

    Parameters
    ----------
    result : Fragility
        Result of `rocking.fragility`, with at most three limits and overturning.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If `result` is not a Fragility, `ax` is not Axes, or there are more than three limits.

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
    >>> result = rk.fragility(records, rk.Block(2.0, 0.5), np.linspace(2, 10, 9))
    >>> rk.plot.fragility(result).get_ylabel()
    'probability (%)'
    """
    instance("result", result, Fragility)
    data = result.dataset
    count = data.sizes["limit"]
    refuse_if(
        count > len(COLOURS), "result", f"have at most {len(COLOURS) - 1} limits to be drawn", count - 1
    )
    ax = style.own(ax, height=3.7)
    style.block_title(ax, result.block, full=result.dataset.attrs.get("model") == "full")
    levels = data.level.values
    shades = [*COLOURS[: count - 1], COLOURS[-1]]
    step = APART * float(np.diff(levels).min() if levels.size > 1 else ALONE * levels[0])
    for number, (colour, mark) in enumerate(zip(shades, [*MARKS[: count - 1], MARKS[-1]], strict=True)):
        of = data.isel(limit=number)
        beside = levels + step * (number - (count - 1) / 2)
        value, low, high = (100 * of[name].values for name in ("fraction", "fraction_low", "fraction_high"))
        if not result.fits[number].problem:
            _draw_fit(ax, result.fits[number], of, colour)
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
    style.label(ax, level_label(data.level), "probability (%)")
    ax.set_ylim(-2.0, 102.0)
    blocks = f" × {counted(data.sizes['sample'], 'block')}" if "sample" in data.sizes else ""
    style.note(ax, counted(data.sizes["record"], "record") + blocks)
    if levels.size == 1:
        ax.set_xticks(levels)  # marks beside each other have the same level
    _key(ax, result, shades)
    return ax


def _draw_fit(ax: Axes, fit: LognormalFit, of: Any, colour: str) -> None:
    """Draw the fit of one limit and its band."""
    from scipy.interpolate import PchipInterpolator

    levels = of.level.values
    fine = np.union1d(levels, np.linspace(levels[0], levels[-1], POINTS))
    low, high = (PchipInterpolator(levels, 100.0 * of[name].values)(fine) for name in ("fit_low", "fit_high"))
    ax.fill_between(fine, low, high, color=colour, alpha=SHADE, linewidth=0, gid="band")
    rocking = np.interp(fine, levels, of.rocking.values)
    ax.plot(fine, 100.0 * rocking * fit.probability(fine), color=colour, linewidth=style.LINE, gid="fit")


def _key(ax: Axes, result: Fragility, shades: list[str]) -> None:
    """Draw the legend: the limits by their marks, then the kinds of lines and marks that are there."""
    drawn = {each.get_gid() for each in (*ax.lines, *ax.collections)}
    fractions = result.dataset.fraction.values
    looks: dict[str, Any] = {"linestyle": "none", "markersize": style.MARK, "markeredgewidth": style.THIN}
    limits = result.dataset.limit.values.tolist()
    handles: list[Any] = [
        Line2D([], [], marker=mark, color=colour, label=limit_label(limit, result.block), **looks)
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


BEYOND = 1.15
"""End of the axis, in units of the largest peak that is drawn."""
SHADES = ((style.MOTION, (0, (5, 2))), (style.INK, "-"), (style.IMPACT, (0, (6, 2, 1, 2))))


def incremental_dynamic_analysis(
    result: IncrementalDynamicAnalysis, ax: Axes | None = None, *, fractiles: Any = FRACTILES
) -> Axes:
    r"""Plot the level of the intensity measure over the peak of each record, with fractiles over the records.

    Parameters
    ----------
    result : IncrementalDynamicAnalysis
        Result of `rocking.incremental_dynamic_analysis`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    fractiles : array (n,)
        One to three fractions in (0, 1], drawn thick. Default: 0.16, 0.5 and 0.84.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If `result` is not an IncrementalDynamicAnalysis, `ax` is not Axes, or a fraction lies outside (0, 1].

    See Also
    --------
    fragility : Plot the probability of overturning.
    rocking.incremental_dynamic_analysis : Compute the curves.

    Notes
    -----
    A curve becomes horizontal at the last level at which the block stands, and reaches the right edge. If the block stands
    again at a higher level, the curve returns from the right edge at that level.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records = rk.synthetic_ground_motions(5, seed=1)
    >>> result = rk.incremental_dynamic_analysis(records, rk.Block(2.0, 0.5), np.linspace(1, 3, 9))
    >>> rk.plot.incremental_dynamic_analysis(result).get_xlabel()
    'largest angle $|\\theta|$ (°)'
    """
    instance("result", result, IncrementalDynamicAnalysis)
    fractions = checked_fractions("fractiles", fractiles)
    if len(fractions) > len(SHADES):
        raise Refusal("fractiles", f"hold 1 to {len(SHADES)} fractions", fractiles)
    thick = result.fractiles(fractions)
    ax = style.own(ax, height=3.3)
    style.block_title(ax, result.block, full=result.dataset.attrs.get("model") == "full")
    data = result.dataset
    levels = data.level.values
    peaks = result.block.degrees(data.peak.transpose("record", "level").values)
    standing = peaks[np.isfinite(peaks)]
    edge = BEYOND * max(float(standing.max(initial=0.0)), float(result.block.degrees(1.0)))
    for number, each in enumerate(peaks):
        ax.plot(
            *flat_ended(each, levels, edge),
            color=style.GUIDE,
            linewidth=style.THIN,
            alpha=0.7,
            label="one record (horizontal end: overturns\nat the next level)" if number == 0 else None,
            gid="record",
            zorder=1,
        )
    for (colour, dashes), each in zip(SHADES, thick, strict=False):
        ax.plot(
            *flat_ended(result.block.degrees(each.values), levels, edge),
            color=colour,
            linestyle=dashes,
            linewidth=1.6 * style.LINE,
            label=f"{100.0 * float(each.fractile):g} % fractile",
            gid="fractile",
            zorder=3,
        )
    style.label(ax, r"largest angle $|\theta|$ (°)", level_label(data.level))
    ax.set_xlim(0.0, edge)
    ax.set_ylim(bottom=0.0)
    style.note(ax, counted(len(peaks), "record"))
    style.key(ax)
    return ax


def flat_ended(peaks: np.ndarray, levels: np.ndarray, edge: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the line of one record, with horizontal parts to the edge where the block overturns at the next level."""
    across: list[float] = []
    up: list[float] = []
    fell = np.isinf(peaks)
    for number, (peak, level) in enumerate(zip(peaks.tolist(), levels.tolist(), strict=True)):
        if fell[number]:
            continue
        if number > 0 and fell[number - 1]:
            across += [np.nan, edge]
            up += [np.nan, level]
        across.append(peak)
        up.append(level)
        if number + 1 < fell.size and fell[number + 1]:
            across.append(edge)
            up.append(level)
    return np.array(across), np.array(up)


ROW, REST, TALLEST = 0.24, 1.0, 9.0
"""Height of a row and of everything else, and of the tallest figure, in inches."""
BAND = 0.7
EDGE = 0.3
NARROWEST = 1 / 200
"""Width of the narrowest band, as a fraction of the range, so that it remains visible."""
MAX_NAMED, LONGEST_NAME = 36, 18
NUMBERED = 10
"""Number of rows, evenly spread, that carry a number where there are too many records for names."""


def overturning_set(result: OverturningSet, ax: Axes | None = None) -> Axes:
    """Plot the levels at which each record overturns the block, as bands; between them the block stands.

    Parameters
    ----------
    result : OverturningSet
        Result of `rocking.overturning_set`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not an OverturningSet, or `ax` has the wrong type.

    See Also
    --------
    overturning_spectrum : Plot outcomes under one pulse.
    rocking.overturning_set : Compute the set.

    Notes
    -----
    A triangle marks the lowest overturning level of a record. A diamond below a band is a switch that rounding may have made. A band
    takes at least 1/200 of the range, so that the narrowest remain visible.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> records, cabinet = rk.synthetic_ground_motions(3, seed=1), rk.Block(height=2.0, width=0.5)
    >>> result = rk.overturning_set(records, cabinet, np.linspace(0.2, 2, 91), intensity="pga-g")
    >>> rk.plot.overturning_set(result).get_xlabel()
    'peak ground acceleration PGA (g)'
    """
    instance("result", result, OverturningSet)
    count = len(result.records)
    ax = style.own(ax, height=min(REST + ROW * count, TALLEST))
    style.block_title(ax, result.block, full=result.dataset.attrs.get("model") == "full")
    narrowest = float(np.ptp(result.levels)) * NARROWEST
    doubtful = result.undecided
    for row in range(count):
        bands = result.intervals(row)
        ax.broken_barh(
            [(low, max(high - low, narrowest)) for low, high in bands.tolist()],
            (row - BAND / 2, BAND),
            facecolor=palette.OVERTURNED[0],
            edgecolor=style.INK,
            linewidth=EDGE,
            gid=f"bands {row}",
        )
    ax.plot(
        result.lowest,
        np.arange(count) - BAND / 2,
        linestyle="none",
        marker="v",
        markersize=style.MARK,
        color=style.IMPACT,
        label="lowest found",
        gid="lowest",
    )
    if doubtful.size:
        ax.plot(
            doubtful["level"],
            doubtful["record"] + BAND / 2,
            linestyle="none",
            marker="D",
            markersize=style.MARK,
            markerfacecolor=palette.UNDETERMINED[0],
            markeredgecolor=style.INK,
            markeredgewidth=style.THIN,
            label="undecided",
            gid="undecided",
        )
    style.label(ax, intensity_label(result), "" if count <= MAX_NAMED else "record")
    ax.set_xlim(result.levels[0], result.levels[-1])
    ax.set_ylim(count - 0.5, -0.5)
    _name_rows(ax, result.records.names)
    bands_entry = Patch(
        facecolor=palette.OVERTURNED[0], edgecolor=style.INK, linewidth=EDGE, label="overturns"
    )
    ax.legend(handles=[bands_entry, *ax.lines], **style.BELOW, ncols=3, columnspacing=1.2)
    return ax


def intensity_label(result: OverturningSet) -> str:
    """Return the label of the axis of levels: quantity, symbol and unit."""
    measure = result.measure
    symbol = "" if measure.symbol in measure.long_name else f" {measure.symbol}"
    unit = "" if measure.unit in ("1", "") else f" ({measure.unit})"
    return f"{measure.long_name}{symbol}{unit}"


def _name_rows(ax: Axes, names: tuple[str, ...]) -> None:
    """Write the names of the records beside their rows; numbers from 0 where there are many, or where short names coincide."""
    if len(names) > MAX_NAMED:
        ax.set_yticks(np.arange(0, len(names), -(-len(names) // NUMBERED)))
        return
    short = [shortened(name, LONGEST_NAME) for name in names]
    if len(set(short)) < len(set(names)):
        short = [f"{row} {shortened(name, LONGEST_NAME - 3)}" for row, name in enumerate(names)]
    ax.set_yticks(np.arange(len(names)), short, fontsize=style.SMALL, color=style.INK)
    ax.tick_params(axis="y", length=0)
