"""Classes of processors, and the versions of the compiler that makes code for them."""

import platform
import sys
from functools import cache
from pathlib import Path

# The last digits of results depend on these versions. They are a part of the sources, so that with others the kernels are compiled again.
COMPILER = {"llvmlite": "0.50.0", "numba": "0.68.1"}
# The newest that this numba knows.
NEWEST_PYTHON = (3, 14)
V3 = "avx,avx2,bmi,bmi2,cx16,f16c,fma,lzcnt,mmx,movbe,popcnt,sahf,sse,sse2,sse3,sse4.1,sse4.2,ssse3,xsave"
# Instructions of each class, by the names of LLVM, best class first. The last of each kind of machine needs none.
CLASSES = {
    "x86-64-v4": f"{V3},avx512bw,avx512cd,avx512dq,avx512f,avx512vl",
    "x86-64-v3": V3,
    "x86-64": "",
    "aarch64": "",
}
MACHINES = {"AMD64": "x86-64", "x86_64": "x86-64", "arm64": "aarch64", "aarch64": "aarch64"}
# Names in /proc/cpuinfo that differ from those of LLVM.
LINUX = {
    "bmi": "bmi1",
    "lzcnt": "abm",
    "sahf": "lahf_lm",
    "sse3": "pni",
    "sse4.1": "sse4_1",
    "sse4.2": "sse4_2",
}


def instructions() -> set[str]:
    """Return the names of the instructions that Linux lists for the first core."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return set()
    listed = (
        line.partition(":")[2] for line in lines if line.partition(":")[0].strip() in ("flags", "Features")
    )
    return set(next(listed, "").split())


def classes_of_machine() -> list[str]:
    """Return the classes of processors of this kind of machine, best first; none on a machine of another kind."""
    base = MACHINES.get(platform.machine())
    return [name for name in CLASSES if base and name.startswith(base)]


@cache
def classes_here() -> tuple[str, ...]:
    """Return the classes to which this processor belongs, best first."""
    found = instructions()
    needed = {name: filter(None, CLASSES[name].split(",")) for name in classes_of_machine()}
    return tuple(name for name in needed if {LINUX.get(each, each) for each in needed[name]} <= found)


def reason_against() -> str | None:
    """Return why the kernels cannot be compiled on this machine and with this Python, or None."""
    if sys.platform != "linux" or not classes_of_machine():
        return (
            "the kernels are compiled on Linux only, on x86-64 and on aarch64; other systems are not tested"
        )
    if platform.libc_ver()[0] != "glibc":
        return "the kernels are compiled for the C library glibc only; others, such as musl, are not tested"
    if sys.version_info[:2] > NEWEST_PYTHON:
        return f"the compiler numba does not know Python {platform.python_version()}; use an older one"
    return None


def processor_class() -> str:
    """Return the best class of this processor, or the name of its kind if there is none for it."""
    return next(iter(classes_here()), platform.machine())
