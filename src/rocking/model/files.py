"""Files out: checked before the work, written under a temporary name beside the target, then renamed."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path


def check_writable(name: str, path: str | os.PathLike[str], suffixes: Sequence[str] = ()) -> Path:
    """Return `path` if a file may be written there; refuse it in one line that starts with `name` otherwise.

    Nothing is created. `suffixes` are the endings allowed ("`.png`"); none: any.

    Raises
    ------
    ValueError
        An ending that is not among `suffixes`.
    OSError
        No such folder, no permission, or something that is no plain file is there already.
    """
    path = Path(path)
    if suffixes and path.suffix.lower() not in suffixes:
        raise ValueError(f"{name} must end in {', '.join(suffixes)}; got {str(path)!r}")
    folder = path.resolve().parent
    if not folder.is_dir():
        raise FileNotFoundError(f"{name} must lie in an existing folder; got {str(path)!r}")
    if path.exists() and not path.is_file():
        raise OSError(f"{name} must be a file's name; got {str(path)!r}, which is something else")
    if not os.access(folder, os.W_OK | os.X_OK) or (path.exists() and not os.access(path, os.W_OK)):
        raise PermissionError(f"{name} must be writable; got {str(path)!r}, which you may not write")
    return path


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary name beside `path`, with its suffix, and rename it to `path` if the block succeeds.

    On any failure, Ctrl-C included, the temporary file is removed and what stood at `path` stays untouched. A link is
    followed: the file that it points to is replaced.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     with replacing(Path(folder) / "table.csv") as temporary:
    ...         _ = temporary.write_text("time,angle")
    ...     [file.name for file in Path(folder).iterdir()]
    ['table.csv']
    """
    target = Path(path).resolve()
    temporary = target.with_name(f".{target.stem}-{secrets.token_hex(4)}{target.suffix}")
    try:
        yield temporary
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)
