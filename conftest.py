"""Common to all tests: figures without a screen, and the code blocks of the README and of the pages as tests."""

import os
import shlex
import signal
import subprocess
import sysconfig
from pathlib import Path

import pytest
from sybil import Sybil
from sybil.parsers.myst import CodeBlockParser, PythonCodeBlockParser

os.environ["MPLBACKEND"] = "Agg"

# A process in the background ignores Ctrl-C, and so do the processes that it starts.
signal.signal(signal.SIGINT, signal.default_int_handler)

# The settings and the extensions of the pages need packages that only `make docs` installs. `make docs` tests them.
collect_ignore = ["docs/conf.py", "docs/extensions"]


FOLDERS = {}


@pytest.fixture
def readers_folder(request, tmp_path_factory, monkeypatch):
    """Folder of a reader, one per page: a block finds the files that earlier blocks of the page wrote."""
    if request.path not in FOLDERS:
        FOLDERS[request.path] = tmp_path_factory.mktemp(request.path.stem)
    monkeypatch.chdir(FOLDERS[request.path])


def run_commands(example):
    """Run the commands of an `sh` block, each of which must succeed."""
    scripts = Path(sysconfig.get_path("scripts"))
    for line in example.parsed.replace("\\\n", " ").splitlines():
        name, *options = shlex.split(line)
        subprocess.run([scripts / name, *options], check=True, capture_output=True)


def keep_study(example):
    """Write a `toml` block as the study file of the commands after it."""
    Path("study.toml").write_text(example.parsed, encoding="utf-8")


@pytest.hookimpl(tryfirst=True)  # before the items are grouped by their marks for the workers
def pytest_collection_modifyitems(items):
    """Let one worker run all blocks of a page, because they depend on each other; run each example of the package once."""
    # An example of a public name is found where it is defined, and again where it is public.
    items[:] = [item for item in items if item.path.name != "__init__.py"]
    for item in items:
        if item.path.suffix == ".md":
            item.add_marker(pytest.mark.xdist_group(item.path.name))


pytest_collect_file = Sybil(
    parsers=[
        PythonCodeBlockParser(),
        CodeBlockParser(language="sh", evaluator=run_commands),
        CodeBlockParser(language="toml", evaluator=keep_study),
    ],
    patterns=["README.md", "docs/*.md"],
    fixtures=["readers_folder"],
).pytest()
