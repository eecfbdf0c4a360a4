"""Maps of responses: what the response is at each point, told by colour or by symbols."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap, to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rocking.model import Block, percent
from rocking.plot.parts import style, theory_curves
from rocking.plot.parts.axis_units import parameter
from rocking.plot.parts.legend import LOOKS, NONE, PAPER, Symbol, check_symbols
from rocking.plot.parts.map_levels import Responses, edges

if TYPE_CHECKING:
    import xarray as xr

MAX_DRAWN = 2_000
"""Cells along an axis; of more, every second, third, … point is drawn."""
MAX_SYMBOLS = 30
HATCHED = 1_100
"""Dots along each axis of the layer of hatches, some two to a dot of the picture."""
STRIPES, STRIPE = 30, 5
"""Dots from one stripe to the next, and across one."""
ROOM = 125.0
"""Points of length that the marks of a row or a column take together, about."""
OTHER = "other"
HEIGHT, ROW = 2.75, 0.165


def parametric_map(
    found: xr.Dataset | str | os.PathLike[str] | Sequence[xr.Dataset],
    ax: Axes | None = None,
    block: Block | None = None,
    curves: Iterable[str] = (),
    symbols: str | None = None,
) -> Axes:
    r"""Draws what the response is at each point of a map, with the share of each kind, period and symmetry.

    Parameters
    ----------
    found : xarray.Dataset, path, or sequence of xarray.Dataset
        As `rocking.parametric_map` gives it; or the folder of its store, or levels of one, coarse to fine: what a level
        does not have yet is then taken from the one before it. What is not there at all stays white.
    ax : matplotlib Axes, optional
        Drawn into; a new figure, a column wide, if not given.
    block : Block, optional
        Gives SI axes and a title; otherwise the axes are the map's own, normalised.
    curves : sequence of str
        Theory over a map of the amplitude and the period, frequency or restitution, for the block without braces:
        "symmetry-breaking-1", "symmetry-breaking-3", "existence-1", "existence-3" (of the modes (1,1) and (1,3); dotted where the
        mode is not admissible), "melnikov", "heteroclinic".
    symbols : {"kinds", "10", "11", "13b"}, optional
        Marks instead of cells, of at most 30 points along an axis: ours, in colour, or those of a figure of the paper.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError, ValueError
        If it is no map over two axes, a curve does not belong over it, or an argument is of another kind.

    See Also
    --------
    tiles : Write the map as a page that zooms.
    repeatability_map : Plot a map of uncertain inputs.
    rocking.parametric_map : Compute a map.

    Notes
    -----
    Along an axis of more than 2,000 points not every one is drawn; the shares are those of all that are there. Stripes
    are hatches and no points: white where a response of odd period is unsymmetric, dark where it is undetermined.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> found = rk.parametric_map(
    ...     amplitude=np.linspace(0, 16, 20), period=np.linspace(0.2, 3, 20), restitution=0.925
    ... )
    >>> ax = rk.plot.parametric_map(found, curves=["symmetry-breaking-1", "melnikov"])
    >>> ax.get_xlabel(), ax.get_ylabel()
    ('period $T$ (–)', 'amplitude $A$ (–)')
    """
    check_symbols(symbols)
    read = Responses(found)
    curves = theory_curves.check(curves, read.names, read.told)
    codes, up, across, counts = _thinned(read, MAX_DRAWN if symbols is None else MAX_SYMBOLS)
    (turn_up, y_label), (turn_across, x_label) = (parameter(name, block) for name in read.names)
    keys = _cell_keys(counts) if symbols is None else _symbol_keys(counts, _symbols(symbols))
    rows = len(keys) + len(curves)
    ax = style.own(ax, height=HEIGHT + ROW * (rows if rows > 6 else -(-rows // 2)))
    corners = turn_across(edges(across)), turn_up(edges(up))
    if symbols is None:
        _cells(ax, codes, *corners)
    else:
        _marks(ax, codes, turn_across(across), turn_up(up), symbols)
    lines = theory_curves.draw(
        ax,
        curves,
        dict(zip(read.names, (read.up, read.across), strict=True)),
        read.told,
        dict(zip(read.names, (turn_up, turn_across), strict=True)),
    )
    style.label(ax, x_label, y_label)
    style.block_title(ax, block)
    ax.set(xlim=turn_across(edges(read.across))[[0, -1]], ylim=turn_up(edges(read.up))[[0, -1]])
    _legend(ax, [*keys, *lines])
    return ax


def _thinned(read: Responses, most: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """What is drawn, over which values; and how many points of all have each look, and none."""
    row_step, column_step = (-(-values.size // most) for values in (read.up, read.across))
    counts, kept = np.zeros(NONE + 1, np.int64), []
    for begin, codes in read.parts():
        counts += np.bincount(codes.ravel(), minlength=NONE + 1)
        kept.append(codes[-begin % row_step :: row_step, ::column_step])
    return np.concatenate(kept), read.up[::row_step], read.across[::column_step], counts


def _cells(ax: Axes, codes: np.ndarray, x: np.ndarray, y: np.ndarray) -> None:
    """A cell a point, and stripes over those that are hatched."""
    colours = ListedColormap([look.colour for look in LOOKS]).with_extremes(over="white")
    norm = BoundaryNorm(np.arange(len(LOOKS) + 1) - 0.5, len(LOOKS))
    drawn = ax.pcolorfast(x, y, codes, cmap=colours, norm=norm)
    drawn.set(gid="map", rasterized=True)
    hatched = [number for number, look in enumerate(LOOKS) if look.hatch is not None]
    if np.isin(codes, hatched).any():
        stripes = ax.imshow(
            _stripes(codes, x, y), extent=(x[0], x[-1], y[0], y[-1]), origin="lower", aspect="auto",
            interpolation="nearest", interpolation_stage="rgba",
        )  # fmt: skip
        stripes.set(gid="hatches", rasterized=True)


def _stripes(codes: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The hatches as an image of their own, transparent where there are none: as fine on ten points as on millions."""
    at_x, at_y = (np.linspace(values[0], values[-1], 2 * HATCHED + 1)[1::2] for values in (x, y))
    seen = codes[np.ix_(np.searchsorted(y, at_y) - 1, np.searchsorted(x, at_x) - 1)]
    row, column = np.ogrid[:HATCHED, :HATCHED]
    layer = np.zeros((HATCHED, HATCHED, 4))
    for number, look in enumerate(LOOKS):
        if look.hatch is not None:
            across = row + column if look.hatch == "white" else row - column
            where = (seen == number) & (across % STRIPES < STRIPE)
            layer[where] = (*to_rgb(look.hatch), 1.0)
    return layer


