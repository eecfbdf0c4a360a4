"""What every test has: pictures without a screen; and the code of the README and of the pages, run as it stands."""

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

# Whoever starts the tests in the background has them ignore Ctrl-C, and what they start would too.
signal.signal(signal.SIGINT, signal.default_int_handler)

# What makes the pages needs the parts that only `make docs` installs, and is tried by making them.
collect_ignore = ["docs/extensions"]


FOLDERS = {}


@pytest.fixture
def readers_folder(request, tmp_path_factory, monkeypatch):
    """The reader's own folder, one a page: what an example writes goes there, where the next one finds it."""
    if request.path not in FOLDERS:
        FOLDERS[request.path] = tmp_path_factory.mktemp(request.path.stem)
    monkeypatch.chdir(FOLDERS[request.path])


def run_commands(example):
    """The commands of an `sh` block, each of which must succeed."""
    scripts = Path(sysconfig.get_path("scripts"))
    for line in example.parsed.replace("\\\n", " ").splitlines():
        name, *options = shlex.split(line)
        subprocess.run([scripts / name, *options], check=True, capture_output=True)


def keep_study(example):
    """A `toml` block: the study file of the commands after it."""
    Path("study.toml").write_text(example.parsed, encoding="utf-8")


@pytest.hookimpl(tryfirst=True)  # before the workers' items are grouped by their marks
def pytest_collection_modifyitems(items):
    """The blocks of one page build on each other: one worker runs them all."""
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
