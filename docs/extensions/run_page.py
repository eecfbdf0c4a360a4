"""Program that runs the blocks of one page in a new process.

The input is a list of [language, code] in JSON. The output is a list with the printed text of each block and the names of the pictures
that it wrote into the current folder. Each block sees the names of the blocks before it. The first error ends the run.
With the path of a Markdown file, its blocks are run in a temporary folder instead, and their output is printed.

With ``--serve`` each line of the input is [folder, blocks], and each line of the output is [output, errors]. The output is as above, or
None after an error. A page is run by a fork of this process, which has imported the libraries: 180 imports would take minutes.
"""

import contextlib
import io
import json
import os
import re
import shlex
import subprocess
import sys
import sysconfig
import tempfile
import traceback
from importlib import import_module
from pathlib import Path

LIBRARIES = ("matplotlib.backends.backend_agg", "numpy", "rocking", "scipy.optimize", "xarray")


def pictures():
    """Map each picture and animation of the folder to the time at which it was written."""
    return {
        path.name: path.stat().st_mtime_ns for path in Path().iterdir() if path.suffix in (".png", ".gif")
    }


def run_python(code, namespace):
    """Run a block of Python and return its output."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "<block>", "exec"), namespace)
    return printed.getvalue()


def run_commands(code):
    """Run each line as a command of this environment and return the output."""
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
    """Return [output, names of pictures] of each block."""
    namespace, found = {"__name__": "__main__"}, []
    for language, code in blocks:
        before = pictures()
        printed = run_python(code, namespace) if language == "python" else run_commands(code)
        written = [
            name for name, at in sorted(pictures().items(), key=lambda one: one[1]) if before.get(name) != at
        ]
        found.append([printed, written])
    return found


def run_file(path):
    """Run the blocks of a Markdown file."""
    blocks = re.findall(
        r"^```(python|sh)\n(.*?)^```", path.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        for printed, _ in run(blocks):
            print(printed)


def run_apart(folder, blocks):
    """Return [output of the blocks, errors] of a fork that runs them in a folder."""
    with tempfile.TemporaryFile("w+") as answer, tempfile.TemporaryFile("w+") as errors:
        child = os.fork()
        if child == 0:
            os.dup2(errors.fileno(), sys.stderr.fileno())
            os.chdir(folder)
            try:
                json.dump(run(blocks), answer)
                answer.flush()
            except BaseException:  # noqa: BLE001 - the fork must not go on as the server
                traceback.print_exc()
                sys.stderr.flush()
                os._exit(1)
            os._exit(0)
        _, status = os.waitpid(child, 0)
        for file in (answer, errors):
            file.seek(0)
        return [None if status else json.load(answer), errors.read()]


def serve():
    """Answer each line of the input."""
    for name in LIBRARIES:
        import_module(name)
    for line in sys.stdin:
        print(json.dumps(run_apart(*json.loads(line))), flush=True)


if __name__ == "__main__":
    os.environ["MPLBACKEND"] = "Agg"
    files, sys.argv = sys.argv[1:], ["page"]
    if files == ["--serve"]:
        serve()
    elif files:
        run_file(Path(files[0]))
    else:
        results = run(json.load(sys.stdin))
        json.dump(results, sys.stdout)
