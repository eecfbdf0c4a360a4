"""What every test has: pictures without a screen, and the README's code run as it stands."""

import os
import shlex
import subprocess
import sysconfig
from pathlib import Path

import pytest
from sybil import Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser

os.environ["MPLBACKEND"] = "Agg"


@pytest.fixture
def empty_folder(tmp_path, monkeypatch):
    """The reader's own folder: what an example writes goes there."""
    monkeypatch.chdir(tmp_path)


def run_commands(example):
    """The commands of an `sh` block, each of which must succeed."""
    scripts = Path(sysconfig.get_path("scripts"))
    for line in example.parsed.replace("\\\n", " ").splitlines():
        name, *options = shlex.split(line)
        subprocess.run([scripts / name, *options], check=True, capture_output=True)


@pytest.hookimpl(tryfirst=True)  # before the workers' items are grouped by their marks
def pytest_collection_modifyitems(items):
    """The blocks of one page build on each other: one worker runs them all."""
    for item in items:
        if item.path.suffix == ".md":
            item.add_marker(pytest.mark.xdist_group(item.path.name))


pytest_collect_file = Sybil(
    parsers=[PythonCodeBlockParser(), CodeBlockParser(language="sh", evaluator=run_commands)],
    patterns=["README.md"],
    fixtures=["empty_folder"],
).pytest()
