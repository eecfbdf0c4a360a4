"""Integrity of a store: exclusive access, error messages with a remedy, removal of unfinished files."""

from __future__ import annotations

import os
import re
import signal
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import current_thread, main_thread

from rocking.model.files import check_folder, not_written, resolve_path
from rocking.model.text import formatted_path
from rocking.model.validation import WrongType

ROOT = "zarr.json"
UNFINISHED = re.compile(r"(zarr|\d+)\.[0-9a-f]{32}\.partial")
"""File name of metadata or of a chunk while it is written."""


class StoreError(OSError):
    """Store that cannot be written, is in use by another run or is damaged; the message states the remedy.

    Attributes
    ----------
    argument : str
        "store" if the value of this argument, with which the message begins, is invalid; empty for any other error.
    """

    def __init__(self, message: str, argument: str = "") -> None:
        super().__init__(message)
        self.argument = argument


def check_store(path: str | os.PathLike[str]) -> Path:
    """Return the path of a store; StoreError if it is neither a store of a survey nor a new or empty folder.

    A store may lie where nothing can be written: it can be read.
    """
    place, folder = _place(path), Path(path)
    if not (place / ROOT).is_file():
        with _of_argument():
            check_folder("store", folder)
    names = {each.name for each in place.iterdir()} if place.exists() else set()
    held = {name for name in names if not UNFINISHED.fullmatch(name)}
    if held and ROOT not in held:
        raise something_else(folder, f"a folder that contains {min(held)!r}")
    return folder


def _place(path: str | os.PathLike[str]) -> Path:
    """Return the place of a store, a folder or nothing yet; TypeError or OSError for anything else."""
    if not isinstance(path, str | os.PathLike) or not os.fspath(path):
        raise WrongType("store", "be the path of a folder", path)
    with _of_argument():
        place = resolve_path("store", Path(path))
    if place.exists() and not place.is_dir():
        got = f"{formatted_path(path)}, which is a file"
        raise StoreError(f"store must be the path of a folder; got {got}", "store")
    return place


@contextmanager
def _of_argument() -> Iterator[None]:
    """Convert an error of a path to a StoreError that names the argument."""
    try:
        yield
    except OSError as error:
        raise StoreError(str(error), "store") from error


def store_in(path: str | os.PathLike[str] | None, name: str, number: int) -> Path | None:
    """Return the store with a number in a folder that holds only such stores, as "round-0"; None without a folder.

    StoreError is raised for a folder that is neither this nor new or empty.
    """
    if path is None:
        return None
    place = _place(path)
    if not place.exists():
        check_store(path)
    names = place.iterdir() if place.exists() else ()
    others = sorted(each.name for each in names if not re.fullmatch(rf"{name}-\d+", each.name))
    if others:
        what = "the store of another survey" if ROOT in others else f"a folder that contains {others[0]!r}"
        raise something_else(Path(path), what)
    return Path(path) / f"{name}-{number}"


def something_else(folder: Path, what: str) -> StoreError:
    """Return the error for a folder that is not a store of a survey."""
    got = f"{formatted_path(folder)}, which is {what}"
    return StoreError(f"store must be a new folder, or the folder of an earlier survey; got {got}", "store")


def place_of(folder: Path) -> tuple[int, int] | None:
    """Return the device and the inode of a folder; None if it does not exist."""
    with suppress(OSError):
        result = folder.stat()
        return result.st_dev, result.st_ino
    return None


@contextmanager
def lock(folder: Path, *, shared: bool) -> Iterator[None]:
    """Lock a store; StoreError if another run uses it. The system releases the lock when the process ends.

    Runs that only read a store share it.
    """
    try:
        import fcntl
    except ImportError:  # only Unix has this lock
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
        except BlockingIOError:
            raise StoreError(
                f"store {formatted_path(folder)} is in use by another run; wait until that run ends, or stop it"
            ) from None
        yield
    finally:
        os.close(handle)


@contextmanager
def defer_interrupt() -> Iterator[None]:
    """Defer SIGINT until the store operation has finished; an interrupted one makes Zarr print a warning."""
    # only the main thread handles SIGINT; None: the handler was not installed from Python
    if current_thread() is not main_thread() or signal.getsignal(signal.SIGINT) is None:
        yield
        return
    met: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: met.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if met:
        signal.raise_signal(signal.SIGINT)


@contextmanager
def wrap_write_errors(folder: Path) -> Iterator[None]:
    """Convert a failed write to a StoreError that names the store and the remedy."""
    try:
        yield
    except StoreError:
        raise
    except OSError as error:
        raise StoreError(not_written(f"store {formatted_path(folder)}", error)) from error


@contextmanager
def reading(folder: Path) -> Iterator[None]:
    """Convert unreadable metadata to a StoreError that names the store and the remedy."""
    try:
        yield
    except (StoreError, MemoryError):
        raise
    except PermissionError as error:
        raise StoreError(f"store {formatted_path(folder)} cannot be read: {error.strerror}") from error
    except Exception as error:
        raise StoreError(
            f"store {formatted_path(folder)} is damaged: one of its files {ROOT} cannot be read ({error}); "
            "restore it from a backup, or give another folder"
        ) from error


def remove_unfinished(folder: Path, arrays: Iterable[str]) -> None:
    """Remove unfinished files and empty folders of `arrays` that a killed run left in a store.

    All other files and folders in the store remain.
    """
    own = re.compile(rf"\.|level-\d+(/({'|'.join(map(re.escape, arrays))})(/(c|digests)(/\d+)*)?)?")
    for place, _, files in os.walk(folder, topdown=False):
        below = Path(place).relative_to(folder).as_posix()
        if not own.fullmatch(below):
            continue
        for name in filter(UNFINISHED.fullmatch, files):
            Path(place, name).unlink(missing_ok=True)
        if below != ".":
            with suppress(OSError):  # the folder is not empty
                Path(place).rmdir()
