"""Make the wheel with the machine code of all kernels, for two classes of x86-64 processors: `make wheel`.

The wheel is for Linux and any Python, because the machine code calls the C library alone. It does so through the names
of C_LIBRARY; another name ends this script. The platform tag names the oldest glibc that has them all.
"""

import platform
import re
import shutil
import subprocess
import sys
from ctypes import CDLL
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

from elftools.elf.elffile import ELFFile
from elftools.elf.gnuversions import GNUVerSymSection

from rocking.kernels import build_processes, machine_code
from rocking.kernels.deferred import import_all
from rocking.kernels.entry_point import ENTRY_POINTS

ROOT = Path(__file__).parents[1]
C_LIBRARY = {
    "acos",
    "atan",
    "atan2",
    "atanh",
    "cos",
    "expm1",
    "exp",
    "fmod",
    "hypot",
    "log",
    "log10",
    "log2",
    "memset",
    "sin",
    "sincos",
    "sinh",
    "tan",
    "tanh",
}
# The first version that a platform tag may name (PEP 600).
OLDEST = 2, 5
SHARED = "libm.so.6", "libc.so.6"


def imports_of(code: bytes) -> set[str]:
    """Return the names that an object file takes from elsewhere."""
    symbols = ELFFile(BytesIO(code)).get_section_by_name(".symtab").iter_symbols()
    return {symbol.name for symbol in symbols if symbol["st_shndx"] == "SHN_UNDEF" and symbol.name}


def exports_of(code: bytes) -> set[str]:
    """Return the names that an object file gives to others."""
    symbols = ELFFile(BytesIO(code)).get_section_by_name(".symtab").iter_symbols()
    visible = (symbol for symbol in symbols if symbol["st_info"]["bind"] != "STB_LOCAL")
    return {symbol.name for symbol in visible if symbol["st_shndx"] != "SHN_UNDEF"}


def first_versions() -> dict[str, tuple[int, ...]]:
    """Return the first version of glibc that has each name of the C library of this machine."""
    for name in SHARED:
        CDLL(name)
    loaded = {line.split()[-1] for line in Path("/proc/self/maps").read_text().splitlines()}
    found: dict[str, tuple[int, ...]] = {}
    for path in loaded:
        if Path(path).name in SHARED:
            with Path(path).open("rb") as stream:
                library = ELFFile(stream)
                defined = library.get_section_by_name(".gnu.version_d")
                texts = {version["vd_ndx"]: next(names).name for version, names in defined.iter_versions()}
                numbers = next(each for each in library.iter_sections() if isinstance(each, GNUVerSymSection))
                symbols = library.get_section_by_name(".dynsym").iter_symbols()
                for symbol, number in zip(symbols, numbers.iter_symbols(), strict=True):
                    index = number["ndx"]
                    text = texts.get(index & 0x7FFF if isinstance(index, int) else index, "")
                    if match := re.fullmatch(r"GLIBC_([\d.]+)", text):
                        version = tuple(map(int, match[1].split(".")))
                        found[symbol.name] = min(found.get(symbol.name, version), version)
    return found


def platform_tag(names: set[str]) -> str:
    """Return the platform tag of machine code that takes some names from the C library."""
    first = first_versions()
    major, minor = max([OLDEST, *(first[name][:2] for name in names)])
    return f"manylinux_{major}_{minor}_x86_64"


def run(*command: object) -> None:
    """Run a Python module."""
    subprocess.run([sys.executable, "-m", *map(str, command)], check=True, stdout=subprocess.DEVNULL)


def compile_library(library: Path) -> set[str]:
    """Compile all entry points for each class of processors; return the names that they take from the C library."""
    import_all()
    names = set()
    for processors in machine_code.CLASSES:
        with TemporaryDirectory() as folder:
            build_processes.build_all(ENTRY_POINTS, Path(folder), processors)
            target = library / f"{machine_code.hash_sources()}-{processors}"
            target.mkdir(parents=True)
            for name in ENTRY_POINTS:
                file = Path(folder, f"{name}.o")
                taken = imports_of(file.read_bytes()[machine_code.DIGEST_BYTES :])
                if not taken <= C_LIBRARY:
                    sys.exit(
                        f"{name} needs {', '.join(sorted(taken - C_LIBRARY))}, which C_LIBRARY does not list"
                    )
                names |= taken
                shutil.copy(file, target)
    return names


def main() -> None:
    """Make the wheel in the folder that the command line names, `dist` by default."""
    if (sys.platform, platform.machine()) != ("linux", "x86_64"):
        sys.exit("the machine code is for Linux on x86-64, and can be made there only")
    target = Path(sys.argv[1] if len(sys.argv) > 1 else "dist").absolute()
    target.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as scratch:
        source = Path(scratch, "source")  # a copy, because a build leaves files that the next one would pack
        shutil.copytree(
            ROOT / "src", source / "src", ignore=shutil.ignore_patterns("*.egg-info", "__pycache__")
        )
        for name in ("pyproject.toml", "README.md", "LICENSE"):
            shutil.copy(ROOT / name, source)
        run("pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", scratch, source)
        (plain,) = Path(scratch).glob("*.whl")
        run("wheel", "unpack", "--dest", scratch, plain)
        (whole,) = Path(scratch).glob("rocking-*/")
        names = compile_library(whole / "rocking/kernels/library")
        (metadata,) = whole.glob("*.dist-info/WHEEL")
        text = metadata.read_text()
        for old, new in (
            ("Root-Is-Purelib: true\n", "Root-Is-Purelib: false\n"),
            ("Tag: py3-none-any\n", f"Tag: py3-none-{platform_tag(names)}\n"),
        ):
            if text.count(old) != 1:
                sys.exit(f"the metadata of the wheel lack {old!r}: {text}")
            text = text.replace(old, new)
        metadata.write_text(text)
        made = Path(scratch, "made")
        made.mkdir()
        run("wheel", "pack", "--dest-dir", made, whole)
        (wheel,) = made.iterdir()
        print("wrote", shutil.move(wheel, target / wheel.name))


if __name__ == "__main__":
    main()
