"""Opens the library for this processor, after a check that it belongs to this package."""

import ast
import ctypes
import hashlib
import os
from collections.abc import Callable
from functools import cache
from pathlib import Path

from rocking.kernels.library.processor import classes_here, processor_class

KERNELS = Path(__file__).parents[1]
# Not a package: modules for Python may have the same ending.
FOLDER = KERNELS / "compiled"
CHECKOUT = KERNELS.parents[2]
COMMAND = "python -m rocking.kernels"
INSTALL = "pip install --force-reinstall --no-deps . in a copy of the repository"
# Symbols of the library: hashes of the sources, as text.
SOURCES, TEXTS = "rocking_sources", "rocking_texts"
HASH_DIGITS = 16


class KernelsUnusable(ImportError):
    """The compiled kernels are missing or cannot be used. The message is one sentence with the remedy."""


def is_checkout() -> bool:
    """Return whether the package lies in a checkout of its sources, which may be edited."""
    return KERNELS.parents[1].name == "src" and (CHECKOUT / "pyproject.toml").exists()


def remedy() -> str:
    """Return what makes the library again."""
    return f"run {COMMAND if is_checkout() else INSTALL}"


def source_files() -> list[Path]:
    """Return the files of all kernels, and of what compiles them."""
    return sorted(KERNELS.rglob("*.py"))


@cache
def hash_texts() -> str:
    """Hash the files of the kernels as they are."""
    return _hashed([path.read_bytes() for path in source_files()])


@cache
def hash_sources() -> str:
    """Hash the sources of the kernels without comments, docstrings and layout: what the compiler sees."""
    return _hashed(
        [ast.dump(_without_docstrings(ast.parse(path.read_bytes()))).encode() for path in source_files()]
    )


def _hashed(contents: list[bytes]) -> str:
    digest = hashlib.sha256()
    for path, content in zip(source_files(), contents, strict=True):
        digest.update(path.relative_to(KERNELS).as_posix().encode() + b"\0" + content + b"\0")
    return digest.hexdigest()[:HASH_DIGITS]


def _without_docstrings(tree: ast.Module) -> ast.Module:
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if (
            isinstance(body, list)
            and body
            and isinstance(body[0], ast.Expr)
            and isinstance(body[0].value, ast.Constant)
        ):
            del body[0]
    return tree


def path_of(processor: str) -> Path:
    """Return the path of the library for a class of processors."""
    return FOLDER / f"kernels-{processor}.so"


def text_in(opened: ctypes.CDLL, symbol: str) -> str:
    """Return a hash in a library; empty if it has none."""
    try:
        return (ctypes.c_char * HASH_DIGITS).in_dll(opened, symbol).raw.decode()
    except ValueError:
        return ""


def is_current(opened: ctypes.CDLL) -> bool:
    """Return whether a library was made from the sources of the kernels beside it."""
    return text_in(opened, TEXTS) == hash_texts() or text_in(opened, SOURCES) == hash_sources()


def open_library(path: Path) -> ctypes.CDLL:
    """Open a library, after a check of its owner; its code is run.

    KernelsUnusable: if it belongs to a user who is neither this one, nor root, nor the owner of the package, or cannot be opened.
    """
    if path.stat().st_uid not in (os.geteuid(), 0, Path(__file__).stat().st_uid):
        raise KernelsUnusable(f"{path} belongs to another user than the package; remove it, then {remedy()}")
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        if os.statvfs(path).f_flag & os.ST_NOEXEC:
            problem = f"{path} lies on a file system without exec; install the package elsewhere"
        elif "failed to map segment" in str(error):
            raise  # too little memory
        else:
            problem = f"{path} cannot be opened: {error}; remove it, then {remedy()}"
    raise KernelsUnusable(problem)


def best_path() -> Path | None:
    """Return the path of the best library for this processor, or None."""
    return next((path for path in map(path_of, classes_here()) if path.exists()), None)


def library_class() -> str:
    """Return the class of processors of the library that is used, or of this processor if there is none."""
    path = best_path()
    return path.stem.removeprefix("kernels-") if path else processor_class()


@cache
def _library() -> ctypes.CDLL:
    if not KERNELS.is_dir():
        raise KernelsUnusable(
            f"{KERNELS} lies in an archive, from which no library can be opened; install the package as files"
        )
    path = best_path()
    if path is None:
        raise KernelsUnusable(
            f"the compiled kernels are missing in {FOLDER} for this processor, {processor_class()}; {remedy()}"
        )
    opened = open_library(path)
    if is_checkout() and not is_current(opened):
        raise changed()
    return opened


def changed() -> KernelsUnusable:
    """Return the error of a library whose sources were others."""
    return KernelsUnusable(f"the sources of the kernels changed after they were compiled; run {COMMAND}")


def function_of(symbol: str) -> Callable[[int], None]:
    """Return the compiled function of an entry point, which takes the address of a row of words.

    KernelsUnusable: if there is no library for this processor, or only one of other sources.
    """
    opened = _library()
    if not hasattr(opened, symbol):
        raise changed()
    function = getattr(opened, symbol)
    function.argtypes, function.restype = (ctypes.c_int64,), None
    return function
