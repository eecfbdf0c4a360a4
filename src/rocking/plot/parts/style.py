"""How every picture looks: sizes, colours and labels, in one place.

Sizes are chosen for a journal's column (88 mm wide). The colours are those of Okabe and Ito, which colour-blind readers
tell apart. Everything is set on the artists themselves; matplotlib's global settings and backend are never touched.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator
from numpy.typing import NDArray

from rocking.model import Block, instance, members, refusal, whole, within

COLUMN = 3.5
PAGE = 7.2
TEXT = 9.0
SMALL = 8.0
LINE = 1.0
THIN = 0.6
MARK = 4.0
# More than these become an image inside a vector file, which would grow without end.
MAX_PANELS = 100
MAX_MARKS = 2_000
CELLS = 4096
ROUNDING = 1e-9
MAX_CORNERS = 50_000

MOTION = "#0072B2"
IMPACT = "#D55E00"
BRACE = "#009E73"
TABLE = "#CFCFCF"
BLOCK = "#E8C07D"
INK = "#262626"
GUIDE = "#9A9A9A"

# Of lines where what they say no longer holds.
DOTTED = (0, (1, 1.5))

# A legend under the label of the horizontal axis, clear of titles and of what is drawn.
BELOW: dict[str, Any] = {
    "loc": "upper center",
    "bbox_to_anchor": (0.5, 0.0),
    "borderaxespad": 3.8,  # in sizes of its text: past the ticks' numbers and the label
    "fontsize": SMALL,
    "labelcolor": INK,
    "frameon": False,
}


def own(ax: Axes | None, height: float = 2.4) -> Axes:
    """The axes given, or those of a new figure, a column wide and `height` inches high, which needs no display."""
    if ax is not None:
        return instance("ax", ax, Axes)
    return Figure(figsize=(COLUMN, height), layout="constrained").add_subplot()


def panels(rows: int = 1, columns: int = 1, height: float = 2.4, ratios: tuple[float, ...] | None = None):
    """A new figure of `rows` × `columns` axes, each row `height` inches high: a column wide, or a page if they stand abreast.

    Parameters
    ----------
    rows, columns : int
        How many axes, top to bottom and left to right.
    height : float
        Of one row, in inches.
    ratios : tuple of float, optional
        Relative widths of the columns.

    Returns
    -------
    tuple
        The matplotlib figure and its axes in reading order, lettered (a), (b), … where there are several.

    Raises
    ------
    TypeError, ValueError
        For numbers that lie outside their range, and for `ratios` that are not one a column.

    See Also
    --------
    title : Write a title above a panel.
    save : Write a figure to a file.

    Examples
    --------
    >>> import rocking as rk
    >>> figure, (left, right) = rk.plot.panels(columns=2, ratios=(2, 1))
    >>> left.get_title(loc="left"), right.get_title(loc="left")
    ('(a)', '(b)')
    """
    rows, columns = whole("rows", rows, 1, MAX_PANELS), whole("columns", columns, 1, MAX_PANELS)
    height = within("height", height, 0.1, 100.0)
    if ratios is not None:
        allowed = f"be {columns} positive numbers, one a column"
        ratios = tuple(within("ratios", each, 0.0, 1e6) for each in members("ratios", ratios, allowed))
        if len(ratios) != columns or min(ratios) == 0.0:
            raise ValueError(refusal("ratios", allowed, ratios))
    figure = Figure(figsize=(COLUMN if columns == 1 else PAGE, height * rows), layout="constrained")
    axes = list(figure.subplots(rows, columns, squeeze=False, width_ratios=ratios).flat)
    for letter, ax in zip("abcdefghijkl", axes, strict=False):
        if len(axes) > 1:
            title(ax, f"({letter})")
    return figure, axes


def title(ax: Axes, text: str) -> None:
    """Writes `text` above the axes at the left; a panel's letter already there stays in front of it.

    See Also
    --------
    panels : Make a figure with panels.
    """
    letter = instance("ax", ax, Axes).get_title(loc="left")
    ax.set_title(f"{letter} {text}" if letter else text, loc="left", fontsize=TEXT, color=INK)


def block_title(ax: Axes, block: Block | None) -> None:
    """Names the block of a picture in SI above the axes at the left."""
    if block is not None:
        title(ax, f"block {block.size}")


def note(ax: Axes, text: str) -> None:
    """Writes `text`, small, above the axes at the right."""
    ax.set_title(text, loc="right", fontsize=SMALL, color=INK)


def label(ax: Axes, x: str, y: str) -> None:
    """Labels both axes with symbol and unit, and gives ticks and frame their sizes; few ticks, so that numbers fit."""
    ax.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
    ax.set_xlabel(x, fontsize=TEXT, color=INK)
    ax.set_ylabel(y, fontsize=TEXT, color=INK)
    ax.tick_params(labelsize=SMALL, color=INK, labelcolor=INK, width=THIN)
    for axis in (ax.xaxis, ax.yaxis):
        axis.get_offset_text().set(fontsize=SMALL, color=INK)
    for side, spine in ax.spines.items():
        spine.set(visible=side in ("left", "bottom"), linewidth=THIN, edgecolor=INK)


def logarithmic(axis: Axis) -> None:
    """Ticks of a logarithmic axis, already labelled: at powers of ten, five or so, and at 2 and 5 between a few; no others."""
    low, high = axis.get_view_interval()
    between = (1.0, 2.0, 5.0) if high < 100.0 * low else (1.0,)
    axis.set_major_locator(LogLocator(subs=between, numticks=6))
    axis.set_minor_locator(NullLocator())


def key(ax: Axes) -> None:
    """A legend of what is drawn; its marks never shrink."""
    legend = ax.legend(**BELOW, ncols=2, handletextpad=0.2, columnspacing=1.2)
    for mark in legend.get_lines():
        mark.set(markersize=MARK, markeredgewidth=0.8)


def patches(ax: Axes, handles: list, columns: int = 2) -> None:
    """A legend of coloured patches."""
    ax.legend(handles=handles, **BELOW, ncols=columns)


def point_size(count: int) -> float:
    """Diameter in points of one of `count` markers: 10 are seen one by one, 10⁶ still show where they are dense.

    The area falls as 1/√count, so that the ink grows with the number of points but does not flood the picture.
    """
    return min(5.0, max(0.25, 5.0 * (max(count, 10) / 10) ** -0.25))


def places(x: NDArray[np.float64], y: NDArray[np.float64]) -> int:
    """How many of the points are seen apart: of those in one of 4096 × 4096 cells one counts, however often it is met."""
    cells = np.zeros(len(x))
    for values in (x, y):
        # a spread of rounding is none
        span = max(float(np.ptp(values)), ROUNDING * float(np.abs(values).max()))
        if span > 0.0:
            cells = cells * (CELLS + 1) + np.rint((values - values.min()) * (CELLS / span))
    return len(np.unique(cells))


def line_width(count: int) -> float:
    """Width in points of a line that runs `count` times through the same region: it gets thinner from 20 times on."""
    return LINE * (max(count, 20) / 20) ** -0.35
