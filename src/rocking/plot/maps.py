"""Plot of a parametric map: types of response in colour, also from a store of any size."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rocking.model.block import Block
from rocking.model.files import resolve_path
from rocking.model.package import require_extra
from rocking.model.survey_results import ParametricMap, check_survey
from rocking.model.text import formatted_path, percent
from rocking.model.validation import WrongType, refuse_if
from rocking.plot import palette, style, theory_curves
from rocking.plot.axes import parameter
from rocking.plot.palette import LOOKS, NONE, looks
from rocking.plot.style import PAPER, Symbol, check_symbols

if TYPE_CHECKING:
    import xarray as xr


AT_ONCE = 1 << 20
"""Approximate number of points held in memory."""
NEEDED = ("kind", "response_period", "symmetric")


class Responses:
    """Responses over two axes, from a dataset or from the levels of a store, coarse to fine.

    Attributes
    ----------
    names : (str, str)
        Names of the axes, the vertical axis first.
    up, across : array
        Values of the axes on the finest level.
    attributes : dict
        Attributes of the map.
    """

    def __init__(self, result: Any) -> None:
        self.folder = Path(result) if isinstance(result, str | os.PathLike) else None
        self.levels = _levels(result)
        finest = self.levels[-1]
        first, second = map(str, finest.kind.dims)
        self.names = first, second
        self.up, self.across = (np.asarray(finest[name].values) for name in self.names)
        self.attributes = dict(finest.attrs)
        self._below: Responses | None = None

    def rows(self, begin: int, end: int) -> np.ndarray:
        """Return the categories of some rows; `NONE` for points that no level holds."""
        part = self.levels[-1][list(NEEDED)].isel({self.names[0]: slice(begin, end)})
        with _reading(self.folder):
            part = part.load()
        result = looks(*(part[name].values for name in NEEDED))
        missing = result == NONE
        if missing.any() and len(self.levels) > 1:
            result[missing] = self._coarser(begin, end)[missing]
        return result

    def parts(self) -> Iterator[tuple[int, np.ndarray]]:
        """Yield all rows in blocks: the index of the first row, and the categories of the block."""
        step = max(AT_ONCE // self.across.size, 1)
        for begin in range(0, self.up.size, step):
            yield begin, self.rows(begin, min(begin + step, self.up.size))

    def _coarser(self, begin: int, end: int) -> np.ndarray:
        """Return the categories of the nearest points of the next coarser level."""
        if self._below is None:
            self._below = Responses(self.levels[:-1])
            self._below.folder = self.folder
        below = self._below
        rows, columns = nearest(below.up, self.up[begin:end]), nearest(below.across, self.across)
        return below.rows(rows[0], rows[-1] + 1)[np.ix_(rows - rows[0], columns)]


def edges(values: np.ndarray) -> np.ndarray:
    """Return the edges of the cells around some values, half-way between neighbours."""
    middles = 0.5 * (values[1:] + values[:-1])
    return np.concatenate(
        [[1.5 * values[0] - 0.5 * values[1]], middles, [1.5 * values[-1] - 0.5 * values[-2]]]
    )


def nearest(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return the indices of the values nearest to some places."""
    return np.searchsorted(0.5 * (values[1:] + values[:-1]), places)


def _levels(result: Any) -> list[xr.Dataset]:
    if isinstance(result, ParametricMap):
        return [result.dataset]
    if isinstance(result, str | os.PathLike):
        result = _opened(resolve_path("result", result))
    levels = list(result) if isinstance(result, Sequence) else [result]
    allowed = "be a map over two axes, as parametric_map gives it, or the folder of its store"
    for level in levels:
        if check_survey("result", level, allowed, NEEDED).kind.ndim != 2:
            raise WrongType("result", allowed, result)
    refuse_if(not levels, "result", allowed, result)
    return levels


def _opened(folder: Path) -> list[xr.Dataset]:
    """Open the levels of a store, coarse to fine; arrays are read on demand."""
    import xarray as xr

    count = sum(1 for each in folder.glob("level-*") if each.is_dir())
    refuse_if(not count, "result", "be the folder of a map's store", str(folder))
    require_extra("store")
    with _reading(folder):
        return [
            xr.open_zarr(folder, group=f"level-{number}", chunks=None, consolidated=False)
            for number in range(count)
        ]


