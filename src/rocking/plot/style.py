"""Sizes, colours, labels and legends of all figures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from attrs import frozen
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import BoundaryNorm, LinearSegmentedColormap, ListedColormap
from matplotlib.ticker import LogFormatterSciNotation, LogLocator, MaxNLocator, NullLocator, ScalarFormatter
from numpy.typing import NDArray

from rocking.model.block import Block
from rocking.model.validation import Refusal, instance, members, one_of, refuse_if, whole, within
from rocking.plot import figures, palette

COLUMN = 3.5
PAGE = 7.2
TEXT = 9.0
SMALL = 8.0
LINE = 1.0
THIN = 0.6
MARK = 4.0
MAX_PANELS = 100
# More marks or corners become an image inside a vector file, which keeps the file small.
MAX_MARKS = 2_000
CELLS = 4096
ROUNDING = 1e-9
MAX_CORNERS = 50_000

MOTION, IMPACT, BRACE = palette.MOTION, palette.IMPACT, palette.BRACE
TABLE, BLOCK, INK, GUIDE = palette.TABLE, palette.BLOCK, palette.INK, palette.GUIDE

ANGLES = LinearSegmentedColormap.from_list("angles", palette.ANGLES)
"""Largest angle of a block that stands, from 0 to the critical angle."""

# In the heading of a figure of blocks that are not slender; a line of its own, clear of the note at the right.
FULL_EQUATION = "full equation"
AT_A_WALL, RESTRAINED = "at a wall", "restrained"
# Lines outside the range in which they are valid.
DOTTED = (0, (1, 1.5))

# A legend below the label of the horizontal axis, clear of titles and data.
BELOW: dict[str, Any] = {
    "loc": "upper center",
    "bbox_to_anchor": (0.5, 0.0),
    "borderaxespad": 3.8,  # in sizes of its text: past the numbers of the ticks and the label
    "handletextpad": 0.6,
    "fontsize": SMALL,
    "labelcolor": INK,
    "frameon": False,
}
# The legend of a map, under the vertical label too, where two of the longest names fit side by side.
BELOW_MAP = BELOW | {
    "fontsize": SMALL - 1.0,
    "bbox_to_anchor": (0.425, 0.0),
    "handlelength": 1.3,
    "handletextpad": 0.35,
    "columnspacing": 0.5,
}


def own(ax: Axes | None, height: float = 2.4) -> Axes:
    """Return the axes given, or new axes in a figure one column wide and `height` inches high."""
    if ax is not None:
        return instance("ax", ax, Axes)
    return figures.new(COLUMN, height).add_subplot()


def panels(rows: int = 1, columns: int = 1, height: float = 2.4, ratios: tuple[float, ...] | None = None):
    """Create a figure of `rows` × `columns` axes, as wide as a journal's column, or its page for several columns.

    Parameters
    ----------
    rows, columns : int
        Number of axes from top to bottom and from left to right, 1 to 100. Default: 1.
    height : float
        Height of one row, inches. Default: 2.4.
    ratios : tuple of float, optional
        Relative widths of the columns. Default: equal widths.

    Returns
    -------
    tuple
        The matplotlib figure and its axes in reading order. Several axes carry the letters (a), (b), ….

    Raises
    ------
    TypeError
        If an argument has the wrong type.
    ValueError
        If a number lies outside its range, or `ratios` does not hold one positive number per column.

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
        allowed = f"be {columns} positive numbers, one per column"
        ratios = tuple(within("ratios", each, 0.0, 1e6) for each in members("ratios", ratios, allowed))
        refuse_if(len(ratios) != columns or min(ratios) == 0.0, "ratios", allowed, ratios)
    figure = figures.new(COLUMN if columns == 1 else PAGE, height * rows)
    axes = list(figure.subplots(rows, columns, squeeze=False, width_ratios=ratios).flat)
    for letter, ax in zip("abcdefghijkl", axes, strict=False):
        if len(axes) > 1:
            title(ax, f"({letter})")
    return figure, axes


