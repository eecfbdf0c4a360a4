"""Scripts of the Makefile: packages of Debian, and commands that are shown while they run."""

import os
import re
import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "scripts" / "debian.sh"
THERE = 'echo "installed"'


@pytest.fixture
def debian(tmp_path):
    """Run the script with these stand-in commands; return exit code, stderr and the arguments of apt-get."""

    def run(**commands):
        asked = tmp_path / "asked"
        for name, says in (commands | {"apt-get": f'echo "$@" >>{asked}'}).items():
            command = tmp_path / name.replace("_", "-")
            command.write_text(f"#!/bin/bash\n{says}\n")
            command.chmod(0o755)
        environment = os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}"}
        done = subprocess.run(
            [SCRIPT, "chromium"], env=environment, capture_output=True, text=True, check=False
        )
        return done.returncode, done.stderr, asked.read_text().splitlines() if asked.exists() else []

    return run


def test_what_is_there_is_left_alone(debian):
    assert debian(dpkg_query=THERE, id="echo 0") == (0, "", [])


def test_what_is_missing_is_installed_by_who_may(debian):
    code, said, asked = debian(dpkg_query="exit 1", id="echo 0")
    assert (code, said) == (0, "")
    assert asked == ["update -qq", "install -qq --no-install-recommends chromium"]


def test_who_may_not_install_is_told_the_names(debian):
    code, said, asked = debian(dpkg_query="exit 1", id="echo 1000")
    assert (code, asked) == (1, [])
    assert said.startswith("missing on this machine: chromium ")


@pytest.mark.parametrize(
    ("command", "code", "out", "err"),
    [("echo well", 0, r"Building: done in \d+ s\n", ""), ("echo lost; exit 3", 3, "", "lost\n")],
)
def test_command_that_is_shown_keeps_its_exit_code_and_prints_its_output_if_it_fails(command, code, out, err):
    line = [SCRIPT.with_name("watched.sh"), "Building", "bash", "-c", f"sleep 0.5; {command}"]
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (code, err)
    first, _, rest = done.stdout.partition("\n")
    assert re.fullmatch(r"Building: \d+ s  ", first)
    assert re.fullmatch(out, rest)
