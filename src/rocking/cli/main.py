"""Entry point of the command `rocking`.

Exit codes: 0 success, 1 internal error, 2 invalid input, 130 interrupted (Ctrl-C). 2 also stands for a lack of memory, of disk space,
of compiled kernels, or of an optional package. An error is one line on stderr.
"""

from __future__ import annotations

import errno
import logging
import os
import re
import resource
import signal
import sys
import warnings
from pathlib import Path
from typing import NoReturn

INTERRUPTED = 130
LACK = re.compile("can't start new thread|failed to map segment|cannot allocate memory", re.IGNORECASE)

LACKING = (
    "the memory or the threads that this process may use do not suffice: {} "
    "(reduce the numbers of points, samples or cycles, or raise the limits, such as those of ulimit -v and ulimit -u)"
)
NO_MEMORY = LACKING.format("no more memory can be allocated")


class Terminal(logging.Handler):
    """Logging handler that prints each record as one line on stderr."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print the message of a record, and the type and the message of its exception."""
        message = record.getMessage()
        if record.exc_info and (error := record.exc_info[1]) is not None:
            message += f": {type(error).__name__}: {error}"
        print("rocking:", " ".join(message.split()), file=sys.stderr)


def main() -> NoReturn:
    """Run the command line and exit."""
    interrupts: list[bool] = []
    # NumPy needs no threads of its own here. With little memory they hang or fail when it is loaded.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

    def interrupt(*_: object) -> NoReturn:
        # Some libraries lose a KeyboardInterrupt or turn it into another error: so it is recorded here.
        interrupts.append(True)
        sys.unraisablehook = lambda _: None
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    warnings.showwarning = warn
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by the calling process
            setattr(sys, name, Path(os.devnull).open("w", encoding="utf-8"))  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        # A terminal whose encoding lacks Greek letters shows question marks.
        stream.reconfigure(errors="replace")  # type: ignore[union-attr]
    if sys.stderr.isatty():  # elsewhere, as in a file, Python prints the traceback too
        logging.getLogger("rocking").addHandler(Terminal())
    code, message = run()
    if interrupts or code == INTERRUPTED:
        code, message = INTERRUPTED, "interrupted"
        # After an interrupt while a library evaluates a text, `python -m` would end by the signal. Another evaluation prevents it.
        eval("0")
    if message:
        print("rocking:", message, file=sys.stderr)
    sys.exit(code)


def warn(message: Warning | str, *_: object, **__: object) -> None:
    """Print a warning as one line on stderr."""
    print("rocking:", message, file=sys.stderr)


def run() -> tuple[int, str]:
    """Run the command line; return the exit code and a message of one line, empty if there is nothing to report."""
    try:
        from click.exceptions import Exit

        from rocking.cli.app import app

        try:
            with app.make_context("rocking", sys.argv[1:]) as context:
                app.invoke(context)
            code = 0
        except Exit as ended:  # by --help, for example
            code = ended.exit_code
        sys.stdout.flush()
    except KeyboardInterrupt:
        return INTERRUPTED, ""
    except Exception as error:  # noqa: BLE001 (the user gets one line, not a traceback)
        try:
            code, message = refused(error)
            return code, " ".join(message.split())
        except MemoryError:  # it does not suffice for that either
            return 2, NO_MEMORY
    return code, ""


def refused(error: Exception) -> tuple[int, str]:
    """Return the exit code and the message for an error that ended a command."""
    from click import ClickException

    from rocking.kernels.library.load import KernelsUnusable
    from rocking.model.files import FULL, WriteError
    from rocking.model.package import ExtraMissing

    if isinstance(error, KernelsUnusable | ExtraMissing):
        return 2, str(error)
    if (lack := lacking(error)) is not None:
        return 2, LACKING.format(lack) if str(lack) else NO_MEMORY
    if isinstance(error, ClickException):
        return 2, error.format_message()
    if isinstance(error, WriteError):
        return 2, str(error)
    if isinstance(error, BrokenPipeError):  # the reader of the pipe has closed it
        discard_stdout()
        return 1, ""
    if isinstance(error, OSError) and error.errno in FULL:
        discard_stdout()
        return 2, f"the output cannot be written: {error.strerror} (free some space, or redirect the output)"
    notes = "".join(f" ({note})" for note in getattr(error, "__notes__", ()))
    return 1, f"internal error: {type(error).__name__}: {error}{notes}"


def lacking(error: BaseException | None) -> BaseException | None:
    """Return the error behind `error` that tells of a lack of memory or of threads, or None.

    Libraries that cannot be loaded, and threads that cannot start, tell it in their messages only. The interpreter raises a
    SystemError, "error return without exception set", where a library fails under a limit of memory and does not say why.
    """
    while error is not None:
        if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
            return error
        if isinstance(error, ImportError | OSError | RuntimeError) and LACK.search(str(error)):
            return error
        if (
            isinstance(error, SystemError)
            and resource.getrlimit(resource.RLIMIT_AS)[0] != resource.RLIM_INFINITY
        ):
            return MemoryError()
        error = error.__cause__ or error.__context__
    return None


def discard_stdout() -> None:
    """Discard the rest of stdout: at exit the interpreter reports output that it cannot flush."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
