"""Work of a builder: it compiles entry points, those first that a process waits for.

A builder that is killed leaves no file that is trusted later.
"""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FunctionType

from numba.core import event
from numba.core.dispatcher import Dispatcher

from rocking.kernels import machine_code
from rocking.kernels.build_processes import SECONDS, hold_lock
from rocking.kernels.deferred import CONTRACTS, bind_compiled, import_all
from rocking.kernels.entry_point import ENTRY_POINTS, EntryPoint

# Share of the time of an entry point that its last step takes, after the compilation of all that it calls. Measured: 6 to 24 %.
LAST_STEP = 0.15


def next_name(folder: Path, names: list[str]) -> str | None:
    """Return the entry point to be compiled next: a wanted one, the longest wanted first, or the first that is left."""
    left = [name for name in names if not (folder / f"{name}.o").exists()]
    wanted = []
    for name in left:
        try:
            wanted.append(((folder / f"{name}.wanted").stat().st_mtime_ns, name))
        except OSError:
            continue
    return min(wanted)[1] if wanted else left[0] if left else None


def kernels_below(entry: EntryPoint) -> set[Dispatcher]:
    """Return the kernels that an entry point calls, and all that they call."""
    found: set[Dispatcher] = set()
    left = [entry.function]
    while left:
        function = left.pop()
        for name in function.__code__.co_names:
            kernel = function.__globals__.get(name)
            if isinstance(kernel, FunctionType) and kernel in CONTRACTS:
                bodies = CONTRACTS[kernel].bodies
                kernel = bodies.get(entry.kind, next(iter(bodies.values()))).compiled
            if isinstance(kernel, Dispatcher) and kernel not in found:
                found.add(kernel)
                left.append(kernel.py_func)
    return found


@contextmanager
def noting_progress(entry: EntryPoint, path: Path) -> Iterator[None]:
    """Write the fraction of the work that is done into a file, as the compiler goes on."""
    below = [kernel for kernel in kernels_below(entry) if not kernel.overloads]
    part = path.with_suffix(".noted")  # ".part" is that of the object file

    class Listener(event.Listener):
        def on_start(self, _: event.Event) -> None:
            pass

        def on_end(self, _: event.Event) -> None:
            done = sum(bool(kernel.overloads) for kernel in below) / max(len(below), 1)
            part.write_text(f"{(1.0 - LAST_STEP) * done:.3f}")
            part.replace(path)

    try:
        with event.install_listener("numba:compile", Listener()):
            yield
    finally:
        path.unlink(missing_ok=True)


def compile_one(name: str) -> bytes:
    """Return the object file of an entry point."""
    import_all()
    return ENTRY_POINTS[name].compile()


def compile_into(folder: Path, name: str) -> None:
    """Compile an entry point into a folder. If that fails, write the reason there and withdraw the request for it."""
    error = folder / f"{name}.error"
    error.unlink(missing_ok=True)
    try:
        with noting_progress(ENTRY_POINTS[name], folder / f"{name}.progress"):
            machine_code.write(name, ENTRY_POINTS[name].compile(), folder)
    except Exception:  # noqa: BLE001 (the other entry points can still be compiled)
        with suppress(OSError):
            (folder / f"{name}.wanted").unlink(missing_ok=True)
            error.write_text(traceback.format_exc())


def place_of(name: str) -> float:
    """Return the place of an entry point in the order: that of SECONDS, or just after the first of its kind of parameters.

    Without such a kind it comes after the first of all. What a kind needs is compiled with the first of the kind.
    """
    long = list(SECONDS)
    if name in long:
        return long.index(name)
    kind = name.rpartition(".")[2]
    return 0.5 + next((place for place, other in enumerate(long) if other.endswith(f".{kind}")), 0)


def compile_missing(folder: Path) -> None:
    """Compile all entry points that have no machine code, as long as there are any that no other builder compiles.

    Those of the slender block come first.
    """
    import_all()
    bind_compiled()
    names = sorted(ENTRY_POINTS, key=place_of)
    while (name := next_name(folder, names)) is not None:
        names.remove(name)
        with hold_lock(folder / f"{name}.lock") as free:
            if free and not (folder / f"{name}.o").exists():  # else another builder compiles it
                compile_into(folder, name)
