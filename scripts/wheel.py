"""Make the wheel with the compiled kernels for all classes of x86-64 processors: `make wheel`.

It is for Linux and any Python, because the kernels call the C library alone. The platform tag names the newest version of glibc
that one of their functions needs.
"""

import platform
import re
import shutil
import subprocess
import sys
import zipfile
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

from elftools.elf.elffile import ELFFile

from rocking.kernels.library.processor import CLASSES

ROOT = Path(__file__).parents[1]
OLDEST = (2, 5)
"""Oldest version of glibc of a platform tag for x86-64, PEP 600."""


def glibc_of(library: bytes) -> tuple[int, ...]:
    """Return the version of glibc that a library needs."""
    section = ELFFile(BytesIO(library)).get_section_by_name(".gnu.version_r")
    names = [each.name for _, versions in section.iter_versions() for each in versions]
    return max(tuple(map(int, re.findall(r"\d+", name)))[:2] for name in names)


def platform_tag(wheel: Path) -> str:
    """Return the platform tag for the libraries in a wheel. pip knows none for an older glibc than OLDEST."""
    with zipfile.ZipFile(wheel) as archive:
        libraries = [archive.read(name) for name in archive.namelist() if name.endswith(".so")]
    major, minor = max(OLDEST, *map(glibc_of, libraries))
    return f"manylinux_{major}_{minor}_x86_64"


def run(*command: object) -> None:
    """Run a Python module."""
    subprocess.run([sys.executable, "-m", *map(str, command)], check=True, stdout=subprocess.DEVNULL)


def main() -> None:
    """Make the wheel in the folder that the command line names, `dist` by default."""
    if (sys.platform, platform.machine()) != ("linux", "x86_64"):
        sys.exit("the wheel is for Linux on x86-64, and can be made there only")
    target = Path(sys.argv[1] if len(sys.argv) > 1 else "dist").absolute()
    target.mkdir(parents=True, exist_ok=True)
    classes = ",".join(name for name in CLASSES if name.startswith("x86-64"))
    options = "--quiet", "--no-deps", "--no-build-isolation", "--config-settings", f"classes={classes}"
    with TemporaryDirectory() as scratch:
        run("pip", "wheel", *options, "--wheel-dir", scratch, ROOT)
        (plain,) = Path(scratch).iterdir()
        run("wheel", "tags", "--remove", "--platform-tag", platform_tag(plain), plain)
        (wheel,) = Path(scratch).iterdir()
        print("wrote", shutil.move(wheel, target / wheel.name))


if __name__ == "__main__":
    main()
