"""Compile all entry points and link them into the libraries of the package.

The groups of entry points are lowered, and their modules optimised, by processes beside each other. The objects are linked in a
temporary folder, and the library gets its name last. So an interrupted build leaves no half library. A checkout keeps its
last libraries under the hashes of their sources: a change back to older sources needs no compilation.
"""

import argparse
import ctypes
import importlib.metadata
import importlib.util
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from rocking.kernels.library.load import (
    CHECKOUT,
    FOLDER,
    hash_sources,
    hash_texts,
    is_checkout,
    is_current,
    open_library,
    path_of,
)
from rocking.kernels.library.processor import COMPILER, classes_here, classes_of_machine, reason_against

GROUPS = ("slender", "full", "unsymmetric", "restrained")
SAFE = ("noexecstack", "relro", "defs")
SHARED = ("libm.so.6", "libc.so.6")
KEPT = CHECKOUT / "build" / "kernels"
MOST_KEPT = 8


def check_compiler() -> None:
    """End the process in one sentence if the kernels cannot be compiled here."""
    if reason := reason_against():
        sys.exit(reason)
    for name, version in COMPILER.items():
        found = version_of(name)
        if found != version:
            sys.exit(
                f"{name} must have the version {version}; got {found}: run pip install '.[kernels]' in the checkout"
            )
    linker()
    system_libraries()


def version_of(name: str) -> str:
    """Return the version of an installed package."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "none"


def environment() -> dict[str, str]:
    """Return the environment of a process that compiles: no settings of numba from outside."""
    own = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}
    paths = str(Path(__file__).parents[3]), own.get("PYTHONPATH", "")
    return own | {"PYTHONPATH": os.pathsep.join(filter(None, paths))}


def linker() -> list[str]:
    """Return the command of the linker: the C compiler, else LLD of the package ziglang."""
    for name in ("cc", "gcc", "clang"):
        if path := shutil.which(name):
            return [path, "-shared", "-nostdlib", *(f"-Wl,-z,{each}" for each in SAFE)]
    if importlib.util.find_spec("ziglang"):
        return [sys.executable, "-m", "ziglang", "ld.lld", "-shared", *(f"-z{each}" for each in SAFE)]
    sys.exit("no linker was found: install a C compiler, or the package ziglang")


def system_libraries() -> list[str]:
    """Return the files of libm and libc that this process uses."""
    for name in SHARED:
        ctypes.CDLL(name)
    loaded = {line.split()[-1] for line in Path("/proc/self/maps").read_text().splitlines() if ".so" in line}
    # Before its version 2.34, glibc gives its files names such as libm-2.31.so.
    found = [
        path for path in sorted(loaded) if re.fullmatch(r"lib[mc](\.so\.6|-[\d.]+\.so)", Path(path).name)
    ]
    if len(found) < len(SHARED):
        sys.exit(f"the files of {' and '.join(SHARED)} were not found among the libraries of this process")
    return found


def link(objects: list[Path], target: Path) -> None:
    """Link object files into a library."""
    command = [*linker(), "-o", str(target), *map(str, objects), *system_libraries()]
    if subprocess.run(command, check=False).returncode:
        sys.exit("the kernels were compiled but not linked: see the message of the linker above")


def place(made: Path, target: Path) -> None:
    """Copy a library to its place, which it gets by a rename."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix=".", dir=target.parent) as folder:
        Path(shutil.copy(made, folder)).replace(target)


class Compilers:
    """Processes that compile, as many at a time as there are processors."""

    def __init__(self, folder: Path, output: int | None = None) -> None:
        self.folder, self.output = folder, output
        self.working: list[subprocess.Popen[bytes]] = []

    def run(self, module: str, *arguments: str) -> None:
        """Run a module of this package to its end.

        CalledProcessError: if it fails.
        """
        command = [sys.executable, "-P", "-m", f"rocking.kernels.library.{module}", *arguments]
        # In a folder of its own numba finds no file of settings. The end of this process, not Ctrl-C, ends the others.
        process = subprocess.Popen(
            command, cwd=self.folder, env=environment(), stdout=self.output, start_new_session=True
        )
        self.working.append(process)
        if code := process.wait():
            raise subprocess.CalledProcessError(code, command)

    def lower(self, group: str) -> list[str]:
        """Lower a group of entry points, or one; return the files of its modules."""
        self.run("lower", group, str(self.folder))
        return sorted(map(str, self.folder.glob(f"{group}-*.bc")))

    def compile(self, groups: Iterable[str], processors: list[str]) -> None:
        """Compile groups into object files. Each module is optimised as soon as its group is lowered."""
        with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
            try:
                lowered = [pool.submit(self.lower, group) for group in groups]
                emitted = [pool.submit(self.run, "emit", str(self.folder / "marks.bc"), *processors)]
                for done in as_completed(lowered):
                    emitted += [pool.submit(self.run, "emit", file, *processors) for file in done.result()]
                for done in as_completed(emitted):
                    done.result()
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                for process in self.working:
                    process.kill()
                raise