@contextmanager
def _reading(folder: Path | None) -> Iterator[None]:
    """Raise OSError with the folder and the remedy for a store that cannot be read."""
    try:
        yield
    except MemoryError:
        raise
    except Exception as error:
        if folder is None:
            raise
        raise OSError(
            f"result must be the folder of a store that can be read; got {formatted_path(folder)}, which is damaged: "
            "repeat the survey that made it with repair"
        ) from error


MAX_DRAWN = 2_000
"""Maximum number of cells along an axis. From longer axes every second, third, … point is drawn."""
MAX_SYMBOLS = 30
HATCHED = 1_100
"""Dots along each axis of the layer of hatches, about two per dot of the figure."""
STRIPES, STRIPE = 30, 5
"""Distance of the stripes, and width of a stripe, in dots."""
ROOM = 125.0
"""Approximate total length of the marks of a row or a column, in points."""
LEAST = 1e-4
"""Smallest fraction with a row in the legend."""
OTHER = "other"
HEIGHT, ROW = 2.75, 0.165


def parametric_map(
    result: ParametricMap | xr.Dataset | str | os.PathLike[str] | Sequence[xr.Dataset],
    ax: Axes | None = None,
    block: Block | None = None,
    *,
    curves: Iterable[str] = (),
    symbols: str | None = None,
) -> Axes:
    r"""Plot a map of responses, with the fraction of each type, period and symmetry.

    Parameters
    ----------
    result : ParametricMap, xarray.Dataset, path, or sequence of xarray.Dataset
        Result of `rocking.parametric_map`, its dataset, the folder of its store, or levels of a store, coarse to fine. A missing point
        of a level is taken from the next coarser level. Points that no level holds stay white.
    ax : matplotlib Axes, optional
        Axes to draw into. Default: a new figure, one column wide.
    block : Block, optional
        Block for SI axes and a title. Default: that of the result. None: normalised axes.
    curves : sequence of str
        Theoretical amplitudes over a map of the amplitude and the period, frequency or restitution, without braces.
        "symmetry-breaking-1", "symmetry-breaking-3", "existence-1" and "existence-3" belong to the (1, 1) and (1, 3) modes.
        They are dotted where the mode is inadmissible. The others are "melnikov" and "heteroclinic". Default: none.
    symbols : {"kinds", "10", "11", "13b"}, optional
        Marks instead of cells, at no more than 30 points along an axis. "kinds" has one coloured mark per category, the
        others are the symbols of a figure of Yim & Lin (1991). Default: cells.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    TypeError
        If `result` is not a map over two axes, or an argument has the wrong type.
    ValueError
        If a curve or a set of symbols is unknown, or a curve does not apply to the map.
    ImportError
        If `result` is a path, and the extra ``store`` is not installed.
    OSError
        If `result` is a path that cannot exist, or a store that cannot be read.

    See Also
    --------
    tiles : Write the map as a page that zooms.
    repeatability_map : Plot a map of uncertain inputs.
    rocking.parametric_map : Compute a map.

    Notes
    -----
    From axes of more than 2,000 points not every point is drawn; the fractions count all points. A category below
    0.01 % has no row in the legend. Dark stripes mark undetermined responses.

    Examples
    --------
    >>> import numpy as np
    >>> import rocking as rk
    >>> system = rk.System(rk.Harmonic(amplitude=2.0, period=1.0), restitution=0.925)
    >>> result = rk.parametric_map(system, amplitude=np.linspace(0, 16, 20), period=np.linspace(0.2, 3, 20))
    >>> ax = rk.plot.parametric_map(result, curves=["symmetry-breaking-1", "melnikov"])
    >>> ax.get_xlabel(), ax.get_ylabel()
    ('period $T$', 'amplitude $A$')
    """
    check_symbols(symbols)
    read = Responses(result)
    curves = theory_curves.check(curves, read.names, read.attributes)
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
        read.attributes,
        dict(zip(read.names, (turn_up, turn_across), strict=True)),
    )
    style.label(ax, x_label, y_label)
    style.block_title(ax, block)
    frame = (read.across, read.up) if symbols is None else (across, up)
    ax.set(xlim=turn_across(edges(frame[0]))[[0, -1]], ylim=turn_up(edges(frame[1]))[[0, -1]])
    handles = [*keys, *lines]
    style.key_of_map(ax, handles, [str(handle.get_label()) for handle in handles])
    return ax


