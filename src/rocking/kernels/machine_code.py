"""Machine code of entry points: where it is kept, for which processors, and how it is loaded.

An entry point has one object file for each class of processors. The files lie in a folder named by a hash over all kernel
sources, so that no file of other sources is ever loaded.
"""

import hashlib
import os
import platform
import tempfile
import threading
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

import llvmlite
import llvmlite.binding as llvm

SOURCES = Path(__file__).parent
# Instructions that a class of x86-64 processors has, by the names of LLVM, best class first.
V3 = "avx,avx2,bmi,bmi2,cx16,f16c,fma,lzcnt,mmx,movbe,popcnt,sahf,sse,sse2,sse3,sse4.1,sse4.2,ssse3,xsave"
CLASSES = {"x86-64-v4": f"{V3},avx512bw,avx512cd,avx512dq,avx512f,avx512vl", "x86-64-v3": V3}
DIGEST_BYTES = 32
# Environment variable; unless it is empty, machine code within the package is not used.
FORCE_JIT = "ROCKING_FORCE_JIT"
# Entry points whose object files this process has found whole.
STORED: set[str] = set()


@cache
def hash_sources() -> str:
    """Hash all kernel sources, with their places in the package."""
    digest = hashlib.sha256()
    for source in sorted(SOURCES.rglob("*.py")):
        digest.update(source.relative_to(SOURCES).as_posix().encode() + source.read_bytes())
    return digest.hexdigest()[:16]


@cache
def processor_class() -> str:
    """Return the best class of processors that this one belongs to; "native" if to none."""
    features = {name for name, present in llvm.get_host_cpu_features().items() if present}
    if platform.machine() != "x86_64":
        return "native"
    return next((name for name, needed in CLASSES.items() if set(needed.split(",")) <= features), "native")


def library() -> Path:
    """Return the folder of machine code within the package; only wheels have one."""
    return SOURCES / "library" / f"{hash_sources()}-{processor_class()}"


def folder_name() -> str:
    """Return the name of the folder of what is compiled here: for these sources, this class of processors, this LLVM.

    Processors of no class share a folder only if they have the same instructions.
    """
    own = ""
    if processor_class() == "native":
        features = llvm.get_host_cpu_features().flatten()
        own = f"-{llvm.get_host_cpu_name()}-{hashlib.sha256(features.encode()).hexdigest()[:8]}"
    return f"kernels-{hash_sources()}-{processor_class()}{own}-{llvmlite.__version__}"


def temporary_home() -> Path:
    """Make the user's folder among the temporary ones. PermissionError: if another user could write there."""
    user = os.getuid() if hasattr(os, "getuid") else None
    home = Path(tempfile.gettempdir(), f"cache-{user}")
    home.mkdir(exist_ok=True, mode=0o700)
    status = home.lstat()
    if user is not None and (status.st_uid != user or status.st_mode & 0o022 or home.is_symlink()):
        raise PermissionError(f"{home} belongs to another user, or others can write there")
    return home


@cache
def find_folder() -> Path | None:
    """Make the folder in ``NUMBA_CACHE_DIR``, the user's cache, or a temporary folder of the user.

    None if none of them is writable, or if there are no sources to tell versions apart: then each process compiles what
    it needs.
    """
    homes = (
        lambda: os.environ.get("NUMBA_CACHE_DIR") or os.devnull,
        lambda: os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser(),
        temporary_home,
    )
    for home in homes if any(SOURCES.rglob("*.py")) else ():
        try:
            folder = Path(home(), "rocking", folder_name())
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            with tempfile.TemporaryFile(dir=folder):
                return folder
        except (OSError, RuntimeError):  # RuntimeError: a user without a home
            continue
    return None


def paths_of(name: str) -> Iterator[Path]:
    """Yield where the object file of an entry point may be: within the package, then in the folder."""
    if not os.environ.get(FORCE_JIT):
        yield library() / f"{name}.o"
    if folder := find_folder():
        yield folder / f"{name}.o"


def is_stored(name: str) -> bool:
    """Return whether there is an object file of an entry point that is not damaged."""
    return name in STORED or read(name) is not None


def read(name: str) -> bytes | None:
    """Read the object file of an entry point; None if it is missing or damaged.

    A damaged file in the folder is removed, so that it is compiled again.
    """
    for path in paths_of(name):
        try:
            stored = path.read_bytes()
        except OSError:
            continue
        if hashlib.sha256(stored[DIGEST_BYTES:]).digest() == stored[:DIGEST_BYTES]:
            STORED.add(name)
            return stored[DIGEST_BYTES:]
        if path.parent == find_folder():
            with suppress(OSError):
                path.unlink()
    return None


def write(name: str, code: bytes, folder: Path) -> None:
    """Write an object file by rename, after its hash. The caller holds a lock."""
    part = folder / f"{name}.part"
    try:
        with part.open("wb") as file:
            file.write(hashlib.sha256(code).digest() + code)
            file.flush()
            os.fsync(file.fileno())
        part.replace(folder / f"{name}.o")
    finally:
        part.unlink(missing_ok=True)


class Loader:
    """Machine code in memory: one engine for the process."""

    def __init__(self) -> None:
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        machine = llvm.Target.from_default_triple().create_target_machine()
        self._engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)
        self._lock = threading.Lock()

    def load(self, code: bytes, symbol: str) -> int:
        """Load an object file, and return the address of a function in it."""
        with self._lock:
            self._engine.add_object_file(llvm.ObjectFileRef.from_data(code))
            self._engine.finalize_object()
            return self._engine.get_function_address(symbol)


@cache
def loader() -> Loader:
    """Return the loader of the process."""
    return Loader()


def symbol_of(name: str) -> str:
    """Return the name of the function of an entry point in its object file."""
    return "rocking_" + name.replace(".", "_")