@contextmanager
def seconds_shown(begun: float) -> Iterator[None]:
    """Print every three seconds how long the build has taken."""
    ended = threading.Event()

    def show() -> None:
        while not ended.wait(3.0):
            print(f"compiling the kernels: {time.perf_counter() - begun:.0f} s", flush=True)

    shown = threading.Thread(target=show, daemon=True)
    shown.start()
    try:
        yield
    finally:
        ended.set()
        shown.join()


def build(processors: list[str], target: Path) -> None:
    """Build the libraries of some classes of processors into a folder."""
    begun, sources = time.perf_counter(), hash_texts()
    target.mkdir(parents=True, exist_ok=True)
    print(f"compiling the kernels for {', '.join(processors)}: some minutes ...", flush=True)
    with TemporaryDirectory(prefix="rocking-") as folder, seconds_shown(begun):
        try:
            Compilers(Path(folder)).compile(GROUPS, processors)
        except subprocess.CalledProcessError:
            sys.exit("the kernels were not compiled: see the message above; the same command tries again")
        if hash_texts.__wrapped__() != sources:
            sys.exit("the kernels were edited while they were compiled; run the same command again")
        for processor in processors:
            made = Path(folder, path_of(processor).name)
            link(sorted(Path(folder).glob(f"*-{processor}.o")), made)
            place(made, target / made.name)
            keep(made, processor)
    print(f"compiled the kernels in {time.perf_counter() - begun:.0f} s", flush=True)


def kept_path(processor: str) -> Path:
    """Return the path under which the library of the present sources is kept in the checkout."""
    return KEPT / hash_sources() / path_of(processor).name


def keep(made: Path, processor: str) -> None:
    """Keep a library in the checkout, and remove all but the newest."""
    if is_checkout() and is_private(KEPT):
        place(made, kept_path(processor))
        for old in sorted(KEPT.iterdir(), key=lambda folder: folder.stat().st_mtime)[:-MOST_KEPT]:
            shutil.rmtree(old)


def is_private(folder: Path) -> bool:
    """Return whether a folder of libraries, if there is one, is of this user, and nobody else may write to it."""
    try:
        status = folder.stat()
    except OSError:
        return True
    private = status.st_uid == os.geteuid() and not status.st_mode & 0o022
    if not private:
        print(f"{folder} is not used: it belongs to another user, or others may write to it", flush=True)
    return private


def is_built(path: Path) -> bool:
    """Return whether there is a library of the present sources at a path."""
    try:
        return path.exists() and is_current(open_library(path))
    except (ImportError, OSError):
        return False


def has_kept(processor: str, target: Path) -> bool:
    """Copy the library of the present sources to its place, if one is kept; return whether it was."""
    kept = kept_path(processor)
    found = (
        is_checkout() and kept.exists() and is_private(KEPT) and is_private(kept.parent) and is_built(kept)
    )
    if found:
        place(kept, target / kept.name)
    return found


def main() -> None:
    """Build the libraries that are missing or made of other sources: of the classes named, else of this processor's.

    With ``--into FOLDER`` they are built into another folder.
    """
    parser = argparse.ArgumentParser("python -m rocking.kernels", description=main.__doc__.partition("\n")[0])
    parser.add_argument("classes", nargs="*", metavar="CLASS", help=", ".join(classes_of_machine()))
    parser.add_argument("--into", type=Path, metavar="FOLDER", default=FOLDER)
    given = parser.parse_args()
    os.umask(0o022)  # others may read a library, and nobody else may write to it
    processors = given.classes or list(classes_here()[:1])
    if unknown := [each for each in processors if each not in classes_of_machine()]:
        parser.error(f"CLASS must be one of {', '.join(classes_of_machine())}; got {', '.join(unknown)}")
    missing = [each for each in processors if not is_built(given.into / path_of(each).name)]
    missing = [each for each in missing if not has_kept(each, given.into)]
    if not missing and processors:
        return
    check_compiler()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        build(missing, given.into)
    except KeyboardInterrupt:
        sys.exit("the kernels were not compiled: interrupted; the same command tries again")
    except OSError as error:
        sys.exit(f"the kernels were not compiled: {error}; the same command tries again")


if __name__ == "__main__":
    main()
