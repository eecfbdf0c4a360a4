"""Results of a survey in a Zarr store (format 3): written during the run, resumable after any interruption.

This module and `zarr_files` need the extra ``store``. They are imported for a survey with a store only.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import zarr

from rocking.model.files import takes_files
from rocking.model.text import formatted_path, listed
from rocking.model.validation import Refusal, Text, warn_of_input
from rocking.survey import zarr_files
from rocking.survey.measurement import Arrays, Measurement
from rocking.survey.spec import SurveySpec
from rocking.survey.store_access import (
    ROOT,
    StoreError,
    check_store,
    defer_interrupt,
    lock,
    reading,
    remove_unfinished,
    something_else,
    wrap_write_errors,
)
from rocking.survey.store_layout import (
    FORMAT,
    Layout,
    check_described,
    check_same,
    described_layout,
    fingerprint,
    joined,
    new_layout,
    read_layout,
    why_finished,
)
from rocking.survey.tiling import Level, Slices, Tile
from rocking.survey.zarr_files import Files, encoded

NAME = "rocking_survey"
"""Attribute of the root group that identifies the store of a survey."""
MAX_POINTS = 10**11
"""Largest number of points of a store: about a terabyte in tens of millions of files."""
MAX_HELD = 1 << 20
"""Largest level, in points, held in memory for the next one: about 50 MB, with all others less than twice that."""


class Store:
    """Store opened exclusively for this run by `opened`.

    The digests of the chunks of a tile are written last and mark it as complete. Tiles without this mark are recomputed.
    Every file is written under a temporary name and renamed. A complete store may be read only: because it cannot be `writable`, or
    because another method or an older format made it.
    """

    def __init__(
        self, path: Path, spec: SurveySpec, measure: Measurement, *, repair: bool, writable: bool
    ) -> None:
        self.path, self.measure = path, measure
        self.files = Files(path)
        with defer_interrupt(), wrap_write_errors(path):
            self.outdated = ""
            self.finished = "" if writable else "its folder cannot be written"
            self.layout, self.root, self.bound = self._agreed(spec)
            self.spec = spec.with_axes(self.layout.axes)
            self.levels: list[Level] = self.layout.levels()
            if not self.finished:
                remove_unfinished(path, [*self.layout.axes, *(each.name for each in measure.variables)])
            self.arrays = self._arranged()
        self.done = 0
        self.begun: dict[
            tuple[int, tuple[int, ...]], tuple[int, ...]
        ] = {}  # computed points of complete tiles
        self.held: dict[int, Arrays] = {}  # small levels other than the finest, by number
        self.check(repair=repair)
        if self.finished and self.done < self.spec.points:
            raise StoreError(self.files.refusal)

    def known(self, tile: Tile) -> np.ndarray:
        """Return the mask of the computed points of a tile."""
        known = np.zeros(tile.shape, bool)
        if (points := self.begun.get((tile.level.number, tile.index))) is not None:
            known[tuple(map(slice, points))] = True
        return known

    def read(self, tile: Tile, names: tuple[str, ...] = ()) -> Arrays:
        """Return the results of a tile for the named variables. Default: all variables."""
        requested = names or tuple(self.arrays[tile.level.number])
        return {name: self._read(tile.level, name, tile.region) for name in requested}

    def coarser(self, tile: Tile) -> Arrays:
        """Return the results that a tile shares with the previous level."""
        level, shared = self.levels[tile.level.number - 1], tile.shared()
        assert shared is not None
        held = self._held(level)
        if held is not None:
            return {name: values[shared[1]] for name, values in held.items()}
        rows = {name: self._read(level, name, shared[1]) for name in self.arrays[level.number]}
        for each in self.measure.variables:
            if (rows[each.name] == each.fill).any():
                raise StoreError(
                    f"store {formatted_path(self.path)} lost files during the run (run again to recompute them)"
                )
        return rows

    def write(self, tile: Tile, answers: Arrays) -> None:
        """Write the results of a tile, at last its digests, which mark it as complete."""
        held = self._held(tile.level)
        chunks = {
            each.name: encoded(answers[each.name], tile.level.tile, each.fill)
            for each in self.measure.variables
        }
        assert self.bound is not None
        with wrap_write_errors(self.path):
            (self.path / self._digests(tile)).unlink(missing_ok=True)  # no mark while chunks are old and new
            for name, content in chunks.items():
                self.files.keep(self._chunk(tile, name), content)
            self.files.keep(self._digests(tile), zarr_files.digests(self.bound, tile, tile.shape, chunks))
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
        self.files.check_place()
        return open_level(self.path, self.levels[-1].number)[[each.name for each in self.measure.variables]]

    def check(self, *, repair: bool) -> None:
        """Read all complete tiles; damage raises StoreError or, with `repair`, the tiles are recomputed."""
        rows: list[str] = []
        for tile in (tile for level in self.levels for tile in self._marked(level)):
            points, damaged = self._inspected(tile)
            rows += [formatted_path(self.path / name) for name in damaged]
            if not damaged:
                self.begun[tile.level.number, tile.index] = points
                self.done += int(tile.own(self.known(tile)).sum())
        if rows and not repair:
            remedy = (
                "restore these files, or give another folder"
                if self.finished
                else "recompute these tiles with repair"
            )
            raise StoreError(f"store {formatted_path(self.path)} is damaged at {listed(rows)} ({remedy})")

    def _marked(self, level: Level) -> list[Tile]:
        """Return the tiles of a level that are marked as complete, from a list of the folder instead of a test of each tile."""
        marker = self.measure.marker.name
        folder = self.path / (
            self._chunks(level, marker)
            if self.bound is None
            else f"{level.name}/{marker}/{zarr_files.FOLDER}"
        )
        result = (path.relative_to(folder).parts for path in folder.glob("/".join("*" * len(level.shape))))
        numbered = (tuple(map(int, parts)) for parts in result if all(map(str.isdecimal, parts)))
        return [
            level.at(index)
            for index in sorted(numbered)
            if all(place < count for place, count in zip(index, level.tile_counts, strict=True))
        ]

    def _inspected(self, tile: Tile) -> tuple[tuple[int, ...], list[str]]:
        """Return the computed points of a marked tile, along each axis from its first, and its damaged files."""
        if self.bound is None:
            return self._decoded(tile)
        names = [each.name for each in self.measure.variables]
        chunks = {name: self.files.kept(self._chunk(tile, name)) or b"" for name in names}
        try:
            points, damaged = zarr_files.wrong(
                self.bound, tile, self.files.kept(self._digests(tile)) or b"", chunks
            )
        except ValueError:
            return (), [self._digests(tile)]
        return points, [self._chunk(tile, name) for name in damaged]

    def _decoded(self, tile: Tile) -> tuple[tuple[int, ...], list[str]]:
        """Return the same as `_inspected` for a store without digests, whose chunks have checksums only."""
        for each in self.measure.variables:
            try:
                whole = (self._read(tile.level, each.name, tile.region) != each.fill).all()
            except MemoryError:
                raise
            except Exception:  # noqa: BLE001 (a damaged chunk raises many types of error)
                return (), [self._chunk(tile, each.name)]
            if not whole:
                return (0,) * len(tile.shape), []
        return tile.shape, []

    def _digests(self, tile: Tile) -> str:
        """Return the path of the digests of a tile, relative to the store."""
        return "/".join((tile.level.name, self.measure.marker.name, zarr_files.FOLDER, *map(str, tile.index)))

    def _chunk(self, tile: Tile, name: str) -> str:
        """Return the path of the chunk of a tile, relative to the store."""
        return "/".join((self._chunks(tile.level, name), *map(str, tile.index)))

    def _chunks(self, level: Level, name: str) -> str:
        """Return the path of the chunks of a variable, relative to the store."""
        return f"{level.name}/{name}/c"

    def _read(self, level: Level, name: str, region: Slices) -> np.ndarray:
        return np.asarray(self.arrays[level.number][name].get_basic_selection(region))

    def _agreed(self, spec: SurveySpec) -> tuple[Layout, zarr.Group, bytes | None]:
        """Return the layout of the store and the survey, the root group and the key of the survey; an error if they do not match.

        The key is None for a store whose tiles have no digests.
        """
        mine = fingerprint(spec, self.measure)
        if not (self.path / ROOT).exists():
            layout = new_layout(spec)
            metadata: dict[str, Any] = {NAME: mine | described_layout(layout)}
            root = zarr.create_group(self.files, zarr_format=3, attributes=metadata)
            return layout, root, zarr_files.survey_key(metadata[NAME])
        with reading(self.path):
            root = zarr.open_group(self.files, mode="r+", zarr_format=3, use_consolidated=False)
        stored: Any = root.attrs.get(NAME)
        if stored is None:
            raise something_else(self.path, "a Zarr store of other data")
        with reading(self.path):
            check_described(stored)
        check_same(str(self.path), stored, mine)
        self.outdated = why_finished(stored, mine)
        self.finished = self.outdated or self.finished
        if self.finished:
            self.files.refusal = (
                f"store {formatted_path(self.path)} lacks some of these points and cannot be resumed: {self.finished} "
                "(give another folder; what is there can be read and plotted)"
            )
        with reading(self.path):
            held = read_layout(stored)
        layout = joined(str(self.path), held, spec)
        if stored | described_layout(layout) != stored:
            root.attrs[NAME] = stored | described_layout(layout)
        return layout, root, zarr_files.survey_key(stored) if stored["format"] == FORMAT else None

    def _arranged(self) -> list[dict[str, zarr.Array]]:
        """Return the arrays of each level, created or enlarged as needed."""
        with reading(self.path):
            known = {level.name: self.root.get(level.name) for level in self.levels}
        groups = zarr_files.make_groups(self.files, self.spec, self.measure, self.levels, known)
        with reading(self.path):
            there: list[dict[str, Any]] = [dict(group.arrays()) for group in groups]
        return zarr_files.make_arrays(self.files, self.spec, self.measure, self.levels, there)


@contextmanager
def opened(
    path: str | os.PathLike[str], spec: SurveySpec, measure: Measurement, *, repair: bool
) -> Iterator[Store]:
    """Open a store exclusively for this run; create it if it does not exist.

    Raises
    ------
    ValueError
        If the store holds a different survey, whose differences the message lists, or if there are too many points.
    OSError
        If the path is not a folder, or the store holds other data, is in use, cannot be written or is damaged.
    """
    if spec.points > MAX_POINTS:
        allowed = f"hold {MAX_POINTS:,} points at most"
        raise Refusal("store", allowed, Text(f"{spec.points:,}"), "divide them among several stores")
    folder = check_store(path)
    place = folder.resolve()
    if not (place / ROOT).is_file():
        with wrap_write_errors(folder):
            place.mkdir(parents=True, exist_ok=True)
    writable = takes_files(place)
    with lock(folder, shared=not writable):
        kept = Store(folder, spec, measure, repair=repair, writable=writable)
        if kept.outdated:
            warn_of_input(f"all results are read from store {formatted_path(folder)}: {kept.outdated}")
        yield kept


def open_level(path: Path, number: int) -> xr.Dataset:
    """Return a level of a store, which is read on access."""
    return xr.open_zarr(Files(path, read_only=True), group=f"level-{number}", chunks=None, consolidated=False)
