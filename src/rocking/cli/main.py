"""Entry point of the command `rocking`.

Exit codes: 0 success, 1 internal error, 2 invalid input, 130 interrupted (Ctrl-C). An error is one line on stderr.
"""

from __future__ import annotations

import logging
import os
import re
import signal
import sys
from pathlib import Path
from typing import NoReturn

from rocking.cli.output.compile_bar import CompileBar
from rocking.kernels.waiting import LISTENERS

INTERRUPTED = 130


class Terminal(logging.Handler):
    """Logging handler that prints each record as one line on stderr."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print the message of a record."""
        print("rocking:", record.getMessage(), file=sys.stderr)


def main() -> NoReturn:
    """Run the command line and exit."""
    interrupts, bar = [], CompileBar()

    def interrupt(*_: object) -> NoReturn:
        # Some libraries lose a KeyboardInterrupt or turn it into another error: so it is recorded here.
        interrupts.append(True)
        sys.unraisablehook = lambda _: None
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by the calling process
            setattr(sys, name, Path(os.devnull).open("w", encoding="utf-8"))  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        # A terminal whose encoding lacks Greek letters shows question marks.
        stream.reconfigure(errors="replace")  # type: ignore[union-attr]
    if sys.stderr.isatty():
        log = logging.getLogger("rocking")
        log.addHandler(Terminal(logging.INFO))
        log.setLevel(logging.INFO)
        LISTENERS.append(bar)
    try:
        code, message = run()
    finally:
        bar.close()
    if interrupts or code == INTERRUPTED:
        code, message = INTERRUPTED, "interrupted"
    if message:
        print("rocking:", message, file=sys.stderr)
    sys.exit(code)


def run() -> tuple[int, str]:
    """Run the command line; return the exit code and a message of one line, empty if there is nothing to report."""
    try:
        from rocking.cli.app import app

        # Typer returns the exit code of Ctrl-C instead of raising KeyboardInterrupt.
        code = app(prog_name="rocking", standalone_mode=False)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return INTERRUPTED, ""
    except Exception as error:  # noqa: BLE001 (the user gets one line, not a traceback)
        code, message = refused(error)
        return code, " ".join(message.split())
    return code or 0, ""


def refused(error: Exception) -> tuple[int, str]:
    """Return the exit code and the message for an error that ended a command."""
    from typer import TyperException

    from rocking.model import FULL, WriteError

    if isinstance(error, TyperException):
        # Typer's "Invalid value for '--name': must …" in the form of all other messages.
        return 2, re.sub(r"^Invalid value for '([\w-]+)': must ", r"\1 must ", error.format_message())
    if isinstance(error, WriteError):
        return 2, str(error)
    if isinstance(error, BrokenPipeError):  # the reader of the pipe has closed it
        discard_stdout()
        return 1, ""
    if isinstance(error, OSError) and error.errno in FULL:
        discard_stdout()
        return 2, f"the output cannot be written: {error.strerror} (free some space, or redirect the output)"
    return 1, f"internal error: {type(error).__name__}: {error}"


def discard_stdout() -> None:
    """Discard the rest of stdout: at exit the interpreter reports output that it cannot flush."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
