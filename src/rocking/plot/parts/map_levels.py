"""Maps as they are drawn: read in blocks of rows, with missing points taken from coarser levels."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.model.files import resolve_path
from rocking.model.package import require_extra
from rocking.model.text import shown_path
from rocking.model.validation import WrongType, refuse_if
from rocking.plot.parts.legend import NONE, looks

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

    def __init__(self, found: Any) -> None:
        self.folder = Path(found) if isinstance(found, str | os.PathLike) else None
        self.levels = _levels(found)
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
        found = looks(*(part[name].values for name in NEEDED))
        missing = found == NONE
        if missing.any() and len(self.levels) > 1:
            found[missing] = self._coarser(begin, end)[missing]
        return found

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


def _levels(found: Any) -> list[xr.Dataset]:
    if isinstance(found, str | os.PathLike):
        found = _opened(resolve_path("found", found))
    levels = list(found) if isinstance(found, Sequence) else [found]
    allowed = "be a map over two axes, as parametric_map gives it, or the folder of its store"
    for level in levels:
        kinds = getattr(level, "kind", None)
        if getattr(kinds, "ndim", 0) != 2 or not all(hasattr(level, name) for name in NEEDED):
            raise WrongType("found", allowed, found)
    refuse_if(not levels, "found", allowed, found)
    return levels


def _opened(folder: Path) -> list[xr.Dataset]:
    """Open the levels of a store, coarse to fine; arrays are read on demand."""
    import xarray as xr

    count = sum(1 for each in folder.glob("level-*") if each.is_dir())
    refuse_if(not count, "found", "be the folder of a map's store", str(folder))
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
            f"found must be the folder of a store that can be read; got {shown_path(folder)}, which is damaged: "
            "repeat the survey that made it with repair"
        ) from error
