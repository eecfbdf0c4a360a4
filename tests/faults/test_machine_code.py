"""Machine code of a small package with one entry point: compiled once, found again, and right whatever goes wrong.

The package holds the modules of `rocking.kernels` that compile and load, and none of the physics.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rocking import kernels
from rocking.kernels import build_processes

SOURCES = Path(kernels.__file__).parent
MODULES = (
    "__main__",
    "build_processes",
    "builder",
    "compile_missing",
    "compile_options",
    "compiler",
    "deferred",
    "entry_point",
    "machine_code",
    "signature",
    "waiting",
)
SUM = """
import math
from rocking.kernels.compile_options import INTERNAL, KERNEL
from rocking.kernels.deferred import njit
from rocking.kernels.entry_point import entry_point
from rocking.kernels.signature import Floats1

@njit(**INTERNAL)
def weigh(value):
    return FACTOR * math.exp(value)

@entry_point(**KERNEL)
def total(values: Floats1) -> float:
    result = 0.0
    for k in range(values.shape[0]):
        result += weigh(values[k])
    return result
"""
# It runs at the start of every interpreter: it notes what is compiled, and may wait before or make it fail.
CUSTOM = """
import os, time
notes, seconds = os.environ["NOTES"], float(os.environ.get("SECONDS", 0))

if os.environ.get("OLD"):
    import llvmlite.binding as llvm
    features = llvm.get_host_cpu_features()
    features.update({"avx2": False, "fma": False})
    llvm.get_host_cpu_features = lambda: features

from rocking.kernels.entry_point import EntryPoint
compile_entry = EntryPoint.compile

def noted(self):
    with open(notes, "a") as file:
        file.write(f"{os.getpid()}\\n")
    time.sleep(seconds)
    return compile_entry(self)