def title(ax: Axes, text: str) -> None:
    """Write `text` above the axes at the left, after the panel's letter if there is one.

    Raises
    ------
    TypeError
        If `ax` is no Axes, or `text` is no text.

    See Also
    --------
    panels : Make a figure with panels.
    """
    letter = instance("ax", ax, Axes).get_title(loc="left")
    instance("text", text, str)
    ax.set_title(f"{letter} {text}" if letter else text, loc="left", fontsize=TEXT, color=INK)


def block_title(ax: Axes, block: Block | None, *, full: bool = False) -> None:
    """Write the size of the block above the axes at the left, for a figure in SI units, what holds it, and whether its equation is full."""
    if block is not None:
        instance("block", block, Block)
        size, _, offset = block.size.partition(", ")
        held = AT_A_WALL * (block.wall is not None), RESTRAINED * (block.restrainer is not None)
        first = ", ".join(
            filter(None, (f"block {size}", *held))
        )  # the note at the right is beside the second line
        second = ", ".join(filter(None, (offset, FULL_EQUATION * full)))
        title(ax, "\n".join(filter(None, (first, second))))


def note(ax: Axes, text: str) -> None:
    """Write `text` in small letters above the axes at the right."""
    ax.set_title(text, loc="right", fontsize=SMALL, color=INK)


def label(ax: Axes, x: str, y: str) -> None:
    """Label both axes and set the sizes of ticks and frame.

    The horizontal axis has few ticks, so that their numbers fit. Numbers are complete: no axis has an offset text.
    The name of the coefficient of restitution of the braces is longer than a figure is high. It has two lines there.
    """
    ax.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
    ax.set_xlabel(x, fontsize=TEXT, color=INK)
    ax.set_ylabel(y.replace(" of the braces", "\nof the braces"), fontsize=TEXT, color=INK)
    ax.tick_params(labelsize=SMALL, color=INK, labelcolor=INK, width=THIN)
    for axis in (ax.xaxis, ax.yaxis):
        axis.get_offset_text().set(fontsize=SMALL, color=INK)
        formatter = axis.get_major_formatter()
        if isinstance(formatter, ScalarFormatter):
            formatter.set_useOffset(False)
    for side, spine in ax.spines.items():
        spine.set(visible=side in ("left", "bottom"), linewidth=THIN, edgecolor=INK)


def logarithmic(axis: Axis) -> None:
    """Set about five ticks of a logarithmic axis, each with its number.

    They stand at powers of ten, over less than two decades also at 2 and 5 times these.
    """
    low, high = axis.get_view_interval()
    between = (1.0, 2.0, 5.0) if high < 100.0 * low else (1.0,)
    axis.set_major_locator(LogLocator(subs=between, numticks=6))
    # Without thresholds, matplotlib numbers some of the ticks between powers of ten only, depending on the range.
    axis.set_major_formatter(LogFormatterSciNotation(minor_thresholds=(math.inf, math.inf)))
    axis.set_minor_locator(NullLocator())


def key(ax: Axes) -> None:
    """Draw a legend of all labelled artists, with marks of normal size; in one column if two do not fit into the figure."""
    legend = ax.legend(**BELOW, ncols=2, columnspacing=1.2)
    if legend.get_window_extent().width > ax.figure.bbox.width:
        legend = ax.legend(**BELOW)
    for mark in legend.get_lines():
        mark.set(markersize=MARK, markeredgewidth=0.8)


def key_beside(ax: Axes) -> None:
    """Add all labelled artists to the legend that the axes may have already, which is that of a map."""
    old = ax.get_legend()
    if old is None:
        key(ax)
        return
    handles: list[Any] = list(old.legend_handles)
    names = [text.get_text() for text in old.get_texts()]
    for handle, name in zip(*ax.get_legend_handles_labels(), strict=True):
        if name not in names:
            handles, names = [*handles, handle], [*names, name]
    key_of_map(ax, handles, names)


