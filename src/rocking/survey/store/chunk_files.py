"""Files of a store: synchronous access, and the encoding of chunks."""

from __future__ import annotations

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
from numcodecs import Blosc
from numcodecs.checksum32 import CRC32C
from zarr.abc.buffer import Buffer, BufferPrototype
from zarr.abc.store import ByteRequest
from zarr.buffer import default_buffer_prototype
from zarr.storage import LocalStore

from rocking.model.files import renaming
from rocking.model.text import shown_path
from rocking.survey.store.locking import ROOT, StoreError, place_of

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
                f"store {shown_path(self.root)} was moved, deleted or replaced during the run, which writes nothing more "
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
        found = self.get_sync(key)
        return None if found is None else found.to_bytes()

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
