"""Bytes of a record file, with its name and digest."""

from __future__ import annotations

import hashlib
import os
import stat
from pathlib import Path

from rocking.model import both_ends, refusal
from rocking.records.channel import RecordError

MAX_BYTES = 300_000_000


class Content:
    """Bytes of a regular file of limited size, or bytes in memory with a name."""

    def __init__(self, source: str | os.PathLike[str] | bytes, name: str | None = None) -> None:
        if isinstance(source, bytes):
            self._keep(source, "bytes" if name is None else name)
        elif name is not None:
            raise TypeError(refusal("name", "be omitted for a source that is not bytes", name))
        elif isinstance(source, str | os.PathLike):
            self._read(Path(source))
        else:
            raise TypeError(refusal("source", "be a path, bytes, or a Stream or Trace of ObsPy", source))

    def _keep(self, data: bytes, name: str) -> None:
        """Take over bytes in memory."""
        if not isinstance(name, str):
            raise TypeError(refusal("name", "be a str", name))
        self.name = name
        shown = both_ends(name)
        if len(data) > MAX_BYTES:
            raise RecordError(f"{shown}: larger than {MAX_BYTES // 1_000_000} MB")
        self._take(data, shown)

    def _read(self, place: Path) -> None:
        """Read a file."""
        self.name = place.name
        shown = both_ends(os.fspath(place))
        try:
            about = place.stat()
            if stat.S_ISDIR(about.st_mode):
                raise RecordError(f"{shown}: a folder; give the path of one file")
            if not stat.S_ISREG(about.st_mode):
                raise RecordError(f"{shown}: not a regular file")
            if about.st_size > MAX_BYTES:
                raise RecordError(f"{shown}: larger than {MAX_BYTES // 1_000_000} MB")
            data = place.read_bytes()
        except (OSError, ValueError) as error:
            if isinstance(error, RecordError):
                raise
            reason = getattr(error, "strerror", None) or error
            advice = "; check the path" if isinstance(error, FileNotFoundError) else ""
            raise RecordError(f"{shown}: cannot be read: {reason}{advice}") from error
        self._take(data, shown)

    def _take(self, data: bytes, shown: str) -> None:
        if not data.strip():
            raise RecordError(f"{shown}: the file is empty")
        self.data = data
        self.sha256 = hashlib.sha256(self.data).hexdigest()

    @property
    def is_text(self) -> bool:
        """True if no byte is 0, as in every text."""
        return b"\0" not in self.data
