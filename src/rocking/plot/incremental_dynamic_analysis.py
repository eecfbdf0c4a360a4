"""Curves of an incremental dynamic analysis: the level over the peak of each record."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from rocking.model.record_results import FRACTILES, IncrementalDynamicAnalysis, checked_fractions
from rocking.model.text import counted
from rocking.model.validation import Refusal, instance
from rocking.plot.parts import style
from rocking.plot.parts.intensity import level_label

BEYOND = 1.15
"""End of the axis, in units of the largest peak that is drawn."""
SHADES = ((style.MOTION, (0, (5, 2))), (style.INK, "-"), (style.IMPACT, (0, (6, 2, 1, 2))))


def incremental_dynamic_analysis(
    found: IncrementalDynamicAnalysis, ax: Axes | None = None, fractiles: Any = FRACTILES
) -> Axes:
    r"""Plot the level of the intensity measure over the peak of each record, with fractiles over the records.

    Parameters
    ----------
    found : IncrementalDynamicAnalysis
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
        If `found` is not an IncrementalDynamicAnalysis, `ax` is not Axes, or a fraction lies outside (0, 1].

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
    >>> found = rk.incremental_dynamic_analysis(records, rk.Block(2.0, 0.5), np.linspace(1, 3, 9))
    >>> rk.plot.incremental_dynamic_analysis(found).get_xlabel()
    'largest angle $|\\theta|$ (°)'
    """
    instance("found", found, IncrementalDynamicAnalysis)
    fractions = checked_fractions("fractiles", fractiles)
    if len(fractions) > len(SHADES):
        raise Refusal("fractiles", f"hold 1 to {len(SHADES)} fractions", fractiles)
    thick = found.fractiles(fractions)
    ax = style.own(ax, height=3.3)
    style.block_title(ax, found.block, full=found.dataset.attrs.get("model") == "full")
    data = found.dataset
    levels = data.scale.values
    peaks = found.block.degrees(data.peak.transpose("record", "scale").values)
    standing = peaks[np.isfinite(peaks)]
    edge = BEYOND * max(float(standing.max(initial=0.0)), float(found.block.degrees(1.0)))
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
            *flat_ended(found.block.degrees(each.values), levels, edge),
            color=colour,
            linestyle=dashes,
            linewidth=1.6 * style.LINE,
            label=f"{100.0 * float(each.fractile):g} % fractile",
            gid="fractile",
            zorder=3,
        )
    style.label(ax, r"largest angle $|\theta|$ (°)", level_label(data.scale))
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