def _thinned(read: Responses, most: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the codes to draw, the values of both axes, and the number of points of each category.

    Returns
    -------
    tuple of (array, array, array, array)
        Codes; values of the vertical and of the horizontal axis; counts of all points by code.
    """
    row_step, column_step = (-(-values.size // most) for values in (read.up, read.across))
    counts, kept = np.zeros(NONE + 1, np.int64), []
    for begin, codes in read.parts():
        counts += np.bincount(codes.ravel(), minlength=NONE + 1)
        kept.append(codes[-begin % row_step :: row_step, ::column_step])
    return np.concatenate(kept), read.up[::row_step], read.across[::column_step], counts


def _cells(ax: Axes, codes: np.ndarray, x: np.ndarray, y: np.ndarray) -> None:
    """Draw one cell per point, and stripes over hatched cells."""
    how = style.coded([look.colour for look in LOOKS])
    how["cmap"] = how["cmap"].with_extremes(over=palette.NOT_COMPUTED)
    ax.pcolorfast(x, y, codes, **how).set(gid="map", rasterized=True)
    hatched = [number for number, look in enumerate(LOOKS) if look.hatch is not None]
    if np.isin(codes, hatched).any():
        ax.imshow(
            _stripes(codes, x, y), extent=(x[0], x[-1], y[0], y[-1]), origin="lower", aspect="auto",
            interpolation="nearest", interpolation_stage="rgba",
        ).set(gid="hatches", rasterized=True)  # fmt: skip


def _stripes(codes: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the hatches as a separate, transparent image, whose stripes do not depend on the number of points."""
    at_x, at_y = (np.linspace(values[0], values[-1], 2 * HATCHED + 1)[1::2] for values in (x, y))
    seen = codes[np.ix_(np.searchsorted(y, at_y) - 1, np.searchsorted(x, at_x) - 1)]
    row, column = np.ogrid[:HATCHED, :HATCHED]
    layer = np.zeros((HATCHED, HATCHED, 4))
    for number, look in enumerate(LOOKS):
        if look.hatch is not None:
            where = (seen == number) & ((row - column) % STRIPES < STRIPE)
            layer[where] = (*to_rgb(look.hatch), 1.0)
    return layer


def _marks(ax: Axes, codes: np.ndarray, x: np.ndarray, y: np.ndarray, symbols: str) -> None:
    """Draw one mark per point."""
    size = float(np.clip(ROOM / max(codes.shape), 1.5, 6.0))
    for symbol in _symbols(symbols):
        rows, columns = np.nonzero(np.isin(codes, symbol.looks))
        if len(rows):
            ax.plot(
                x[columns], y[rows], gid=symbol.name, **_how(symbol, symbols), markersize=size, clip_on=False
            )


def _symbols(symbols: str) -> tuple[Symbol, ...]:
    """Return the symbols of a set; a category that the paper's legend lacks becomes a dot."""
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
    """Return one patch per category of at least `LEAST`, labelled with its fraction."""
    keys = []
    for look, count in zip(LOOKS, counts[: len(LOOKS)], strict=True):
        if count and count >= LEAST * counts.sum():
            keys.append(
                Patch(facecolor=look.colour, hatch="////" if look.hatch else None, edgecolor=look.hatch or look.colour,
                      linewidth=0.0, label=f"{look.name} ({percent(count / counts.sum())})")
            )  # fmt: skip
    if counts[NONE]:
        share = percent(counts[NONE] / counts.sum())
        keys.append(
            Patch(
                facecolor=palette.NOT_COMPUTED,
                edgecolor=style.GUIDE,
                linewidth=style.THIN,
                label=f"not computed ({share})",
            )
        )
    return keys


def _symbol_keys(counts: np.ndarray, symbols: Sequence[Symbol]) -> list[Line2D]:
    """Return one mark per symbol that occurs; with its fraction if the marks are those of the categories."""
    kinds = len(symbols) == len(LOOKS)
    keys = []
    for symbol in symbols:
        count = counts[list(symbol.looks)].sum()
        if count and count >= LEAST * counts.sum():
            keys.append(
                Line2D(
                    [],
                    [],
                    **_how(symbol, "kinds" if kinds else "paper"),
                    markersize=style.MARK,
                    label=f"{symbol.name} ({percent(count / counts.sum())})" if kinds else symbol.name,
                )
            )
    return keys
