"""Runs the blocks of one page in a fresh interpreter: JSON in, JSON out.

In comes a list of [language, code], out goes for each what it printed and the names of the pictures that it wrote into the current
folder. The blocks of a page build on each other, as for its reader; the first that fails ends the run, with its traceback.
"""

import contextlib
import io
import json
import os
import shlex
import subprocess
import sys
import sysconfig
from pathlib import Path


def pictures():
    """Map each picture and animation of the folder to the time at which it was written."""
    return {
        path.name: path.stat().st_mtime_ns for path in Path().iterdir() if path.suffix in (".png", ".gif")
    }


def run_python(code, namespace):
    """The block as it stands; what it prints."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "<block>", "exec"), namespace)
    return printed.getvalue()


def run_commands(code):
    """Each line as a command of this environment; what they print."""
    printed = []
    for line in code.replace("\\\n", " ").splitlines():
        name, *options = shlex.split(line)
        command = [Path(sysconfig.get_path("scripts")) / name, *options]
        done = subprocess.run(command, check=False, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{line}\n{done.stderr}")
        printed.append(done.stdout)
    return "".join(printed)


def run(blocks):
    """[printed, pictures written] of each block."""
    namespace, found = {"__name__": "__main__"}, []
    for language, code in blocks:
        before = pictures()
        printed = run_python(code, namespace) if language == "python" else run_commands(code)
        written = [
            name for name, at in sorted(pictures().items(), key=lambda one: one[1]) if before.get(name) != at
        ]
        found.append([printed, written])
    return found


if __name__ == "__main__":
    os.environ["MPLBACKEND"] = "Agg"
    sys.argv = ["page"]
    results = run(json.load(sys.stdin))
    json.dump(results, sys.stdout)