EntryPoint.compile = noted
"""
RUN = """
import json, logging, sys
import numpy as np
logging.basicConfig(level="INFO", format="%(message)s")
from rocking.kernels import machine_code, waiting
from rocking.kernels.sums import total
told = []
waiting.LISTENERS.append(lambda name, fraction: told.append(fraction))
result = total(np.array([0.0, 1.0]))
print(json.dumps({"result": result, "told": told, "numba": "numba" in sys.modules, "class": machine_code.processor_class()}))
"""
RIGHT = 2.0 * (1.0 + 2.718281828459045)


class Package:
    """A copy of the modules, and processes that use it."""

    def __init__(self, folder):
        self.kernels, self.notes, self.cache = (
            folder / "src/rocking/kernels",
            folder / "notes",
            folder / "cache",
        )
        self.kernels.mkdir(parents=True)
        for name in ("__init__", *MODULES):
            shutil.copy(SOURCES / f"{name}.py", self.kernels)
        (self.kernels.parent / "__init__.py").write_text("")
        (self.kernels / "sums.py").write_text(SUM.replace("FACTOR", "2.0"))
        (folder / "src/sitecustomize.py").write_text(CUSTOM)
        self.environment = os.environ | {
            "PYTHONPATH": str(folder / "src"),
            "NOTES": str(self.notes),
            "NUMBA_CACHE_DIR": str(self.cache),
        }

    def start(self, code=RUN, **environment):
        return subprocess.Popen(
            [sys.executable, "-P", "-c", code],
            env=self.environment | environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def run(self, **environment):
        """Return what a process prints, with its messages."""
        with self.start(**environment) as process:
            out, errors = process.communicate(timeout=100)
        assert process.returncode == 0, errors
        return json.loads(out) | {"errors": errors}

    @property
    def compilers(self):
        """Processes that began to compile, one number for each time."""
        return [int(line) for line in self.notes.read_text().split()] if self.notes.exists() else []

    def await_compiler(self):
        """Wait until a process compiles, and return its number."""
        while not self.compilers:
            time.sleep(0.02)
        return self.compilers[0]

    def files(self):
        return {path.suffix for path in self.cache.rglob("*") if path.is_file()}


@pytest.fixture
def package(tmp_path):
    return Package(tmp_path)


def test_code_is_compiled_once_and_found_again_without_the_compiler(package):
    first, second = package.run(), package.run()
    assert first["result"] == second["result"] == RIGHT
    assert (first["numba"], second["numba"]) == (False, False)
    assert len(package.compilers) == 1
    assert first["told"] == sorted(first["told"])
    assert (first["told"][0], first["told"][-1], second["told"]) == (0.0, 1.0, [])
    assert first["errors"] == "compiling the kernels (once for this machine)\n"
    assert second["errors"] == ""
    assert package.files() == {".o", ".lock"}


def test_an_edited_kernel_is_compiled_anew(package):
    package.run()
    (package.kernels / "sums.py").write_text(SUM.replace("FACTOR", "3.0"))
    assert package.run()["result"] == pytest.approx(1.5 * RIGHT, rel=1e-15, abs=0)
    (package.kernels / "sums.py").write_text(SUM.replace("FACTOR", "2.0"))
    assert package.run()["result"] == RIGHT
    assert len(package.compilers) == 2


@pytest.mark.parametrize(
    "damage", [lambda code: code[:-1], lambda code: code[:200] + b"x" + code[201:], lambda _: b""]
)
def test_a_damaged_file_is_compiled_anew(package, damage):
    package.run()
    (file,) = package.cache.rglob("*.o")
    code = file.read_bytes()
    file.write_bytes(damage(code))
    assert package.run()["result"] == RIGHT
    assert file.read_bytes()[32:64] == code[32:64]
    assert len(package.compilers) == 2


def into_the_package(package, **environment):
    """Compile, and move the machine code into the package, as a wheel has it."""
    sort = package.run(**environment)["class"]
    (file,) = package.cache.rglob("*.o")
    sources = file.parent.name.split("-")[1]
    library = package.kernels / "library" / f"{sources}-{sort}"
    library.mkdir(parents=True)
    file.rename(library / file.name)
    shutil.rmtree(package.cache)
    return library


def test_machine_code_of_the_package_needs_neither_compiler_nor_cache(package):
    into_the_package(package)
    told = package.run(
        NUMBA_CACHE_DIR="/dev/null/a", XDG_CACHE_HOME="/dev/null/b", HOME="/dev/null", TMPDIR="/dev/null"
    )
    assert (told["result"], told["numba"], told["told"], told["errors"]) == (RIGHT, False, [], "")
    assert len(package.compilers) == 1


def test_machine_code_of_the_package_is_passed_over_on_demand(package):
    into_the_package(package)
    assert package.run(ROCKING_FORCE_JIT="1")["result"] == RIGHT
    assert len(package.compilers) == 2


def test_machine_code_of_other_sources_is_never_used(package):
    into_the_package(package)
    (package.kernels / "sums.py").write_text(SUM.replace("FACTOR", "4.0"))
    assert package.run()["result"] == 2.0 * RIGHT
    assert len(package.compilers) == 2


def test_processor_without_the_instructions_of_a_library_compiles_its_own(package):
    into_the_package(package)
    told = package.run(OLD="1")
    assert (told["result"], told["class"]) == (RIGHT, "native")
    assert len(package.compilers) == 2
    assert "-native-" in next(package.cache.rglob("*.o")).parent.name
    assert package.run(OLD="1")["told"] == []
    assert len(package.compilers) == 2


@pytest.mark.parametrize("place", ["NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "HOME", None])
def test_machine_code_is_kept_in_the_first_folder_that_can_be_written_and_else_not_at_all(
    package, tmp_path, place
):
    nowhere = dict.fromkeys(("NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "HOME", "TMPDIR"), "/dev/null/below")
    if place == "HOME":
        nowhere["XDG_CACHE_HOME"] = ""
    before = RUN.replace(
        "import json", "import tempfile\ntempfile.gettempdir = lambda: '/dev/null'\nimport json", 1
    )
    kept = nowhere | ({place: str(tmp_path / "home")} if place else {})
    with package.start(before, **kept) as process:
        out, errors = process.communicate(timeout=100)
    assert json.loads(out)["result"] == RIGHT
    found = list(tmp_path.rglob("*.o"))
    if place:
        assert [(tmp_path / "home") in path.parents for path in found] == [True]
        assert errors == "compiling the kernels (once for this machine)\n"
    else:
        assert found == []
        assert errors == "compiling the kernels (at every start, because no cache folder is writable)\n"


LIMITED = "import resource\nresource.setrlimit(resource.RLIMIT_FSIZE, (1_000, 1_000))\n"


def test_full_disk_costs_the_time_and_not_the_answer(package):
    package.environment["NOTES"] = os.devnull
    for _ in range(2):
        with package.start(LIMITED + RUN) as process:
            out, errors = process.communicate(timeout=100)
        assert (process.returncode, json.loads(out)["result"]) == (0, RIGHT), errors
    assert package.files() <= {".error", ".lock", ".wanted"}


def test_three_processes_at_once_compile_once(package):
    several = [package.start(SECONDS="1") for _ in range(3)]
    answers = [json.loads(process.communicate(timeout=100)[0])["result"] for process in several]
    assert answers == [RIGHT] * 3
    assert len(package.compilers) == 1


def test_control_c_ends_the_wait_and_leaves_the_compiler_at_work(package):
    with package.start(SECONDS="2") as process:
        package.await_compiler()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
    assert errors.splitlines()[-1] == "KeyboardInterrupt"
    assert package.run()["result"] == RIGHT
    assert len(package.compilers) == 1


def test_compiler_that_is_killed_is_replaced(package):
    with package.start(SECONDS="2") as process:
        os.kill(package.await_compiler(), signal.SIGKILL)
        out, errors = process.communicate(timeout=100)
    assert json.loads(out)["result"] == RIGHT, errors
    assert package.run()["result"] == RIGHT
    assert len(package.compilers) == 2


def test_all_is_compiled_on_demand_and_a_second_time_nothing(package):
    command = [sys.executable, "-P", "-m", "rocking.kernels"]
    for _ in range(2):
        subprocess.run(command, env=package.environment, check=True, timeout=100)
    assert len(list(package.cache.rglob("*.o"))) == len(package.compilers) == 1


def test_background_compiler_outlives_the_command_that_started_it(package):
    command = [sys.executable, "-P", "-m", "rocking.kernels", "--background"]
    subprocess.run(command, env=package.environment | {"SECONDS": "1"}, check=True, timeout=100)
    assert list(package.cache.rglob("*.o")) == []
    while not list(package.cache.rglob("*.o")):
        time.sleep(0.05)
    assert package.run()["told"] == []


TWO = """
from typing import NamedTuple
from rocking.kernels.compile_options import KERNEL
from rocking.kernels.entry_point import entry_point

