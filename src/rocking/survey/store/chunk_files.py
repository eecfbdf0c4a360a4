"""The files of a store: where they are written, and how a variable's chunk becomes one."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Any

import numpy as np
from numcodecs import Blosc
from numcodecs.checksum32 import CRC32C
from zarr.abc.buffer import Buffer, BufferPrototype
from zarr.abc.store import ByteRequest
from zarr.buffer import default_buffer_prototype
from zarr.storage import LocalStore

from rocking.survey.store.locking import ROOT

SHRINK = Blosc("lz4", clevel=1, shuffle=Blosc.SHUFFLE)
"""A map takes a sixth of the room, and less time: to shrink a chunk takes a tenth of what writing the rest of it would."""
CHECK = CRC32C()


class Files(LocalStore):
    """A folder whose files are read and written where that is asked.

    Zarr hands each file to a thread of its own pool. Files are small here, and all cores compute meanwhile: the handing
    over would cost more than the file.
    """

    async def get(
        self, key: str, prototype: BufferPrototype | None = None, byte_range: ByteRequest | None = None
    ) -> Buffer | None:
        """What a file holds, or None."""
        return self.get_sync(key, prototype=prototype, byte_range=byte_range)

    async def set(self, key: str, value: Buffer) -> None:
        """Write a file, under another name first."""
        self.set_sync(key, value)

    async def list_dir(self, prefix: str) -> AsyncIterator[str]:
        """Give the names of the groups and arrays in a folder. Zarr would warn of all that others keep there."""
        folder = self.root / prefix
        async for name in super().list_dir(prefix):
            if (folder / name / ROOT).exists():
                yield name

    def kept(self, key: str) -> bytes | None:
        """The bytes of a file, or None."""
        found = self.get_sync(key)
        return None if found is None else found.to_bytes()

    def keep(self, key: str, content: bytes) -> None:
        """Write these bytes."""
        self.set_sync(key, default_buffer_prototype().buffer.from_bytes(content))


def codecs(dtype: str) -> list[dict[str, Any]]:
    """What `encoded` does, as Zarr's third format describes it."""
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
    """A chunk with these values, or with these at its beginning if an axis ends within it.

    Zarr's own writing of it has the same bytes, after two hand-overs between threads.
    """
    whole = values
    if values.shape != chunk:
        whole = np.full(chunk, fill, values.dtype)
        whole[tuple(map(slice, values.shape))] = values
    little = np.ascontiguousarray(whole, whole.dtype.newbyteorder("<"))
    return bytes(CHECK.encode(SHRINK.encode(little)))
