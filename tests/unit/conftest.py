"""The command, typed in this process."""

import sys

import pytest

from rocking.cli.main import run


@pytest.fixture
def rocking(monkeypatch, tmp_path, capsys):
    """Types a command line in an empty folder: (exit code, what it says of it, stdout)."""
    monkeypatch.chdir(tmp_path)

    def type_line(line):
        monkeypatch.setattr(sys, "argv", ["rocking", *line.split()])
        code, message = run()
        return code, message, capsys.readouterr().out

    return type_line
