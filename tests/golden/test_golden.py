"""The commands print and write what their golden files hold: `python tests/golden/outputs.py` accepts a change."""

import os
import subprocess
import sys

import pytest
import typer

from golden.outputs import FOLDER, recorded
from rocking.cli.app import app

FILES = sorted(FOLDER.glob("*.txt"))


def test_each_command_has_a_golden_file():
    assert {path.stem for path in FILES} == {"rocking", *typer.main.get_command(app).commands}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_output_is_as_recorded(path):
    assert recorded(path).splitlines() == path.read_text().splitlines()


WITHOUT_COMPILER = """
import importlib, pkgutil, sys
sys.modules["numba"] = sys.modules["llvmlite"] = None
from golden.outputs import FOLDER, recorded
import rocking
print([path.name for path in FOLDER.glob("*.txt") if recorded(path).splitlines() != path.read_text().splitlines()])
compilers = "rocking.kernels.library", "rocking.kernels.__main__", "rocking.__main__"
for module in pkgutil.walk_packages(rocking.__path__, "rocking."):
    if not module.name.startswith(compilers):
        importlib.import_module(module.name)
"""


def test_no_command_and_no_module_needs_the_compiler():
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(FOLDER.parent), *sys.path])}
    line = [sys.executable, "-c", WITHOUT_COMPILER]
    done = subprocess.run(line, env=environment, check=False, capture_output=True, text=True)
    assert (done.stdout, done.stderr, done.returncode) == ("[]\n", "", 0)
