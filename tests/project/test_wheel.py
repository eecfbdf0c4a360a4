"""The wheel alone, without the repository: its metadata, its libraries, and figures of the paper."""

import email
import os
import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from rocking.kernels.library.processor import CLASSES
from scripts import wheel as script

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel that `make wheel` makes."""
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run([sys.executable, ROOT / "scripts/wheel.py", folder], check=True, capture_output=True)
    (made,) = folder.iterdir()
    return made


@pytest.fixture(scope="module")
def run(wheel, tmp_path_factory):
    """Run Python with the wheel."""
    folder = tmp_path_factory.mktemp("installed")
    options = ["--no-deps", "--target", folder / "packages"]
    subprocess.run([sys.executable, "-m", "pip", "install", *options, wheel], check=True, capture_output=True)

    def run(*command):
        environment = os.environ | {"PYTHONPATH": str(folder / "packages")}
        done = subprocess.run(
            [sys.executable, "-P", *command],
            cwd=folder,
            env=environment,
            check=True,
            capture_output=True,
            text=True,
        )
        return done.stdout

    run.folder = folder
    return run


def test_metadata_say_what_is_inside(wheel):
    assert wheel.stat().st_size <= 6_500_000
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        (folder,) = {name.split("/")[0] for name in names if ".dist-info/" in name}
        tags = email.message_from_bytes(archive.read(f"{folder}/WHEEL"))
        about = email.message_from_bytes(archive.read(f"{folder}/METADATA"))
    classes = [name for name in CLASSES if name.startswith("x86-64")]
    libraries = {f"rocking/kernels/compiled/kernels-{name}.so" for name in classes}
    assert {name for name in names if name.endswith(".so")} == libraries
    tag = f"py3-none-{script.platform_tag(wheel)}"
    assert re.fullmatch(r"py3-none-manylinux_2_\d+_x86_64", tag)
    assert tags.get_all("Tag") == [tag]
    assert wheel.name == f"rocking-{about['Version']}-{tag}.whl"
    assert (about["Name"], about["Requires-Python"]) == ("rocking", PROJECT["requires-python"])
    required = [Requirement(text) for text in about.get_all("Requires-Dist")]
    assert {each.name for each in required if not each.marker} == {
        Requirement(text).name for text in PROJECT["dependencies"]
    }


WITHOUT_COMPILER = """
import sys
import rocking as rk
system = rk.System(rk.Harmonic(2.0, period=1.0), 0.925)
print(rk.__file__, rk.simulate(system, cycles=9).impacts, rk.classify(system).kind)
system = rk.System(rk.Harmonic(2.0, period=1.0), 1.0)
print(*rk.parametric_map(system, amplitude=[1.2, 2.0], period=[0.5, 1.0], max_cycles=500).dataset.kind.values.ravel())
block = rk.Block(height=1.0, width=0.3)
record = rk.example_ground_motion().scaled(pga=5.0)
shaken = [rk.simulate(block.system(record, model=model)) for model in ("slender", "full")]
print(*[(str(motion.outcome), motion.impacts > 9) for motion in shaken])
print("numba" in sys.modules)
"""


def test_nothing_is_compiled_and_numba_is_not_loaded(run):
    first, kinds, outcomes, loaded = run("-c", WITHOUT_COMPILER).splitlines()
    assert first == f"{run.folder}/packages/rocking/__init__.py 17 periodic"
    assert len(kinds.split()) == 4
    assert outcomes == "('at-rest', True) ('at-rest', True)"
    assert loaded == "False"


def test_the_wheel_alone_draws_the_paper(run):
    run("-m", "rocking", "paper", "1", "2", "--output", "drawn")
    assert sorted(path.name for path in (run.folder / "drawn").glob("*.png")) == [
        "figure-01.png",
        "figure-02.png",
    ]
    package = run.folder / "packages/rocking"
    assert (package / "py.typed").exists()
    assert (package / "records/0111a.smc").exists()
    pages = {path.relative_to(package).as_posix() for path in package.rglob("*.html")}
    assert {"papers/report/page.html", "plot/zoomable_map.html", "explorer/ground.html"} <= pages


def test_source_distribution_holds_the_backend_and_no_library(tmp_path):
    code = f"import sys; sys.path.insert(0, 'scripts/backend'); import build_backend; build_backend.build_sdist({str(tmp_path)!r})"
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, capture_output=True)
    (made,) = tmp_path.iterdir()
    with tarfile.open(made) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {"scripts/backend/build_backend.py", "src/rocking/kernels/library/build.py"} <= names
    assert not [name for name in names if name.endswith(".so")]
