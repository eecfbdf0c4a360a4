"""Progress bar of a command that waits for machine code, on a terminal and elsewhere."""

import os
import pty
import subprocess
import sys

import pytest

WAIT = """
import sys, time
from rocking.cli.output import compile_bar
from rocking.cli import main
from rocking.kernels.waiting import LISTENERS, report

def run():
    for fraction in (0.0, 0.4, 0.4):
        report("kernel", fraction)
        time.sleep(float(sys.argv[1]))
    {end}
    return 0, ""

compile_bar.PATIENCE = 0.2
main.run = run
main.main()
"""
SHOWS_CURSOR = b"\x1b[?25h"


def seen(seconds, end="report('kernel', 1.0)"):
    """Run a wait on a terminal; return the exit code and what the terminal gets."""
    terminal, program = pty.openpty()
    command = [sys.executable, "-c", WAIT.replace("{end}", end), str(seconds)]
    done = subprocess.run(command, stderr=program, stdout=subprocess.DEVNULL, check=False, timeout=60)
    os.close(program)
    text = b""
    try:
        while part := os.read(terminal, 4096):
            text += part
    except OSError:  # the terminal has no more
        pass
    os.close(terminal)
    return done.returncode, text


def test_long_wait_shows_a_bar_that_goes_away():
    code, text = seen(0.3)
    assert code == 0
    assert b"compiling" in text
    assert b"40%" in text
    assert text.rindex(SHOWS_CURSOR) > text.rindex(b"40%")


def test_short_wait_shows_nothing():
    assert seen(0.01) == (0, b"")


@pytest.mark.parametrize("end", ["raise KeyboardInterrupt", "raise MemoryError"])
def test_bar_goes_away_when_the_wait_is_interrupted(end):
    code, text = seen(0.3, end)
    assert code != 0
    assert text.rindex(SHOWS_CURSOR) > text.rindex(b"40%")
