"""The command line, run in this process, or in a separate one that Ctrl-C ends."""

import signal
import subprocess
import sys
import time

import pytest

from rocking.cli.main import run


@pytest.fixture
def rocking(monkeypatch, tmp_path, capsys):
    """Type a command line in an empty folder; return exit code, message and stdout."""
    monkeypatch.chdir(tmp_path)

    def type_line(line):
        monkeypatch.setattr(sys, "argv", ["rocking", *line.split()])
        code, message = run()
        return code, message, capsys.readouterr().out

    return type_line


@pytest.fixture
def terminal(monkeypatch, capsys):
    """Make stderr a terminal of 200 columns; return a function that gives what was written to it, line by line."""
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(type(sys.stderr), "isatty", lambda stream: stream is sys.stderr)
    return lambda: [
        line.rpartition("\r\x1b[K")[2] for line in capsys.readouterr().err.rstrip("\n").split("\n")
    ]


@pytest.fixture
def interrupted(tmp_path):
    """Type a command line in an empty folder, and Ctrl-C ``seconds`` later; return exit code, stdout and stderr."""

    def type_line(line, seconds):
        with subprocess.Popen(
            [sys.executable, "-m", "rocking", *line.split()],
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        ) as process:
            time.sleep(seconds)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=20)
        return process.returncode, out, err

    return type_line
