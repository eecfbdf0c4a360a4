"""Where machine code is kept on disk.

The compiler's cache looks only at the file of a function itself, and would serve stale code after an edit of a function
that it calls. So the code lies in a folder named by a hash over all kernel sources.
"""

import hashlib
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numba

SOURCES = Path(__file__).parent


def hash_sources() -> str:
    """Hash all kernel sources, with their places in the package."""
    digest = hashlib.sha256()
    for source in sorted(SOURCES.rglob("*.py")):
        digest.update(source.relative_to(SOURCES).as_posix().encode() + source.read_bytes())
    return digest.hexdigest()[:16]


def find_folder() -> Path | None:
    """Make a folder for these sources in ``NUMBA_CACHE_DIR``, the user's cache, or a temporary folder of the user.

    None where none of them can be written: then the kernels are compiled at every start.
    """
    digest, user = hash_sources(), os.getuid() if hasattr(os, "getuid") else "user"
    homes = (
        lambda: os.environ.get("NUMBA_CACHE_DIR") or os.devnull,
        lambda: os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser(),
        lambda: Path(tempfile.gettempdir(), f"cache-{user}"),
    )
    for home in homes:
        try:
            folder = Path(home(), "rocking", f"kernels-{digest}")
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            with tempfile.TemporaryFile(dir=folder):
                return folder
        except (OSError, RuntimeError):  # RuntimeError: a user without a home
            continue
    return None


FOLDER = find_folder()


@contextmanager
def kept_in_folder() -> Iterator[None]:
    """Let the compiler keep its code in FOLDER while the kernels are defined: its own setting holds for the whole process."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(FOLDER or before)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before