class One(NamedTuple):
    first: float

class Two(NamedTuple):
    first: float
    second: float

class Problem(NamedTuple):
    times: int
    p: One | Two

@entry_point(**KERNEL)
def add(problem: Problem) -> float:
    total = 0.0
    for value in problem.p:
        total += value
    return problem.times * total
"""
RUN_TWO = """
from rocking.kernels.entry_point import ENTRY_POINTS
from rocking.kernels.two import One, Problem, Two, add
print(add(Problem(3, One(2.0))), add(Problem(3, Two(2.0, 5.0))), *sorted(ENTRY_POINTS))
"""


def test_union_among_the_types_makes_one_entry_point_for_each_member(package):
    (package.kernels / "two.py").write_text(TWO)
    with package.start(RUN_TWO) as process:
        out, errors = process.communicate(timeout=100)
    assert out == "6.0 21.0 two.add.One two.add.Two\n", errors
    assert {path.stem for path in package.cache.rglob("*.o")} >= {"two.add.One", "two.add.Two"}


def test_file_system_without_locks_costs_the_time_and_not_the_answer(package):
    (package.kernels.parents[1] / "sitecustomize.py").write_text(
        CUSTOM
        + """
import errno, fcntl

def flock(file, operation):
    raise OSError(errno.ENOLCK, "No locks available")