def key_of_map(ax: Axes, handles: list[Any], names: list[str]) -> None:
    """Draw the legend of a map in two columns, or in one if two do not fit into the figure."""
    figure: Any = ax.figure.figure  # also of axes in a subfigure
    for columns in (2, 1):
        legend = ax.legend(handles, names, **BELOW_MAP, ncols=columns)
        figure.draw_without_rendering()
        inside, there = figure.bbox, legend.get_window_extent()
        if inside.x0 <= there.x0 and there.x1 <= inside.x1:
            return


def check_labels(ax: Axes, across: str, upright: str) -> None:
    """Raise ValueError if axes that are drawn into show other quantities than these."""
    there = ax.get_xlabel(), ax.get_ylabel()
    if any(there) and there != (across, upright):
        raise Refusal("ax", f"show {across} and {upright}", " and ".join(there))


def patches(ax: Axes, handles: list, columns: int = 2) -> None:
    """Draw a legend of coloured patches."""
    ax.legend(handles=handles, **BELOW, ncols=columns)


def coded(colours: Sequence[str]) -> dict[str, Any]:
    """Return the arguments with which a function of matplotlib draws code k in the colour k."""
    count = len(colours)
    return {"cmap": ListedColormap(colours), "norm": BoundaryNorm(np.arange(count + 1) - 0.5, count)}


def point_size(count: int) -> float:
    """Return the diameter of one of `count` markers, in points: 10 markers are distinct, 10⁶ show their density.

    The area falls as 1/√count, so that the ink grows with the number of points without filling the figure.
    """
    return min(5.0, max(0.25, 5.0 * (max(count, 10) / 10) ** -0.25))


def places(x: NDArray[np.float64], y: NDArray[np.float64]) -> int:
    """Return the number of distinguishable points: the number of occupied cells of 4096 × 4096."""
    cells = np.zeros(len(x))
    for values in (x, y):
        # a spread of the size of the rounding error counts as zero
        span = max(float(np.ptp(values)), ROUNDING * float(np.abs(values).max()))
        if span > 0.0:
            cells = cells * (CELLS + 1) + np.rint((values - values.min()) * (CELLS / span))
    return len(np.unique(cells))


def line_width(count: int) -> float:
    """Return the width in points of a line that crosses the same region `count` times, thinner from 20 times on."""
    return LINE * (max(count, 20) / 20) ** -0.35


def check_symbols(symbols: str | None) -> None:
    """Raise TypeError or ValueError for an unknown set of symbols."""
    if symbols is not None:
        one_of("symbols", symbols, ("kinds", *PAPER))


@frozen
class Symbol:
    """Symbol of the paper, with the categories that it stands for."""

    marker: str
    name: str
    looks: tuple[int, ...]


PAPER = {
    "10": (
        Symbol("o", "quasi-periodic", (8,)),
        Symbol("+", "chaotic", (9,)),
        Symbol("*", "no response", (0,)),
        Symbol("x", "overturning", (10,)),
    ),
    "11": (
        Symbol("o", "harmonic", (1, 2)),
        Symbol("+", "one-third", (3, 4)),
        Symbol("*", "no response", (0,)),
        Symbol("x", "overturning", (10,)),
    ),
    "13b": (
        Symbol("+", "chaotic", (9,)),
        Symbol("*", "harmonic", (1, 2)),
        Symbol(">", "one-third", (3, 4)),
        Symbol("s", "even-order", (7,)),
    ),
}
"""Symbols of the paper's maps, by figure; the paper changes them from figure to figure."""


def shortened(name: str, longest: int) -> str:
    """Return a name of at most `longest` characters, at least 3: its start and its end, where records of one event differ.

    Examples
    --------
    >>> shortened("RSN953_NORTHR_MUL279", 11)
    'RSN95…UL279'
    """
    if len(name) <= longest:
        return name
    end = (longest - 1) // 2
    return f"{name[: longest - 1 - end]}…{name[-end:]}"
