"""Overturning sets: a row of bands per record, the levels that overturn the block."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch

from rocking.model.record_results import OverturningSet
from rocking.model.validation import instance
from rocking.plot import palette
from rocking.plot.parts import style
from rocking.plot.parts.names import shortened

ROW, REST, TALLEST = 0.24, 1.0, 9.0
"""Height of a row and of everything else, and of the tallest figure, in inches."""
BAND = 0.7
EDGE = 0.3
NARROWEST = 1 / 200
"""Width of the narrowest band, as a fraction of the range, so that it remains visible."""
MAX_NAMED, LONGEST_NAME = 36, 18
NUMBERED = 10
"""Number of rows, evenly spread, that carry a number where there are too many records for names."""


def overturning_set(found: OverturningSet, ax: Axes | None = None) -> Axes:
    """Plot the levels at which each record overturns the block, as bands; between them the block stands.

    Parameters
    ----------
    found : OverturningSet
        Result of `rocking.overturning_set`.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `found` is not an OverturningSet, or `ax` has the wrong type.

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
    >>> found = rk.overturning_set(records, cabinet, np.linspace(0.2, 2, 91), intensity="pga-g")
    >>> rk.plot.overturning_set(found).get_xlabel()
    'peak ground acceleration PGA (g)'
    """
    instance("found", found, OverturningSet)
    count = len(found.records)
    ax = style.own(ax, height=min(REST + ROW * count, TALLEST))
    style.block_title(ax, found.block, full=found.dataset.attrs.get("model") == "full")
    narrowest = float(np.ptp(found.scales)) * NARROWEST
    doubtful = found.undecided
    for row in range(count):
        bands = found.intervals(row)
        ax.broken_barh(
            [(low, max(high - low, narrowest)) for low, high in bands.tolist()],
            (row - BAND / 2, BAND),
            facecolor=palette.OVERTURNED[0],
            edgecolor=style.INK,
            linewidth=EDGE,
            gid=f"bands {row}",
        )
    ax.plot(
        found.lowest,
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
    style.label(ax, level_label(found), "" if count <= MAX_NAMED else "record")
    ax.set_xlim(found.scales[0], found.scales[-1])
    ax.set_ylim(count - 0.5, -0.5)
    _name_rows(ax, found.records.names)
    bands_entry = Patch(
        facecolor=palette.OVERTURNED[0], edgecolor=style.INK, linewidth=EDGE, label="overturns"
    )
    ax.legend(handles=[bands_entry, *ax.lines], **style.BELOW, ncols=3, columnspacing=1.2)
    return ax


def level_label(found: OverturningSet) -> str:
    """Return the label of the axis of levels: quantity, symbol and unit."""
    measure = found.measure
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
