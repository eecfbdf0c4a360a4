"""Atomic output: paths are checked before the work, and files are written under a temporary name, then renamed.

Access rights of an existing file or folder stay. An output that cannot be written is one sentence.
"""

from __future__ import annotations

import errno
import io
import os
import re
import secrets
import shutil
import stat
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

from attrs import frozen

from rocking.model.package import require_format
from rocking.model.text import formatted_path
from rocking.model.validation import Refusal, Text, WrongType

PRIVATE, PRIVATE_FOLDER = 0o600, 0o700
"""Permissions of what replaces an existing file or folder, until it has the permissions of that one."""


def keep_access(before: Path, made: Path) -> None:
    """Give a file or folder the permissions of the one that it replaces and, where allowed, its owner and group.

    If the group cannot be kept, another group gets no more permissions than all other users have. Extended attributes, such as lists
    of access rights, are then left out.
    """
    old = before.stat()
    if hasattr(os, "chown"):  # Windows has none
        for owner in (old.st_uid, -1):
            with suppress(OSError):  # also a group that a user namespace does not have
                os.chown(made, owner, old.st_gid)
                break
    if made.stat().st_gid == old.st_gid:
        shutil.copystat(before, made)
        os.utime(made)
    else:
        others = old.st_mode & stat.S_IRWXO
        made.chmod(stat.S_IMODE(old.st_mode) & ~(stat.S_IRWXG & ~(others << 3)))


def takes_files(folder: Path) -> bool:
    """Return whether a file can be created in the folder, by creating one: permissions alone do not show it."""
    try:
        with TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
"""Error numbers of the operating system for a full disk, an exhausted quota and a file that is too large."""
DENIED = {errno.EACCES, errno.EPERM, errno.EROFS}
"""Error numbers for missing permissions and for a system of files that is read only."""


class WriteError(OSError):
    """Output that cannot be written, for example on a full disk. The message names it and the remedy."""


def not_written(what: str, error: OSError) -> str:
    """Return the message of a failed write, with a remedy that fits the error."""
    remedy = "give another path"
    if error.errno in FULL:
        remedy = f"free some space, or {remedy}"
    if error.errno in DENIED:
        remedy = f"give permission to write, or {remedy}"
    why = error.strerror or error
    return f"{what} cannot be written: {why}; existing data are unchanged ({remedy})"


def path_of(name: str, value: Any) -> Path:
    """Return a path; TypeError, whose message begins with `name`, for anything but a text or an object of `pathlib`."""
    if not isinstance(value, str | os.PathLike):
        raise WrongType(name, "be a path", value)
    return Path(value)


def resolve_path(name: str, path: str | os.PathLike[str]) -> Path:
    """Return the absolute path with all links followed.

    Raises
    ------
    TypeError
        If `path` is no path.
    OSError
        If no file can have this path. The message begins with `name`.
    """
    try:
        place = path_of(name, path).resolve()
        place.exists()
        if place.is_symlink():
            raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
    except (OSError, RuntimeError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        if isinstance(error, FileNotFoundError):  # only a missing working directory raises it here
            why = "the working directory does not exist any more"
        raise OSError(f"{name} must be a path that can exist; got {formatted_path(path)}: {why}") from error
    return place


def check_writable(name: str, path: str | os.PathLike[str], suffixes: Sequence[str] = ()) -> Path:
    """Return `path` if a file can be written there. The check leaves no file behind.

    Parameters
    ----------
    name : str
        Name of the argument, for messages.
    path : path-like
        Path to check.
    suffixes : sequence of str
        Allowed endings, such as ".png". Default: (), any ending.

    Raises
    ------
    ValueError
        If the ending is not one of `suffixes`.
    ImportError
        If the format needs an extra that is not installed.
    OSError
        If the folder does not exist, permission is denied, or the path exists and is no regular file.
    """
    path = path_of(name, path)
    if suffixes and path.suffix.lower() not in suffixes:
        raise Refusal(name, f"end in {', '.join(suffixes)}", Text(formatted_path(path)))
    require_format(path)
    place = resolve_path(name, path)
    if not place.parent.is_dir():
        raise FileNotFoundError(f"{name} must lie in an existing folder; got {formatted_path(path)}")
    if place.exists() and not place.is_file():
        raise OSError(
            f"{name} must be the path of a file; got {formatted_path(path)}, which is not a regular file"
        )
    if not takes_files(place.parent) or (place.exists() and not os.access(place, os.W_OK)):
        raise PermissionError(f"{name} must be writable; got {formatted_path(path)}, which is not")
    return path


def check_folder(name: str, path: str | os.PathLike[str]) -> Path:
    """Return `path` if it is a writable folder or can be created in one.

    Raises
    ------
    OSError
        If it is neither. The message begins with `name`.
    """
    path = path_of(name, path)
    place = resolve_path(name, path)
    existing = next(each for each in (place, *place.parents) if each.exists())
    if not existing.is_dir() or not takes_files(existing):
        raise OSError(f"{name} must be a folder that can be written; got {formatted_path(path)}")
    return path


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a temporary path next to `path`, with its suffix, and rename it to `path` if the block succeeds.

    On any failure, including Ctrl-C, the temporary file is removed and an existing file at `path` is unchanged.
    If `path` is a link, the file that it points to is replaced. The new file has the permissions of the file that it
    replaces and, where the system allows it, its owner and group.

    Raises
    ------
    WriteError
        If the operating system rejects the write.

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
    with _writing(path), renaming(temporary, target):
        yield temporary


@contextmanager
def renaming(temporary: Path, target: Path) -> Iterator[None]:
    """Rename the file `temporary` to `target` if the block succeeds; remove it on any failure.

    The block writes `temporary`, which exists before only if `target` exists: no other user can read it then. It gets the access
    rights of `target` before it is renamed.
    """
    try:
        replaces = target.exists()
        if replaces:
            os.close(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, PRIVATE))
        yield
        if replaces:
            keep_access(target, temporary)
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def _temporary_name() -> str:
    """Return a unique hidden file name, short enough for a path near the length limit."""
    return f".rocking-{secrets.token_hex(8)}"


