"""Results of a survey in a Zarr store (format 3): written during the run, resumable after any interruption."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.survey.measurement import Arrays, Measurement
from rocking.survey.spec import SurveySpec
from rocking.survey.store import zarr_metadata
from rocking.survey.store.layout import (
    Layout,
    check_described,
    check_same,
    described_layout,
    fingerprint,
    joined,
    new_layout,
    read_layout,
)
from rocking.survey.store.locking import (
    ROOT,
    StoreError,
    check_store,
    defer_interrupt,
    exclusive_lock,
    reading,
    remove_unfinished,
    something_else,
    wrap_write_errors,
)
from rocking.survey.tiling import Level, Slices, Tile

if TYPE_CHECKING:
    import xarray as xr
    import zarr

NAME = "rocking_survey"
"""Attribute of the root group that identifies the store of a survey."""
MAX_NAMED = 5
MAX_HELD = 1 << 20
"""Largest level, in points, held in memory for the next one: about 50 MB, with all others less than twice that."""


class Store:
    """Store opened exclusively for this run by `opened`.

    The chunk of the last variable is written last and marks a tile as complete. Tiles without this mark are recomputed.
    Every file is written under a temporary name and renamed.
    """

    def __init__(self, path: Path, asked: SurveySpec, measure: Measurement, *, repair: bool) -> None:
        from rocking.survey.store.chunk_files import Files

        self.path, self.measure = path, measure
        self.files = Files(path)
        with defer_interrupt(), wrap_write_errors(path):
            self.layout, self.root = self._agreed(asked)
            self.asked = asked.with_axes(self.layout.axes)
            self.levels: list[Level] = self.layout.levels()
            remove_unfinished(path, [*self.layout.axes, *(each.name for each in measure.variables)])
            self.arrays = self._arranged()
        self.done = 0
        self.begun: set[tuple[int, tuple[int, ...]]] = set()  # tiles with valid data
        self.held: dict[int, Arrays] = {}  # small levels other than the finest, by number
        self.check(repair=repair)

    def known(self, tile: Tile) -> np.ndarray:
        """Return the mask of the computed points of a tile."""
        if (tile.level.number, tile.index) not in self.begun:
            return np.zeros(tile.shape, bool)
        marker = self.measure.marker
        return self._read(tile.level, marker.name, tile.region) != marker.fill

    def read(self, tile: Tile, names: tuple[str, ...] = ()) -> Arrays:
        """Return the results of a tile for the named variables. Default: all variables."""
        wanted = names or tuple(self.arrays[tile.level.number])
        return {name: self._read(tile.level, name, tile.region) for name in wanted}

    def coarser(self, tile: Tile) -> Arrays:
        """Return the results that a tile shares with the previous level."""
        level, shared = self.levels[tile.level.number - 1], tile.shared()
        assert shared is not None
        held = self._held(level)
        if held is None:
            return {name: self._read(level, name, shared[1]) for name in self.arrays[level.number]}
        return {name: values[shared[1]] for name, values in held.items()}

    def write(self, tile: Tile, answers: Arrays) -> None:
        """Write the results of a tile; the last variable, which marks the tile as complete, is written last."""
        from rocking.survey.store.chunk_files import encoded

        held = self._held(tile.level)
        with wrap_write_errors(self.path):
            for each in self.measure.variables:
                content = encoded(answers[each.name], tile.level.tile, each.fill)
                self.files.keep(self._chunk(tile, each.name), content)
        if held is not None:
            for name, values in answers.items():
                held[name][tile.region] = values

    def _held(self, level: Level) -> Arrays | None:
        """Return the results of a small level other than the finest; None for other levels."""
        if level is self.levels[-1] or math.prod(level.shape) > MAX_HELD:
            return None
        if level.number not in self.held:
            self.held[level.number] = held = self.measure.blank(level.shape)
            for tile in (tile for tile in level.tiles() if (level.number, tile.index) in self.begun):
                for name, values in self.read(tile).items():
                    held[name][tile.region] = values
        return self.held[level.number]

    def dataset(self) -> xr.Dataset:
        """Return the finest level, which is read on access."""
        return open_level(self.path, self.levels[-1].number)[[each.name for each in self.measure.variables]]

    def check(self, *, repair: bool) -> None:
        """Read all complete tiles; damage raises StoreError or, with `repair`, the tiles are recomputed."""
        found: list[str] = []
        for tile in (tile for level in self.levels for tile in self._marked(level)):
            known, damaged = self._inspected(tile)
            found += [repr(str(self.path / self._chunk(tile, name))) for name in damaged]
            if known.any() and not damaged:
                self.begun.add((tile.level.number, tile.index))
                self.done += int(tile.own(known).sum())
        if found and not repair:
            more = f" and {len(found) - MAX_NAMED} more" if len(found) > MAX_NAMED else ""
            raise StoreError(
                f"store {str(self.path)!r} is damaged at {', '.join(found[:MAX_NAMED])}{more} (recompute these tiles with repair)"
            )

    def _marked(self, level: Level) -> list[Tile]:
        """Return the tiles of a level whose marker exists, from a list of the folder instead of a test of each tile."""
        folder = self.path / self._chunks(level, self.measure.marker.name)
        found = (path.relative_to(folder).parts for path in folder.glob("/".join("*" * len(level.shape))))
        numbered = (tuple(map(int, parts)) for parts in found if all(map(str.isdecimal, parts)))
        return [level.at(index) for index in sorted(numbered)]

    def _inspected(self, tile: Tile) -> tuple[np.ndarray, list[str]]:
        """Inspect the chunks of a tile.

        Returns
        -------
        tuple of (array of bool, list of str)
            Mask of the computed points, and the variables that are unreadable or incomplete.
        """
        marker, known, damaged = self.measure.marker, np.zeros(tile.shape, bool), []
        for variable in reversed(self.measure.variables):
            try:
                there = self._read(tile.level, variable.name, tile.region) != variable.fill
            except Exception:  # noqa: BLE001 (a damaged chunk raises many types of error)
                damaged.append(variable.name)
                continue
            if variable is marker:
                known = there
                if not known.any():
                    break
            elif not there[known].all():
                damaged.append(variable.name)
        return known, damaged

    def _chunk(self, tile: Tile, name: str) -> str:
        """Return the path of the chunk of a tile, relative to the store."""
        return "/".join((self._chunks(tile.level, name), *map(str, tile.index)))

    def _chunks(self, level: Level, name: str) -> str:
        """Return the path of the chunks of a variable, relative to the store."""
        return f"{level.name}/{name}/c"

    def _read(self, level: Level, name: str, region: Slices) -> np.ndarray:
        return np.asarray(self.arrays[level.number][name].get_basic_selection(region))

    def _agreed(self, asked: SurveySpec) -> tuple[Layout, zarr.Group]:
        """Return the layout of the store and the survey, and the root group; an error if they do not match."""
        import zarr

        mine = fingerprint(asked, self.measure)
        if not (self.path / ROOT).exists():
            layout = new_layout(asked)
            metadata = {NAME: mine | described_layout(layout)}
            return layout, zarr.create_group(self.files, zarr_format=3, attributes=metadata)
        with reading(self.path):
            root = zarr.open_group(self.files, mode="r+", zarr_format=3, use_consolidated=False)
        stored: Any = root.attrs.get(NAME)
        if stored is None:
            raise StoreError(something_else(self.path, "a Zarr store of other data"))
        with reading(self.path):
            check_described(stored)
        check_same(str(self.path), stored, mine)
        with reading(self.path):
            held = read_layout(stored)
        layout = joined(str(self.path), held, asked)
        if stored | described_layout(layout) != stored:
            root.attrs[NAME] = stored | described_layout(layout)
        return layout, root

    def _arranged(self) -> list[dict[str, zarr.Array]]:
        """Return the arrays of each level, created or enlarged as needed."""
        with reading(self.path):
            known = {level.name: self.root.get(level.name) for level in self.levels}
        groups = zarr_metadata.make_groups(self.files, self.asked, self.measure, self.levels, known)
        with reading(self.path):
            there: list[dict[str, Any]] = [dict(group.arrays()) for group in groups]
        return zarr_metadata.make_arrays(self.files, self.asked, self.measure, self.levels, there)


@contextmanager
def opened(
    path: str | os.PathLike[str], asked: SurveySpec, measure: Measurement, *, repair: bool
) -> Iterator[Store]:
    """Open a store exclusively for this run; create it if it does not exist.

    Raises
    ------
    ValueError
        If the store holds a different survey; the message lists the differences.
    OSError
        If the path is not a folder, or the store holds other data, is in use, cannot be written or is damaged.
    """
    folder = check_store(path)
    with wrap_write_errors(folder):
        folder.resolve().mkdir(parents=True, exist_ok=True)
    with exclusive_lock(folder):
        yield Store(folder, asked, measure, repair=repair)


def open_level(path: Path, number: int) -> xr.Dataset:
    """Return a level of a store, which is read on access."""
    import xarray as xr

    from rocking.survey.store.chunk_files import Files

    return xr.open_zarr(Files(path), group=f"level-{number}", chunks=None, consolidated=False)
