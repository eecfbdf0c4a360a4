"""Files out: checked before the work, written under a temporary name beside the target, then renamed."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile


def check_writable(name: str, path: str | os.PathLike[str], suffixes: Sequence[str] = ()) -> Path:
    """Return `path` if a file may be written there; refuse it in one line that starts with `name` otherwise.

    Nothing is left there. `suffixes` are the endings allowed ("`.png`"); none: any.

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
    if not path.resolve().parent.is_dir():
        raise FileNotFoundError(f"{name} must lie in an existing folder; got {str(path)!r}")
    if path.exists() and not path.is_file():
        raise OSError(f"{name} must be a file's name; got {str(path)!r}, which is something else")
    if not _takes_files(path.resolve().parent) or (path.exists() and not os.access(path, os.W_OK)):
        raise PermissionError(f"{name} must be writable; got {str(path)!r}, which is not")
    return path


def check_folder(name: str, path: str | os.PathLike[str]) -> Path:
    """Return `path` if it is a folder that takes files, or may be made in one; OSError in one line that starts with `name` if not."""
    path = Path(path)
    existing = path.resolve()
    while not existing.exists():
        existing = existing.parent
    if not existing.is_dir() or not _takes_files(existing):
        raise OSError(f"{name} must be a folder that can be written; got {str(path)!r}")
    return path


def _takes_files(folder: Path) -> bool:
    """Whether a file can be made there, found out by making one: permissions alone do not tell."""
    try:
        with TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


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


def check_replaceable(name: str, path: str | os.PathLike[str], mark: str) -> Path:
    """Return `path` if `replacing_folder` may write it; OSError in one line that starts with `name` if not."""
    path = check_folder(name, path)
    if path.exists() and any(path.iterdir()) and not (path / mark).is_file():
        raise FileExistsError(
            f"{name} must be new, empty, or hold an earlier {mark}; got {str(path)!r}, which holds something else"
        )
    return path


@contextmanager
def replacing_folder(name: str, path: str | os.PathLike[str], mark: str) -> Iterator[Path]:
    """Yield a new folder beside `path` and rename it to `path` if the block succeeds; what stood there goes only then.

    Only a folder that is empty, or that holds a file called `mark` (one written before), is replaced.

    Raises
    ------
    OSError
        In one line that starts with `name`: something else is there, or the folder cannot be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     with replacing_folder("folder", Path(folder) / "map", "index.html") as partial:
    ...         _ = (partial / "index.html").write_text("a page")
    ...     [file.name for file in Path(folder).rglob("*")]
    ['map', 'index.html']
    """
    target = check_replaceable(name, path, mark).resolve()
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary, before = (target.with_name(f".{target.name}-{secrets.token_hex(4)}") for _ in range(2))
    try:
        temporary.mkdir()
        yield temporary
        if target.exists():
            target.rename(before)
        temporary.rename(target)
    finally:
        for left in (temporary, before):
            shutil.rmtree(left, ignore_errors=True)
