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


def _cache_folder() -> Path | None:
    """A folder for this exact set of kernel sources: ``NUMBA_CACHE_DIR``, the user's cache, or his own temporary one.

    None where none of them can be written: then the kernels are compiled at every start.
    """
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.name.encode() + source.read_bytes())
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    usual = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()
    user = os.getuid() if hasattr(os, "getuid") else "user"
    for home in (chosen, usual, Path(tempfile.gettempdir()) / f"cache-{user}"):
        folder = Path(home or os.devnull) / "rocking" / f"kernels-{digest.hexdigest()[:16]}"
        try:
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            with tempfile.TemporaryFile(dir=folder):
                return folder
        except OSError:
            continue
    return None


@contextmanager
def _cached_in(folder: Path | None):
    """The compiler's cache folder is a setting of the whole process: ours only while our own kernels are defined."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(folder or "")
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


with _cached_in(_cache_folder()):
    from . import (
        averages,
        chain,
        crossing,
        curve,
        desk,
        events,
        follow,
        impact,
        judgement,
        manifold,
        many,
        march,
        notes,
        parameters,
        points,
        rounds,
        sample,
        search,
        steps,
        sweep,
        symmetric,
        tangent,
        verdict,
    )

__all__ = [
    "averages",
    "chain",
    "crossing",
    "curve",
    "desk",
    "events",
    "follow",
    "impact",
    "judgement",
    "manifold",
    "many",
    "march",
    "notes",
    "parameters",
    "points",
    "rounds",
    "sample",
    "search",
    "steps",
    "sweep",
    "symmetric",
    "tangent",
    "verdict",
]
