"""The command `rocking` and how it ends: 0, 2 (your input), 1 (we failed), 130 (Ctrl-C); one line on stderr, no traceback."""

from __future__ import annotations

import logging
import os
import signal
import sys
from pathlib import Path
from typing import NoReturn

INTERRUPTED = 130


class Terminal(logging.Handler):
    """What is logged, as a line on stderr; over a bar, if one is there now."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print it."""
        print("rocking:", record.getMessage(), file=sys.stderr)


def main() -> NoReturn:
    """Run the command line and exit."""
    interrupts = []

    def interrupt(*_: object) -> NoReturn:
        # While numba compiles, Ctrl-C can be swallowed on the way and come out as another error, or as none.
        interrupts.append(True)
        sys.unraisablehook = lambda _: None
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by who started us
            setattr(sys, name, Path(os.devnull).open("w", encoding="utf-8"))  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        # A terminal without Greek letters shows question marks.
        stream.reconfigure(errors="replace")  # type: ignore[union-attr]
    if sys.stderr.isatty():
        log = logging.getLogger("rocking")
        log.addHandler(Terminal(logging.INFO))
        log.setLevel(logging.INFO)
    code, message = run()
    if interrupts or code == INTERRUPTED:
        code, message = INTERRUPTED, "interrupted"
    if message:
        print("rocking:", message, file=sys.stderr)
    sys.exit(code)


def run() -> tuple[int, str]:
    """Run the command line: the exit code, and what to say of it in one line."""
    try:
        from rocking.cli.app import app

        # Typer turns Ctrl-C into an exit code, which it returns.
        code = app(prog_name="rocking", standalone_mode=False)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return INTERRUPTED, ""
    except Exception as error:  # noqa: BLE001 (a traceback helps nobody at a prompt)
        code, message = refused(error)
        return code, " ".join(message.split())
    return code or 0, ""


def refused(error: Exception) -> tuple[int, str]:
    """The exit code of a command that an error ended, and what to say of it."""
    from typer import TyperException

    from rocking.model import FULL, WriteError

    if isinstance(error, TyperException):
        return 2, error.format_message()
    if isinstance(error, WriteError):
        return 2, str(error)
    if isinstance(error, BrokenPipeError):  # nobody reads on
        discard_stdout()
        return 1, ""
    if isinstance(error, OSError) and error.errno in FULL:
        discard_stdout()
        return 2, f"the output cannot be written: {error.strerror} (make room, or send it elsewhere)"
    return 1, f"failed, and should not have: {type(error).__name__}: {error}"


def discard_stdout() -> None:
    """Send the rest of stdout nowhere: the interpreter complains of what it cannot write at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
