"""The library of a small package with two entry points: built once, checked before it is opened, and right or refused.

The package holds the modules of `rocking.kernels` that build and load, and none of the physics.
"""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rocking import kernels
from rocking.kernels.library import build
from rocking.kernels.library.processor import classes_here, processor_class

SOURCES = Path(kernels.__file__).parent
MODULES = ("__init__", "__main__")
SUM = '''
"""Sums."""

import math
from typing import NamedTuple

from rocking.kernels.library.kernel import kernel
from rocking.kernels.library.export import entry_point
from rocking.kernels.library.signature import Floats1


class One(NamedTuple):
    first: float


class Two(NamedTuple):
    first: float
    second: float


class Problem(NamedTuple):
    times: int
    p: One | Two


@kernel
def weigh(value):
    """Return a weight."""
    return FACTOR * math.sqrt(value)


@entry_point
def total(values: Floats1) -> float:
    result = 0.0
    for k in range(values.shape[0]):
        result += weigh(values[k])
    return result


@entry_point
def add(problem: Problem) -> float:
    result = 0.0
    for value in problem.p:
        result += value
    return problem.times * result
'''
RUN = """
import json, sys
import numpy as np
from rocking.kernels.sums import One, Problem, Two, add, total
print(json.dumps([total(np.array([0.0, 1.0])), add(Problem(3, One(2.0))), add(Problem(3, Two(2.0, 5.0))), "numba" in sys.modules]))
"""
RIGHT = [2.0 * 1.0, 6.0, 21.0, False]
ERROR = "rocking.kernels.library.load.KernelsUnusable"
COMMAND = "run python -m rocking.kernels"


