"""Every command and every module without the compiler of the kernels, as after a plain installation."""

import os
import subprocess
import sys

from golden.outputs import FOLDER

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
