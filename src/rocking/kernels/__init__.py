"""The compiled physics: numbers in, numbers out.

Machine code is cached on disk. The compiler's cache looks only at the file of the kernel itself and would
serve stale code after an edit of a function it calls, so the cache lies in a folder named by a hash over
all kernel sources.
"""

import hashlib
import os
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numba


def _cache_folder() -> Path:
    """A folder for this exact set of kernel sources, in the user's cache; a temporary one where that cannot be written."""
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.name.encode() + source.read_bytes())
    home = os.environ.get("NUMBA_CACHE_DIR") or os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    folder = Path(home) / "rocking" / f"kernels-{digest.hexdigest()[:16]}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError:
        return Path(tempfile.mkdtemp(prefix="rocking-kernels-"))


@contextmanager
def _cached_in(folder: Path):
    """The compiler's cache folder is a setting of the whole process: ours only while our own kernels are defined."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(folder)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


with _cached_in(_cache_folder()):
    from . import crossing, events, impact, march, parameters, sample, tangent

__all__ = ["crossing", "events", "impact", "march", "parameters", "sample", "tangent"]
