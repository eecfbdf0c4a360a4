"""The wheel alone, without the repository, draws figures of the paper."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def pip(*options):
    subprocess.run([sys.executable, "-m", "pip", *options], check=True, capture_output=True)


@pytest.mark.long
def test_the_wheel_alone_draws_the_paper(tmp_path):
    source, wheels, installed = (tmp_path / name for name in ("source", "wheels", "installed"))
    shutil.copytree(ROOT / "src", source / "src", ignore=shutil.ignore_patterns("*.egg-info", "__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    pip("wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", wheels, source)
    pip("install", "--no-deps", "--target", installed, *wheels.iterdir())

    def run(*command):
        environment = os.environ | {"PYTHONPATH": str(installed)}
        done = subprocess.run(
            [sys.executable, *command],
            cwd=tmp_path,
            env=environment,
            check=True,
            capture_output=True,
            text=True,
        )
        return done.stdout

    assert run("-c", "import rocking; print(rocking.__file__)").startswith(str(installed))
    run("-m", "rocking", "paper", "1", "2", "--output", "drawn")
    assert sorted(path.name for path in (tmp_path / "drawn").glob("*.png")) == [
        "figure-01.png",
        "figure-02.png",
    ]
    assert (installed / "rocking" / "py.typed").exists()
    assert {"report.html", "zoomable_map.html"} <= {path.name for path in installed.rglob("*.html")}