@contextmanager
def _writing(path: str | os.PathLike[str]) -> Iterator[None]:
    """Convert an error of the operating system during a write into a `WriteError` that names the path."""
    try:
        yield
    except Exception as error:
        if (failure := _system_error(error)) is None or failure.errno is None:
            raise
        raise WriteError(not_written(formatted_path(path), failure)) from error


def _system_error(error: BaseException | None) -> OSError | None:
    """Return the error of the operating system behind `error`, or None.

    The context chain is searched for a full disk only, because libraries report it late.
    """
    if isinstance(error, OSError) and error.errno is not None:
        return error
    while error is not None and getattr(error, "errno", None) not in FULL:
        error = error.__context__
    return error if isinstance(error, OSError) else None


class _Hdf5File(io.FileIO):
    """File for the HDF5 library that never reports a failed write to it: the library crashes on one.

    The first error is kept in `failure`, to be raised after the library has closed.
    """

    failure: OSError | None = None

    def write(self, content: Any, /) -> int:
        """Write unless an earlier write failed, and report success."""
        self._attempt(super().write, content)
        return memoryview(content).nbytes

    def truncate(self, size: int | None = None, /) -> int:
        """Set the size unless an earlier write failed, and report success."""
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
    """Yield an open file for the HDF5 library, and rename it to `path` if the block succeeds, as in `replacing`."""
    with replacing(path) as temporary, _Hdf5File(temporary, "w+") as file:
        try:
            yield file
        finally:
            if file.failure is not None:
                raise file.failure


@frozen
class Made:
    """Signature of a folder written by this package: its index page, with a sign in it, and the names in it.

    Attributes
    ----------
    page : str
        Name of the index page.
    others, folders : str
        Regular expressions of the relative paths of all other files and of all folders.
    sign : str
        Text that the index page contains.
    """

    page: str
    others: str
    folders: str
    sign: str

    def is_in(self, folder: Path) -> bool:
        """Return whether the folder holds exactly these files and folders, and no link."""
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


# Page of a map in tiles. `plot` writes it, and `cli` checks the path before the computation.
TILES = Made(
    "index.html",
    others=r"tiles/\d+/\d+-\d+(-[a-z]+)?\.png",
    folders=r"tiles(/\d+)?",
    sign='<meta name="generator" content="rocking',
)


def check_replaceable(name: str, path: str | os.PathLike[str], made: Made) -> Path:
    """Return `path` if `replacing_folder` may write it.

    Raises
    ------
    OSError
        If it may not. The message begins with `name`.
    """
    path = check_folder(name, path)
    with suppress(FileNotFoundError):  # the working directory may be gone
        if Path.cwd().is_relative_to(path.resolve()):
            raise OSError(f"{name} must not contain the working directory; got {formatted_path(path)}")
    if path.exists() and any(path.iterdir()) and not made.is_in(path):
        raise FileExistsError(
            f"{name} must be new, empty, or hold only an earlier {made.page} with its files; got {formatted_path(path)}, "
            "which holds other files"
        )
    return path


@contextmanager
def replacing_folder(name: str, path: str | os.PathLike[str], made: Made) -> Iterator[Path]:
    """Yield a new folder next to `path` and rename it to `path` if the block succeeds.

    An existing folder is replaced only if it is empty or holds nothing but earlier output, as `made` describes
    it. It is removed only after the block has succeeded. Permissions and owners are kept as in `replacing`.

    Raises
    ------
    OSError
        If other files are there, or the folder cannot be written. The message begins with `name`.

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
            temporary.mkdir(PRIVATE_FOLDER if target.exists() else 0o777)
            yield temporary
            if target.exists():
                for each in (*temporary.rglob("*"), temporary):
                    if (known := target / each.relative_to(temporary)).exists():
                        keep_access(known, each)
                target.rename(before)
            temporary.rename(target)
    finally:
        for left in (temporary, before):
            shutil.rmtree(left, ignore_errors=True)