class Package:
    """A checkout of the small package, and processes that use it."""

    def __init__(self, folder):
        self.root, self.kernels = folder, folder / "src/rocking/kernels"
        self.compiled = self.kernels / "compiled"
        self.library = self.compiled / f"kernels-{processor_class()}.so"
        shutil.copytree(
            SOURCES / "library", self.kernels / "library", ignore=shutil.ignore_patterns("__pycache__")
        )
        for name in MODULES:
            shutil.copy(SOURCES / f"{name}.py", self.kernels)
        (self.kernels.parent / "__init__.py").touch()
        (folder / "pyproject.toml").touch()
        self.write(SUM.replace("FACTOR", "2.0"))
        self.environment = os.environ | {"PYTHONPATH": str(folder / "src")}

    def write(self, sums):
        (self.kernels / "sums.py").write_text(sums)

    def start(self, *command, **environment):
        return subprocess.Popen(
            [sys.executable, "-P", *command],
            env=self.environment | environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            umask=0,
        )

    def build(self, *options, **environment):
        """Return the lines of a build."""
        with self.start("-m", "rocking.kernels", *options, **environment) as process:
            return process.communicate(timeout=200)[0].splitlines()

    def run(self, before="", **environment):
        """Return what a program prints: its answers, or the last line of its error."""
        with self.start("-c", before + RUN, **environment) as process:
            last = process.communicate(timeout=100)[0].splitlines()[-1]
        return json.loads(last) if process.returncode == 0 else last


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The package with its library, which no test changes."""
    package = Package(tmp_path_factory.mktemp("built"))
    assert package.build()[-1].startswith("compiled the kernels in ")
    return package


@pytest.fixture
def package(built, tmp_path):
    """A copy of the package with its library."""
    copied = Package(tmp_path)
    shutil.copytree(built.compiled, copied.compiled)
    return copied


def test_nothing_is_compiled_at_run_time_and_nothing_is_written(built, tmp_path):
    """The home and the folder for temporary files stay empty."""
    files = set(built.root.rglob("*"))
    places = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "NUMBA_CACHE_DIR", "TMPDIR"), str(tmp_path))
    assert built.run(**places, PYTHONDONTWRITEBYTECODE="1") == RIGHT
    assert set(built.root.rglob("*")) == files
    assert list(tmp_path.iterdir()) == []
    assert built.build() == []


def test_library_is_for_others_to_read_and_not_to_write(built):
    """The process that builds gives others every right on its files (umask 0)."""
    assert built.library.stat().st_mode & 0o777 == built.compiled.stat().st_mode & 0o777 == 0o755
    assert [path.name for path in built.compiled.iterdir()] == [built.library.name]


def test_edited_kernel_is_refused_until_it_is_compiled_and_a_comment_is_not(package):
    package.write(
        "# a comment\n" + SUM.replace("FACTOR", "2.0").replace("Return a weight", "Return the weight")
    )
    assert package.run() == RIGHT
    package.write(SUM.replace("FACTOR", "3.0"))
    assert package.run() == f"{ERROR}: the sources of the kernels changed after they were compiled; {COMMAND}"
    before = package.root / "before"
    before.hardlink_to(package.library)
    code = before.read_bytes()
    package.build()
    assert before.read_bytes() == code  # replaced as a whole: processes that have opened it go on
    assert package.run()[0] == pytest.approx(1.5 * RIGHT[0], rel=1e-15, abs=0)
    package.write(SUM.replace("FACTOR", "2.0"))
    assert len(package.build()) > 1
    package.write(SUM.replace("FACTOR", "3.0"))
    assert package.build() == []  # kept
    assert package.run()[0] == pytest.approx(1.5 * RIGHT[0], rel=1e-15, abs=0)


def test_installed_package_is_not_compared_with_its_sources(package):
    (package.root / "pyproject.toml").unlink()
    package.write(SUM.replace("FACTOR", "3.0"))
    assert package.run() == RIGHT


@pytest.mark.parametrize("mode", [0o777, 0o720])
def test_kept_libraries_that_others_may_write_are_not_used(package, mode):
    package.library.unlink()
    package.build()
    kept = package.root / "build/kernels"
    (library,) = kept.rglob("*.so")
    library.write_bytes(library.read_bytes() + b"planted")
    package.library.unlink()
    package.build()
    assert package.library.read_bytes().endswith(b"planted")
    kept.chmod(mode)
    package.library.unlink()
    lines = package.build()
    assert f"{kept} is not used: it belongs to another user, or others may write to it" in lines
    assert not package.library.read_bytes().endswith(b"planted")
    assert package.run() == RIGHT


OTHER_USER = """
import os, pathlib
stat = pathlib.Path.stat
pathlib.Path.stat = lambda path, **how: os.stat_result([*stat(path)[:4], 4_000 + (path.suffix == ".so"), *stat(path)[5:10]])
"""
REFUSALS = {
    "no library": (
        lambda package: package.library.unlink(),
        "",
        f"are missing in .* for this processor, .*; {COMMAND}",
    ),
    "no library in an installed package": (
        lambda package: (package.library.unlink(), (package.root / "pyproject.toml").unlink()),
        "",
        "are missing in .* for this processor, .*; run pip install --force-reinstall --no-deps . in a copy of the repository",
    ),
    "other processor": (
        lambda package: package.library.rename(package.compiled / "kernels-x86-64-v9.so"),
        "",
        f"are missing in .* for this processor, .*; {COMMAND}",
    ),
    "no library, but text": (
        lambda package: package.library.write_text("text"),
        "",
        f"cannot be opened: .*; remove it, then {COMMAND}",
    ),
    "other words": (
        lambda package: (package.root / "pyproject.toml").unlink(),
        "from rocking.kernels import sums\nsums.total.signature.__class__.digest = '0'",
        f"the sources of the kernels changed after they were compiled; {COMMAND}",
    ),
    "other user": (
        lambda _: None,
        OTHER_USER,
        f"belongs to another user than the package; remove it, then {COMMAND}",
    ),
    "no ctypes": (lambda _: None, "import sys\nsys.modules['ctypes'] = None", "this Python lacks ctypes, .*"),
}


@pytest.mark.parametrize("case", REFUSALS)
def test_library_that_cannot_be_used_is_refused_in_one_sentence(package, case):
    damage, before, sentence = REFUSALS[case]
    damage(package)
    message = package.run(before)
    assert isinstance(message, str)
    assert re.fullmatch(f"({ERROR}|ImportError): .*{sentence}", message)


def test_package_in_an_archive_is_refused(package, tmp_path):
    archive = shutil.make_archive(str(tmp_path / "packed"), "zip", package.root / "src")
    with package.start("-c", RUN, PYTHONPATH=archive) as process:
        last = process.communicate(timeout=100)[0].splitlines()[-1]
    assert re.fullmatch(f"{ERROR}: .* lies in an archive, .*; install the package as files", last)


BROKEN = """
from rocking.kernels.library.export import entry_point

