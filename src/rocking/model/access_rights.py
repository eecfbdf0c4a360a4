"""Access rights: whether a folder takes files, and those of what replaces an existing file or folder."""

from __future__ import annotations

import os
import shutil
import stat
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile

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
