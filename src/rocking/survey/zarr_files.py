"""Files of a store in the Zarr format 3: groups and arrays, chunks, and the digests that bind chunks to their survey and place."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import AsyncIterator, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
import zarr
from numcodecs import Blosc
from numcodecs.checksum32 import CRC32C
from zarr.abc.buffer import Buffer, BufferPrototype
from zarr.abc.store import ByteRequest
from zarr.buffer import default_buffer_prototype
from zarr.core.group import GroupMetadata
from zarr.core.metadata import ArrayV3Metadata
from zarr.storage import LocalStore

from rocking.model.files import renaming
from rocking.model.text import formatted_path
from rocking.survey.measurement import Measurement
from rocking.survey.memory import attributes
from rocking.survey.spec import SurveySpec
from rocking.survey.store_access import ROOT, StoreError, place_of
from rocking.survey.tiling import Level, Tile

SHRINK = Blosc("lz4", clevel=1, shuffle=Blosc.SHUFFLE)
"""Compression of chunks to a sixth of their size; it takes a tenth of the time to write the bytes saved."""
CHECK = CRC32C()


class Files(LocalStore):
    """Local Zarr store that reads and writes files in the calling thread.

    Zarr passes each file to a thread of its pool. The files of a survey are small and all cores are busy, so that
    passing a file would cost more than writing it.

    Attributes
    ----------
    refusal : str
        Message of the error that any write raises; empty if the store may be written.
    """

    def __init__(self, root: Path | str, *, read_only: bool = False) -> None:
        super().__init__(root, read_only=read_only)
        self.refusal = ""
        self.place = place_of(self.root)

    async def get(
        self, key: str, prototype: BufferPrototype | None = None, byte_range: ByteRequest | None = None
    ) -> Buffer | None:
        """Return the content of a file, or None if it is missing."""
        return self.get_sync(key, prototype=prototype, byte_range=byte_range)

    async def set(self, key: str, value: Buffer) -> None:
        """Write a file under a temporary name, then rename it."""
        self.set_sync(key, value)

    def set_sync(self, key: str, value: Buffer) -> None:
        """Write a file under a temporary name, then rename it; StoreError if the store may not be written."""
        if self.refusal:
            raise StoreError(self.refusal)
        self.check_place()
        path = self.root / key
        partial = path.with_suffix(f".{uuid4().hex}.partial")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with renaming(partial, path):
                partial.write_bytes(value.to_bytes())
        except FileNotFoundError:
            self.check_place()
            raise

    def check_place(self) -> None:
        """Raise StoreError if the folder is no longer the one that was opened."""
        if self.place != place_of(self.root):
            raise StoreError(
                f"store {formatted_path(self.root)} was moved, deleted or replaced during the run, which writes nothing more "
                "(run again with the folder in its place, or with another one)"
            )

    async def list_dir(self, prefix: str) -> AsyncIterator[str]:
        """Yield the names of the groups and arrays in a folder; Zarr would warn of all other files."""
        folder = self.root / prefix
        async for name in super().list_dir(prefix):
            if (folder / name / ROOT).exists():
                yield name

    def kept(self, key: str) -> bytes | None:
        """Return the bytes of a file, or None if it is missing."""
        result = self.get_sync(key)
        return None if result is None else result.to_bytes()

    def keep(self, key: str, content: bytes) -> None:
        """Write bytes to a file."""
        self.set_sync(key, default_buffer_prototype().buffer.from_bytes(content))


def codecs(dtype: str) -> list[dict[str, Any]]:
    """Return the codecs of `encoded` in the Zarr format 3."""
    shrink = {
        "cname": SHRINK.cname,
        "clevel": SHRINK.clevel,
        "shuffle": "shuffle",
        "typesize": np.dtype(dtype).itemsize,
        "blocksize": SHRINK.blocksize,
    }
    return [
        {"name": "bytes", "configuration": {"endian": "little"}},
        {"name": "blosc", "configuration": shrink},
        {"name": "crc32c"},
    ]


def encoded(values: np.ndarray, chunk: tuple[int, ...], fill: float) -> bytes:
    """Return the bytes of a chunk that begins with the values; the rest, beyond the end of an axis, is `fill`.

    The bytes equal those that Zarr writes, without passing the chunk between threads.
    """
    whole = values
    if values.shape != chunk:
        whole = np.full(chunk, fill, values.dtype)
        whole[tuple(map(slice, values.shape))] = values
    little = np.ascontiguousarray(whole, whole.dtype.newbyteorder("<"))
    return bytes(CHECK.encode(SHRINK.encode(little)))


def make_groups(
    files: Files, spec: SurveySpec, measure: Measurement, levels: list[Level], there: dict[str, Any]
) -> list[zarr.Group]:
    """Return one group for each level, with the attributes of the survey; groups that are not ``there`` are created."""
    metadata = _plain(attributes(spec, measure))
    result = _made(files, {level.name: GroupMetadata(metadata) for level in levels}, there)
    for group in result.values():
        if not files.refusal and group.attrs.asdict() != metadata:
            group.attrs.put(metadata)
    return list(result.values())


def make_arrays(
    files: Files,
    spec: SurveySpec,
    measure: Measurement,
    levels: list[Level],
    there: list[dict[str, Any]],
) -> list[dict[str, zarr.Array]]:
    """Return the variables of each level by name; variables and coordinates are created or enlarged as needed.

    ``there`` holds the existing arrays of each level.
    """
    requested = {
        f"{level.name}/{name}": description
        for level in levels
        for name, description in _descriptions(level, spec, measure).items()
    }
    known = {
        f"{level.name}/{name}": array
        for level, those in zip(levels, there, strict=True)
        for name, array in those.items()
    }
    result = _made(files, requested, known)
    for level in levels:
        for name, values in level.axes.items():
            array = _sized(result[f"{level.name}/{name}"], values.shape)
            for key, content in _chunks(array, values):
                if files.kept(key) != content:  # missing or damaged: the content is known
                    files.keep(key, content)
    return [
        {each.name: _sized(result[f"{level.name}/{each.name}"], level.shape) for each in measure.variables}
        for level in levels
    ]


def _made(files: Files, requested: Mapping[str, Any], there: Mapping[str, Any]) -> dict[str, Any]:
    """Return the wanted groups or arrays by path; missing ones are created from their metadata.

    They are created one at a time, because Zarr prints all but the first of several simultaneous errors on stderr.
    """
    rows = {path: there.get(path) for path in requested}
    for path in [path for path, known in rows.items() if known is None]:
        rows |= zarr.create_hierarchy(store=files, nodes={path: requested[path]})
    return rows


def _descriptions(level: Level, spec: SurveySpec, measure: Measurement) -> dict[str, Any]:
    """Return the metadata of a level: coordinates have a single chunk, variables one chunk per tile."""
    names = list(level.axes)
    along = {
        name: _array(values.shape, values.shape, "float64", math.nan, [name], spec.coordinate(name))
        for name, values in level.axes.items()
    }
    return along | {
        each.name: _array(level.shape, level.tile, each.dtype, each.fill, names, each.attributes)
        for each in measure.variables
    }


def _array(
    shape: Sequence[int],
    chunk: Sequence[int],
    dtype: str,
    fill: float,
    names: list[str],
    metadata: dict[str, Any],
) -> Any:
    return ArrayV3Metadata.from_dict(
        {
            "zarr_format": 3,
            "node_type": "array",
            "shape": list(shape),
            "data_type": dtype,
            "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": list(chunk)}},
            "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
            "fill_value": "NaN" if math.isnan(fill) else fill,
            "codecs": codecs(dtype),
            "dimension_names": names,
            "attributes": _plain(metadata),
        }
    )


def _sized(array: zarr.Array, shape: tuple[int, ...]) -> zarr.Array:
    """Return an array, enlarged to a shape as needed."""
    if array.shape != shape:
        array.resize(shape)
    return array


def _chunks(array: zarr.Array, values: np.ndarray) -> Iterator[tuple[str, bytes]]:
    """Yield the key and the content of each file of a coordinate; an extended axis has several files."""
    (edge,) = array.chunks
    for number, first in enumerate(range(0, values.size, edge)):
        yield f"{array.path}/c/{number}", encoded(values[first : first + edge], (edge,), math.nan)


def _plain(metadata: dict[str, Any]) -> dict[str, Any]:
    """Return attributes with lists instead of arrays, for JSON."""
    return {
        name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in metadata.items()
    }


FOLDER = "digests"
"""Folder of the digests, in that of the variable that is written last: programs that read Zarr do not look there."""
CHANGING = ("axes", "halved", "tiles", "made_by")
"""Metadata of a store that change when it is extended, or that are not compared."""


def survey_key(stored: Mapping[str, Any]) -> bytes:
    """Return the digest of what identifies a survey, from the metadata of its store."""
    fixed = {name: value for name, value in stored.items() if name not in CHANGING}
    return hashlib.sha256(json.dumps(fixed, sort_keys=True).encode()).digest()


def digests(survey: bytes, tile: Tile, points: tuple[int, ...], chunks: Mapping[str, bytes]) -> bytes:
    """Return the content of the file of digests of a tile, as JSON.

    Each digest is a SHA-256 of the bytes of a chunk, the name of its variable, and its place. The place is the key of the survey, the
    level, the index and the axis values of the tile. `points` are the numbers of points along each axis when the chunks were
    written. The tile may have become larger.
    """
    place = hashlib.sha256(survey)
    place.update(json.dumps([tile.level.number, tile.index, points]).encode())
    for (name, values), count in zip(tile.axes().items(), points, strict=True):
        place.update(name.encode() + values[:count].astype("<f8").tobytes())
    rows = {}
    for name, content in chunks.items():
        own = place.copy()
        own.update(json.dumps(name).encode() + content)
        rows[name] = own.hexdigest()
    return json.dumps({"points": points, "sha256": rows}).encode()


def wrong(
    survey: bytes, tile: Tile, stored: bytes, chunks: Mapping[str, bytes]
) -> tuple[tuple[int, ...], list[str]]:
    """Return the numbers of points of a stored file of digests, and the variables whose chunks do not match it.

    ValueError is raised if the file is not one of this tile.
    """
    try:
        said = json.loads(stored)
        points, there = tuple(said["points"]), dict(said["sha256"])
        expected = digests(survey, tile, points, chunks)
    except (ValueError, TypeError, KeyError) as error:
        raise ValueError("no digests of a tile") from error
    if stored == expected:
        return points, []
    differing = [name for name, one in json.loads(expected)["sha256"].items() if there.get(name) != one]
    if not differing:
        raise ValueError("no digests of this tile")
    return points, differing