def _marks(ax: Axes, codes: np.ndarray, x: np.ndarray, y: np.ndarray, symbols: str) -> None:
    """A mark a point."""
    size = float(np.clip(ROOM / max(codes.shape), 1.5, 6.0))
    for symbol in _symbols(symbols):
        rows, columns = np.nonzero(np.isin(codes, symbol.looks))
        if len(rows):
            ax.plot(
                x[columns], y[rows], gid=symbol.name, **_how(symbol, symbols), markersize=size, clip_on=False
            )


def _symbols(symbols: str) -> tuple[Symbol, ...]:
    """The symbols of a set; in the paper's sets, what is not in the figure's legend is a dot."""
    if symbols == "kinds":
        return tuple(Symbol(look.marker, look.name, (number,)) for number, look in enumerate(LOOKS))
    known = {number for symbol in PAPER[symbols] for number in symbol.looks}
    return (*PAPER[symbols], Symbol(".", OTHER, tuple(set(range(len(LOOKS))) - known)))


def _how(symbol: Symbol, symbols: str) -> dict[str, Any]:
    look = LOOKS[symbol.looks[0]]
    colour = look.colour if symbols == "kinds" else style.INK
    open_ = look.hollow if symbols == "kinds" else symbol.marker in "o>s"
    return {
        "linestyle": "none",
        "marker": symbol.marker,
        "markerfacecolor": "white" if open_ else colour,
        "markeredgecolor": colour,
        "markeredgewidth": 0.8,
    }


def _cell_keys(counts: np.ndarray) -> list[Patch]:
    """A patch a look that is there, with its share."""
    keys = []
    for look, count in zip(LOOKS, counts[: len(LOOKS)], strict=True):
        if count:
            hatch = {None: None, "white": "\\\\\\\\"}.get(look.hatch, "////")
            keys.append(
                Patch(facecolor=look.colour, hatch=hatch, edgecolor=look.hatch or look.colour, linewidth=0.0,
                      label=f"{look.name} {percent(count / counts.sum())}")
            )  # fmt: skip
    if counts[NONE]:
        share = percent(counts[NONE] / counts.sum())
        keys.append(
            Patch(
                facecolor="white", edgecolor=style.GUIDE, linewidth=style.THIN, label=f"not computed {share}"
            )
        )
    return keys


def _symbol_keys(counts: np.ndarray, symbols: Sequence[Symbol]) -> list[Line2D]:
    """A mark a symbol that is there, with its share."""
    kinds = len(symbols) == len(LOOKS)
    keys = []
    for symbol in symbols:
        count = counts[list(symbol.looks)].sum()
        if count:
            how = _how(symbol, "kinds" if kinds else "paper")
            keys.append(
                Line2D(
                    [],
                    [],
                    **how,
                    markersize=style.MARK,
                    label=f"{symbol.name} {percent(count / counts.sum())}",
                )
            )
    return keys


def _legend(ax: Axes, keys: Sequence[Patch | Line2D]) -> None:
    """Below the axes: two columns while they are short."""
    ax.legend(
        handles=keys,
        **style.BELOW | {"fontsize": style.SMALL - 0.5},
        ncols=2,
        handlelength=1.8,
        columnspacing=0.8,
        handletextpad=0.5,
    )
