"""On a full disk one line names the output that cannot be written, and no partial file stays."""

import subprocess
import sys
from pathlib import Path

import pytest

SIMULATE = "simulate --amplitude 2 --period 1 --restitution 0.9 --cycles 300"
MAP = "map --amplitude 0:6:40 --period 1:2:40 --restitution 0.9 --max-cycles 100"
LIMITED = """
import resource, sys
from rocking.cli.main import main

limit = int(sys.argv.pop(1))
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
main()
"""


def limited(line, limit, folder):
    """Return a command whose files are limited to ``limit`` bytes."""
    return subprocess.run(
        [sys.executable, "-c", LIMITED, str(limit), *line.split()],
        cwd=folder, capture_output=True, text=True, timeout=200, check=False,
    )  # fmt: skip


@pytest.mark.parametrize(
    "line, limit",
    [*(pytest.param(f"{SIMULATE} --plot out.{suffix}", 2_000, marks=pytest.mark.long) for suffix in ("png", "gif")),
     (f"{SIMULATE} --csv out.csv", 9_000), pytest.param(f"{SIMULATE} --netcdf out.nc", 9_000, marks=pytest.mark.long),
     (f"{MAP} --tiles out", 300)],
)  # fmt: skip
def test_output_that_finds_no_room_is_named_and_leaves_nothing(line, limit, tmp_path):
    output = line.split()[-1]
    done = limited(line, limit, tmp_path)
    assert done.stderr == (
        f"rocking: '{output}' cannot be written: File too large; existing data are unchanged (free some space, or give another path)\n"
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.long
def test_film_that_is_not_whole_is_refused(tmp_path):
    done = limited(f"{SIMULATE} --plot out.mp4", 9_000, tmp_path)
    assert done.stderr.splitlines()[-1].startswith("rocking: 'out.mp4' cannot be written: ffmpeg has ")
    assert (done.returncode, done.stdout) == (2, "")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize("line", ["cite", "map --help", SIMULATE])
def test_stdout_that_finds_no_room_is_said(line, unbuffered, monkeypatch):
    monkeypatch.setenv("PYTHONUNBUFFERED", unbuffered)
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "rocking", *line.split()],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.stderr == (
        "rocking: the output cannot be written: No space left on device (free some space, or redirect the output)\n"
    )
    assert done.returncode == 2
