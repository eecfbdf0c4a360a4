"""Errors of output that cannot be written."""

from __future__ import annotations

import errno

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
