"""The command line, run in this process, or in a separate one that Ctrl-C ends, and records for it."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import record_files as write
from rocking.cli.main import run

WAVE = np.round(0.8 * np.sin(0.15 * np.arange(400)) * np.exp(-np.arange(400) / 150), 3)
"""Acceleration in units of g, at steps of 0.01 s."""
RECORDS = {
    "pulse.csv": "time (s), acceleration (m/s²)\n0, 0\n0.2, 4\n0.4, -5\n0.6, 3\n0.8, 0\n",
    "push.csv": "time (s), acceleration (m/s²)\n0, 0\n0.5, 12\n1, 0\n",
    "gentle.csv": "time (s), acceleration (m/s²)\n0, 0\n0.5, 1\n1, 0\n",
    "bare.txt": "0\n4\n-4\n0\n",
    "times.txt": "# s\n"
    + "\n".join(map(str, (5.83, 13.62, 19.59, 24.37, 28.29, 31.53, 34.24, 36.52, 38.44))),
    "wave.txt": "\n".join(map(str, WAVE)),
    "set/a.AT2": "\n".join(write.peer(WAVE)),
    "set/b.AT2": "\n".join(write.peer(-0.5 * WAVE)),
    "table.csv": "file,scale\nset/a.AT2,0.5\nset/b.AT2,\n",
}


@pytest.fixture
def records(tmp_path, monkeypatch):
    """Go to an empty folder, and write records in it."""
    monkeypatch.chdir(tmp_path)
    Path("set").mkdir()
    for name, text in RECORDS.items():
        Path(name).write_text(text, encoding="utf-8")


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
