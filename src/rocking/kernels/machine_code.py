"""Location of the cached machine code on disk.

The compiler's cache checks only the file of the function itself. It would load stale code after an edit of a
function that this one calls. So the cache folder is named by a hash over all kernel sources.
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
    """Hash all kernel sources, with their paths inside the package."""
    digest = hashlib.sha256()
    for source in sorted(SOURCES.rglob("*.py")):
        digest.update(source.relative_to(SOURCES).as_posix().encode() + source.read_bytes())
    return digest.hexdigest()[:16]


def find_folder() -> Path | None:
    """Create a cache folder for these sources, in the first of three places that is writable.

    The places are ``NUMBA_CACHE_DIR``, the user's cache and a temporary folder of the user. Returns None if
    none of them is writable: then the kernels are compiled at every start.
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
    """Let the compiler use FOLDER as its cache while the kernels are defined.

    The compiler's own setting is restored afterwards because it applies to the whole process.
    """
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(FOLDER or before)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before
