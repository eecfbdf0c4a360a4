"""Builder: the process that compiles, ``python -m rocking.kernels.builder folder FOLDER`` or ``... entry NAME``."""

import os
import sys
import time
from pathlib import Path

from rocking.kernels.build_processes import BUILDER_SOURCES, INTERVAL, hold_lock, lock_paths
from rocking.kernels.machine_code import hash_sources

# Trials to get a lock, because a process that looks whether a builder runs holds its lock for an instant.
TRIALS = 3


def main() -> None:
    """Compile what is missing in a folder, unless enough builders do, or write the object file of an entry point to stdout."""
    what, target = sys.argv[1:]
    if os.environ.get(BUILDER_SOURCES, hash_sources()) != hash_sources():
        sys.exit("the sources have changed since the process started that asks for machine code")
    if what == "entry":
        from rocking.kernels.compile_missing import compile_one

        sys.stdout.buffer.write(compile_one(target))
        return
    for _ in range(TRIALS):
        for path in lock_paths(Path(target)):
            with hold_lock(path) as free:
                if free:
                    # The process that started this one waits no longer. The lock stays with the child.
                    if os.fork():
                        os._exit(0)
                    from rocking.kernels.compile_missing import compile_missing

                    compile_missing(Path(target))
                    return
        time.sleep(INTERVAL)


if __name__ == "__main__":
    main()
