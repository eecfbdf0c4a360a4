"""Files out: checked before the work, written under a temporary name beside the target, then renamed."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryFile

from attrs import frozen


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


@frozen
class Made:
    """How a folder that was written here is known: by the names of all that it holds, and a sign in the one of them that is a page."""

    page: str
    beside: tuple[str, ...]
    sign: str

    def is_in(self, folder: Path) -> bool:
        """Whether the folder holds just that."""
        if {each.name for each in folder.iterdir()} != {self.page, *self.beside}:
            return False
        page = folder / self.page
        return page.is_file() and self.sign in page.read_text(encoding="utf-8", errors="replace")


# The page of a map in tiles: one room writes it, another asks before the work whether it may be written.
TILES = Made("index.html", beside=("tiles",), sign='<meta name="generator" content="rocking')


def check_replaceable(name: str, path: str | os.PathLike[str], made: Made) -> Path:
    """Return `path` if `replacing_folder` may write it; OSError in one line that starts with `name` if not."""
    path = check_folder(name, path)
    if Path.cwd().is_relative_to(path.resolve()):
        raise OSError(f"{name} must be another folder than the one this runs in; got {str(path)!r}")
    if path.exists() and any(path.iterdir()) and not made.is_in(path):
        raise FileExistsError(
            f"{name} must be new, empty, or hold just an earlier {made.page} and what belongs to it; got {str(path)!r}, "
            "which holds something else"
        )
    return path


@contextmanager
def replacing_folder(name: str, path: str | os.PathLike[str], made: Made) -> Iterator[Path]:
    """Yield a new folder beside `path` and rename it to `path` if the block succeeds; what stood there goes only then.

    Only a folder that is empty, or that holds what was `made` here before and nothing else, is replaced.

    Raises
    ------
    OSError
        In one line that starts with `name`: something else is there, or the folder cannot be written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     made = Made("index.html", beside=(), sign="a page")
    ...     with replacing_folder("folder", Path(folder) / "map", made) as partial:
    ...         _ = (partial / "index.html").write_text("a page")
    ...     [file.name for file in Path(folder).rglob("*")]
    ['map', 'index.html']
    """
    target = check_replaceable(name, path, made).resolve()
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
