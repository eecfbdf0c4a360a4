"""What keeps a store whole: one run at a time, errors that say how to go on, nothing left of a killed one."""

from __future__ import annotations

import os
import re
import signal
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import current_thread, main_thread

from rocking.model import check_folder, refusal, resolve_path

ROOT = "zarr.json"
UNFINISHED = re.compile(r"(zarr|\d+)\.[0-9a-f]{32}\.partial")
"""The name of a description or of a chunk while Zarr writes it."""


class StoreError(OSError):
    """A store that cannot be written, that another run writes, or that is damaged; the message says what to do."""


def check_store(path: str | os.PathLike[str]) -> Path:
    """Refuse what is neither a survey's store nor a folder that may become one."""
    if not isinstance(path, str | os.PathLike) or not os.fspath(path):
        raise TypeError(refusal("store", "be the path of a folder", path))
    folder = Path(path)
    place = resolve_path("store", folder)
    if place.exists() and not place.is_dir():
        raise StoreError(f"store must be a folder's name; got {str(path)!r}, which is a file")
    check_folder("store", folder)
    names = {each.name for each in place.iterdir()} if place.exists() else set()
    held = {name for name in names if not UNFINISHED.fullmatch(name)}
    if held and ROOT not in held:
        raise StoreError(something_else(folder, f"a folder with {min(held)!r} in it"))
    return folder


def something_else(folder: Path, what: str) -> str:
    """How a folder that is no survey's store is refused."""
    return f"store must be a new folder, or one of a survey; got {str(folder)!r}, which is {what}"


@contextmanager
def exclusive_lock(folder: Path) -> Iterator[None]:
    """Refuse a second run on one store. The system ends the lock with the process, however that ends."""
    try:
        import fcntl
    except ImportError:  # elsewhere than on Unix nothing keeps a second run away
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise StoreError(
                f"store {str(folder)!r} is being written by another run; wait for its end, or stop it"
            ) from None
        yield
    finally:
        os.close(handle)


@contextmanager
def defer_interrupt() -> Iterator[None]:
    """Ctrl-C waits for the end of what is done with a store: in the midst of it zarr would leave a warning behind."""
    # Ctrl-C is the main thread's; None: its handler is not Python's
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
    """Say of a write that failed which store it was, and how to go on."""
    try:
        yield
    except StoreError:
        raise
    except OSError as error:
        why = error.strerror or str(error)
        raise StoreError(
            f"store {str(folder)!r} cannot be written: {why}; what is there stays good: make room, then ask the same again"
        ) from error


@contextmanager
def reading(folder: Path) -> Iterator[None]:
    """Say of descriptions that cannot be read which store they are of."""
    try:
        yield
    except Exception as error:
        raise StoreError(
            f"store {str(folder)!r} is damaged: one of its files {ROOT} cannot be read ({error}); "
            "put it back from a copy, or give another folder"
        ) from error


def remove_unfinished(folder: Path, arrays: Iterable[str]) -> None:
    """Remove what a killed run left in a survey's store: unfinished files, and folders of its `arrays` that hold nothing.

    All other names in the store are left alone.
    """
    own = re.compile(rf"\.|level-\d+(/({'|'.join(map(re.escape, arrays))})(/c(/\d+)*)?)?")
    for place, _, files in os.walk(folder, topdown=False):
        below = Path(place).relative_to(folder).as_posix()
        if not own.fullmatch(below):
            continue
        for name in filter(UNFINISHED.fullmatch, files):
            Path(place, name).unlink(missing_ok=True)
        if below != ".":
            with suppress(OSError):  # it holds something
                Path(place).rmdir()
