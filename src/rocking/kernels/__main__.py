"""``python -m rocking.kernels``: compile all that is missing for this processor. ``--background`` does not wait."""

import sys

from rocking.kernels import build_processes, machine_code
from rocking.kernels.deferred import import_all
from rocking.kernels.entry_point import ENTRY_POINTS


def main() -> None:
    """Start the builders, and wait for them unless the command line says ``--background``."""
    folder, processors, waits = (
        machine_code.find_folder(),
        machine_code.processor_class(),
        sys.argv[1:] != ["--background"],
    )
    import_all()
    if all(map(machine_code.is_stored, ENTRY_POINTS)):
        return
    if folder is None:
        sys.exit("no cache folder is writable: set NUMBA_CACHE_DIR to one that is" if waits else 0)
    if waits:
        build_processes.build_all(ENTRY_POINTS, folder, processors)
    else:
        build_processes.start_builders(folder, processors)


if __name__ == "__main__":
    main()
