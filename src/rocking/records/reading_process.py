"""Reading of a record file in a process of its own, which a limit of time or of memory ends.

A thread cannot be ended, and a long search in a text stops all other threads.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from contextlib import suppress
from typing import Any

from rocking.model import GroundMotion
from rocking.records.channel import RecordError
from rocking.records.read import read_with_doubts

MAX_MEMORY = 4 << 30
"""Largest address space of the process in bytes, where the operating system has such a limit."""


def read_apart(data: bytes, seconds: float, **given: Any) -> list[tuple[GroundMotion, list[str]]]:
    """Read all channels of a file in memory as `read_with_doubts` does; `RecordError` if it takes longer than `seconds`."""
    # The same modules as here, and one thread: each thread of OpenBLAS takes address space.
    same = {"PYTHONPATH": os.pathsep.join(sys.path), "OPENBLAS_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-c", f"from {__name__} import answer; answer()"],
            input=pickle.dumps((data, given, MAX_MEMORY)),
            capture_output=True,
            timeout=seconds,
            env=os.environ | same,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise RecordError(f"reading takes longer than {seconds:g} s: give a shorter file") from None
    if done.returncode:
        raise RuntimeError(done.stderr.decode(errors="replace"))
    found: list[tuple[GroundMotion, list[str]]] | Exception = pickle.loads(done.stdout)
    if isinstance(found, Exception):
        raise found
    return found


def answer() -> None:
    """Read the file that comes on stdin, and write its channels, or the error, on stdout."""
    data, given, memory = pickle.load(sys.stdin.buffer)
    with suppress(ImportError, ValueError, OSError):  # no such limit on Windows; a lower one stays
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    found: list[tuple[GroundMotion, list[str]]] | Exception
    try:
        found = read_with_doubts(data, **given)
    except MemoryError:
        found = RecordError(f"reading takes more than {memory >> 20:,} MB of memory: give a shorter file")
    except (ValueError, TypeError) as error:
        found = error
    sys.stdout.buffer.write(pickle.dumps(found))