fcntl.flock = flock
"""
    )
    assert package.run()["result"] == RIGHT
    assert len(package.compilers) == 1


@pytest.mark.parametrize("executable", ["None", "''"])
def test_program_without_an_interpreter_compiles_by_itself(package, executable):
    with package.start(f"import sys\nsys.executable = {executable}\n{RUN}") as process:
        out, errors = process.communicate(timeout=100)
    assert process.returncode == 0, errors
    assert (json.loads(out)["result"], json.loads(out)["numba"]) == (RIGHT, True)
    assert package.compilers == [process.pid]


def test_settings_of_the_compiler_do_not_reach_code_that_others_use(package, monkeypatch):
    others = {
        "NUMBA_OPT": "0",
        "NUMBA_DISABLE_JIT": "1",
        "NUMBA_BOUNDSCHECK": "1",
        "NUMBA_CPU_NAME": "generic",
    }
    for name, value in others.items():
        monkeypatch.setenv(name, value)
    for processors, own in (("x86-64-v3", {"NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"}), ("native", set())):
        environment = build_processes.builder_environment(processors)
        assert {name for name in environment if name.startswith("NUMBA_")} == own
        assert environment.get("NUMBA_CPU_NAME") != "generic"
    assert package.run(**others)["result"] == RIGHT
    assert len(package.compilers) == 1


EDITED = """
from rocking.kernels import machine_code, sums
machine_code.hash_sources()
source = machine_code.SOURCES / "sums.py"
source.write_text(source.read_text().replace("2.0", "3.0"))
"""


def test_code_of_sources_that_were_edited_later_is_not_stored(package):
    with package.start(EDITED + RUN) as process:
        out, errors = process.communicate(timeout=100)
    assert json.loads(out)["result"] == RIGHT, errors
    assert package.compilers == [process.pid]
    assert ".o" not in package.files()
    assert package.run()["result"] == 1.5 * RIGHT


BROKEN = """
from rocking.kernels.compile_options import KERNEL
from rocking.kernels.entry_point import entry_point

@entry_point(**KERNEL)
def a_count(n: int) -> int:
    return n / 2
"""


def test_kernel_that_cannot_be_compiled_says_so_and_stops_no_other(package):
    """It would return the bits of a float as an integer."""
    (package.kernels / "broken.py").write_text(BROKEN)
    with package.start("from rocking.kernels.broken import a_count\na_count(3)") as process:
        errors = process.communicate(timeout=100)[1]
    assert "broken.a_count is declared to return int64, and returns float64" in errors
    assert package.run()["result"] == RIGHT
    assert [path.name for path in package.cache.rglob("*.o")] == ["sums.total.o"]
    command = [sys.executable, "-P", "-m", "rocking.kernels"]
    done = subprocess.run(command, env=package.environment, check=False, capture_output=True, text=True)
    assert "not compiled: broken.a_count\n" in done.stderr
    assert "and returns float64" in done.stderr


def test_two_entry_points_of_one_name_are_refused(package):
    for folder in ("one", "two"):
        (package.kernels / folder).mkdir()
        (package.kernels / folder / "__init__.py").write_text("")
        (package.kernels / folder / "sums.py").write_text(SUM.replace("FACTOR", "2.0"))
    with package.start(
        "from rocking.kernels.one import sums\nfrom rocking.kernels.two import sums"
    ) as process:
        errors = process.communicate(timeout=100)[1]
    assert errors.splitlines()[-1] == "ValueError: two entry points have the name sums.total"


@pytest.mark.parametrize("mode", [0o777, 0o720])
def test_temporary_folder_in_which_others_can_write_is_not_used(package, tmp_path, mode):
    home = tmp_path / "temporary" / f"cache-{os.getuid()}"
    home.mkdir(parents=True)
    home.chmod(mode)
    nowhere = dict.fromkeys(("NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "HOME"), "/dev/null/below")
    for used in (False, True):
        told = package.run(**nowhere, TMPDIR=str(home.parent))
        assert told["result"] == RIGHT
        assert bool(list(home.rglob("*.o"))) is used
        home.chmod(0o700)
