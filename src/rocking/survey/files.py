"""The files of a store."""

from __future__ import annotations

from zarr.abc.store import ByteRequest
from zarr.core.buffer import Buffer, BufferPrototype
from zarr.storage import LocalStore


class Files(LocalStore):
    """A folder whose files are read and written where that is asked.

    Zarr hands each file to a thread of its own pool. Files are small here, and all cores compute meanwhile: a quarter of
    what storing a map of a million points took was the handing over.
    """

    async def get(
        self, key: str, prototype: BufferPrototype | None = None, byte_range: ByteRequest | None = None
    ) -> Buffer | None:
        """What a file holds, or None."""
        return self.get_sync(key, prototype=prototype, byte_range=byte_range)

    async def set(self, key: str, value: Buffer) -> None:
        """Write a file, under another name first."""
        self.set_sync(key, value)