@entry_point
def a_count(n: int) -> int:
    return n / 2
"""
FAILURES = {
    "kernel": (
        BROKEN,
        "sums.a_count is declared to return int64, and returns float64",
    ),
    "import": ("import no_such_module\n", "No module named 'no_such_module'"),
}


@pytest.mark.parametrize("what", FAILURES)
def test_build_that_fails_says_why_and_leaves_the_library_as_it_was(package, what):
    code, reason = FAILURES[what]
    before = package.library.read_bytes()
    package.write(code)
    lines = package.build()
    assert reason in "\n".join(lines)
    assert lines[-1] == "the kernels were not compiled: see the message above; the same command tries again"
    assert package.library.read_bytes() == before
    assert [path.name for path in package.compiled.iterdir()] == [package.library.name]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_build_that_is_interrupted_leaves_no_half_library(package, number):
    package.library.unlink()
    with package.start("-m", "rocking.kernels") as process:
        assert "compiling" in process.stdout.readline()
        time.sleep(0.5)
        process.send_signal(number)
        told = process.communicate(timeout=100)[0].splitlines()
    if number != signal.SIGKILL:
        assert told[-1] == "the kernels were not compiled: interrupted; the same command tries again"
    assert list(package.compiled.iterdir()) == []
    assert package.build()[-1].startswith("compiled")
    assert package.run() == RIGHT


def test_kernels_edited_during_a_build_are_not_passed_off_as_compiled(package):
    package.library.unlink()
    with package.start("-m", "rocking.kernels") as process:
        assert "compiling" in process.stdout.readline()
        package.write(SUM.replace("FACTOR", "3.0"))
        last = process.communicate(timeout=100)[0].splitlines()[-1]
    assert last == "the kernels were edited while they were compiled; run the same command again"
    assert list(package.compiled.iterdir()) == []


def test_functions_that_are_not_listed_are_refused(package):
    """The platform tag of the wheel and the last digits depend on them."""
    package.write(SUM.replace("FACTOR", "2.0").replace("math.sqrt(value)", "math.erf(value)"))
    lines = package.build()
    assert (
        "ImportError: the kernels must call the C library alone, by the names of C_LIBRARY; they call erf"
        in lines
    )


@pytest.mark.parametrize(
    "settings", [{"NUMBA_OPT": "0"}, {"NUMBA_DISABLE_JIT": "1"}, {"NUMBA_CPU_NAME": "generic"}]
)
def test_settings_of_the_compiler_do_not_reach_the_library(built, package, settings):
    package.library.unlink()
    package.build(**settings)
    assert package.library.read_bytes() == built.library.read_bytes()


def test_two_entry_points_of_one_name_are_refused(package):
    for folder in ("one", "two"):
        (package.kernels / folder).mkdir()
        (package.kernels / folder / "__init__.py").touch()
        (package.kernels / folder / "sums.py").write_text(SUM.replace("FACTOR", "2.0"))
    message = package.run("from rocking.kernels.one import sums\nfrom rocking.kernels.two import sums\n")
    assert message == "ValueError: two entry points have the name sums.total"


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("sys.platform", "darwin", "the kernels are compiled on Linux only"),
        ("platform.machine", lambda: "riscv64", "the kernels are compiled on Linux only"),
        ("platform.libc_ver", lambda: ("", ""), "the kernels are compiled for the C library glibc only"),
        ("sys.version_info", (3, 99), "the compiler numba does not know Python"),
    ],
)
def test_machine_that_is_not_supported_is_refused(monkeypatch, name, value, sentence):
    monkeypatch.setattr(name, value)
    monkeypatch.setattr(build, "KEPT", Path("/dev/null/below"))
    monkeypatch.setattr(sys, "argv", ["rocking.kernels", "--into", "/dev/null/below"])
    classes_here.cache_clear()
    with pytest.raises(SystemExit, match=f"^{sentence}"):
        build.main()
    classes_here.cache_clear()
