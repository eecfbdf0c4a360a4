"""The compiled physics: numbers in, numbers out.

Machine code is cached on disk. The compiler's cache looks only at the file of the kernel itself and would
serve stale code after an edit of a function it calls, so the cache lies in a folder named by a hash over
all kernel sources. That a kernel is compiled, which takes most of a minute, is told once to the log ``rocking``.
"""

import hashlib
import logging
import os
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numba
from numba.core import event


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


class _Compiling(event.Listener):
    """Hears the compiler start, tells it, and hears no more."""

    def on_start(self, _: event.Event) -> None:
        event.unregister("numba:compile", self)
        logging.getLogger("rocking").info("compiling, once for this machine: most of a minute")

    def on_end(self, _: event.Event) -> None:
        """Nothing: one start is enough."""


def _tell_of_compiling() -> None:
    """What comes from the cache is not compiled, and not told."""
    event.register("numba:compile", _Compiling())


_tell_of_compiling()
with _cached_in(_cache_folder()):
    from . import (
        answers,
        averages,
        branchless,
        chain,
        crossing,
        curve,
        desk,
        events,
        follow,
        impact,
        judgement,
        lane_block,
        lane_brace,
        lane_event,
        lane_impact,
        lane_instant,
        lane_march,
        lane_walk,
        lane_zero,
        lanes,
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
        together,
        verdict,
        walk,
    )

__all__ = [
    "answers",
    "averages",
    "branchless",
    "chain",
    "crossing",
    "curve",
    "desk",
    "events",
    "follow",
    "impact",
    "judgement",
    "lane_block",
    "lane_brace",
    "lane_event",
    "lane_impact",
    "lane_instant",
    "lane_march",
    "lane_walk",
    "lane_zero",
    "lanes",
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
    "together",
    "verdict",
    "walk",
]
