"""Bytes of a record file, with its name and digest."""

from __future__ import annotations

import hashlib
import os
import stat
from pathlib import Path

from rocking.model import refusal
from rocking.records.channel import RecordError

MAX_BYTES = 300_000_000


class Content:
    """Bytes of a regular file of limited size."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        if not isinstance(path, str | os.PathLike):
            raise TypeError(refusal("source", "be a path, or a Stream or Trace of ObsPy", path))
        place = Path(path)
        self.name = place.name
        shown = " ".join(os.fspath(place).split())
        try:
            about = place.stat()
            if stat.S_ISDIR(about.st_mode):
                raise RecordError(f"{shown}: a folder; give the path of one file")
            if not stat.S_ISREG(about.st_mode):
                raise RecordError(f"{shown}: not a regular file")
            if about.st_size > MAX_BYTES:
                raise RecordError(f"{shown}: larger than {MAX_BYTES // 1_000_000} MB")
            self.data = place.read_bytes()
        except (OSError, ValueError) as error:
            if isinstance(error, RecordError):
                raise
            reason = getattr(error, "strerror", None) or error
            raise RecordError(f"{shown}: cannot be read: {reason}") from error
        if not self.data.strip():
            raise RecordError(f"{shown}: the file is empty")
        self.sha256 = hashlib.sha256(self.data).hexdigest()

    @property
    def is_text(self) -> bool:
        """True if no byte is 0, as in every text."""
        return b"\0" not in self.data
