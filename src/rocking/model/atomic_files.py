"""Files out: checked before the work, written under a temporary name beside the target, then renamed."""

from __future__ import annotations

import errno
import io
import os
import re
import secrets
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

from attrs import frozen

FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
"""What the system says of a disk, a quota or a file that is full."""


class WriteError(OSError):
    """An output that cannot be written, a full disk for example; the message names it and says what to do."""


def resolve_path(name: str, path: str | os.PathLike[str]) -> Path:
    """Return `path` with its links followed; OSError in one line that starts with `name` where no file can have it."""
    try:
        place = Path(path).resolve()
        place.exists()
        if place.is_symlink():
            raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
    except (OSError, RuntimeError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        if isinstance(error, FileNotFoundError):  # of all that is asked only the working directory must exist
            why = "the working directory does not exist any more"
        raise OSError(f"{name} must be a path that can exist; got {os.fspath(path)!r}: {why}") from error
    return place


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
    place = resolve_path(name, path)
    if not place.parent.is_dir():
        raise FileNotFoundError(f"{name} must lie in an existing folder; got {str(path)!r}")
    if place.exists() and not place.is_file():
        raise OSError(f"{name} must be a file's name; got {str(path)!r}, which is something else")
    if not _takes_files(place.parent) or (place.exists() and not os.access(place, os.W_OK)):
        raise PermissionError(f"{name} must be writable; got {str(path)!r}, which is not")
    return path


def check_folder(name: str, path: str | os.PathLike[str]) -> Path:
    """Return `path` if it is a folder that takes files, or may be made in one; OSError in one line that starts with `name` if not."""
    path = Path(path)
    existing = resolve_path(name, path)
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
    followed: the file that it points to is replaced. Where the system refuses to write, `WriteError` says why.

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
    temporary = target.with_name(_temporary_name() + target.suffix)
    try:
        with _writing(path):
            yield temporary
            temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def _temporary_name() -> str:
    """A name that nothing else has, shorter than most: a long name leaves no room for more."""
    return f".rocking-{secrets.token_hex(8)}"


@contextmanager
def _writing(path: str | os.PathLike[str]) -> Iterator[None]:
    """Say of a write that the system refused which file or folder it was, and how to go on."""
    try:
        yield
    except Exception as error:
        failure = _system_error(error)
        if failure is None or failure.errno is None:
            raise
        raise WriteError(
            f"{os.fspath(path)!r} cannot be written: {failure.strerror}; what was there before is unchanged: "
            "make room, or give another place"
        ) from error


def _system_error(error: BaseException | None) -> OSError | None:
    """The refusal of the system that led to an error, if any; a full disk also where a library stumbled over it later."""
    if isinstance(error, OSError) and error.errno is not None:
        return error
    while error is not None and getattr(error, "errno", None) not in FULL:
        error = error.__context__
    return error if isinstance(error, OSError) else None


class _Hdf5File(io.FileIO):
    """A file that tells the HDF5 library that all is written, and keeps what the system said: on a refusal that library crashes."""

    failure: OSError | None = None

    def write(self, content: Any, /) -> int:
        """Write, unless an earlier write failed."""
        self._attempt(super().write, content)
        return memoryview(content).nbytes

    def truncate(self, size: int | None = None, /) -> int:
        """Set the size, unless an earlier write failed."""
        self._attempt(super().truncate, size)
        return self.tell() if size is None else size

    def _attempt(self, change: Callable[[Any], object], value: Any) -> None:
        if self.failure is None:
            try:
                change(value)
            except OSError as error:
                self.failure = error


@contextmanager
def replacing_hdf5(path: str | os.PathLike[str]) -> Iterator[io.FileIO]:
    """Yield an open file for the HDF5 library, which is renamed to `path` if the block succeeds, as `replacing` does."""
    with replacing(path) as temporary, _Hdf5File(temporary, "w+") as file:
        try:
            yield file
        finally:
            if file.failure is not None:
                raise file.failure


@frozen
class Made:
    """How a folder that was written here is known: by a page with a sign in it, and by the paths of all other files and folders."""

    page: str
    others: str
    folders: str
    sign: str

    def is_in(self, folder: Path) -> bool:
        """Whether the folder holds just that, and no link; `others` and `folders` are regular expressions."""
        page = folder / self.page
        if not page.is_file() or self.sign not in page.read_text(encoding="utf-8", errors="replace"):
            return False
        return all(self._is_own(each, each.relative_to(folder).as_posix()) for each in folder.rglob("*"))

    def _is_own(self, path: Path, name: str) -> bool:
        if path.is_symlink():
            return False
        if path.is_dir():
            return re.fullmatch(self.folders, name) is not None
        return name == self.page or re.fullmatch(self.others, name) is not None


# The page of a map in tiles: one room writes it, another asks before the work whether it may be written.
TILES = Made(
    "index.html",
    others=r"tiles/\d+/\d+-\d+(-[a-z]+)?\.png",
    folders=r"tiles(/\d+)?",
    sign='<meta name="generator" content="rocking',
)


def check_replaceable(name: str, path: str | os.PathLike[str], made: Made) -> Path:
    """Return `path` if `replacing_folder` may write it; OSError in one line that starts with `name` if not."""
    path = check_folder(name, path)
    with suppress(FileNotFoundError):  # the working directory may be gone
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
    ...     made = Made("index.html", others="", folders="", sign="a page")
    ...     with replacing_folder("folder", Path(folder) / "map", made) as partial:
    ...         _ = (partial / "index.html").write_text("a page")
    ...     [file.name for file in Path(folder).rglob("*")]
    ['map', 'index.html']
    """
    target = check_replaceable(name, path, made).resolve()
    temporary, before = (target.with_name(_temporary_name()) for _ in range(2))
    try:
        with _writing(path):
            target.parent.mkdir(parents=True, exist_ok=True)
            temporary.mkdir()
            yield temporary
            if target.exists():
                target.rename(before)
            temporary.rename(target)
    finally:
        for left in (temporary, before):
            shutil.rmtree(left, ignore_errors=True)
