"""Processes that carry out the steps of a report beside each other, and the results that they share."""

from __future__ import annotations

import hashlib
import math
import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from contextlib import suppress
from functools import cache, wraps
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import local
from types import TracebackType
from typing import Any, ParamSpec, TypeVar

from attrs import frozen

from rocking.model.progress import Bar
from rocking.survey.engine import cores

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")

WORTH = 3.0
"""Processor time of the steps that pays for a process, s."""
PATIENCE = 10.0
"""Time that a process has to end after an interruption, s."""
PROGRAM = """\
import sys
sys.path[:] = {path!r}
from rocking.papers.report.workers import work
work({folder!r})
"""
FOLDER: list[Path] = []
"""Folder of the results that the processes of a report share; empty if there is one process only."""


@frozen(eq=False)
class Step:
    """Step of a report: a function of a module, and its arguments.

    Attributes
    ----------
    name : str
        What progress shows.
    cost : float
        Approximate processor time, s.
    compute : callable
        Function.
    arguments : tuple
        Its arguments.
    """

    name: str
    cost: float
    compute: Callable[..., Any]
    arguments: tuple[Any, ...] = ()

    def __str__(self) -> str:
        return self.name


def shared(compute: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """Compute a result once for each set of arguments; other processes of the report wait for it and read it."""

    def read_or_compute(*arguments: Any, **named: Any) -> Any:
        if not FOLDER:
            return compute(*arguments, **named)
        import fcntl

        name = f"{compute.__module__}.{compute.__name__}{arguments}{named}"
        with (FOLDER[0] / hashlib.sha256(name.encode()).hexdigest()).open("a+b") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            file.seek(0)
            kept = file.read()
            result = pickle.loads(kept) if kept else compute(*arguments, **named)
            if not kept:
                file.write(pickle.dumps(result))
        return result

    once: Any = wraps(compute)(cache(read_or_compute))
    return once


def carry_out(steps: Sequence[Step], bar: Bar) -> list[Any]:
    """Carry out steps, with as many processes as pay off, and return their results in order.

    An error gets a note with the name of its step.
    """
    cost, longest = sum(step.cost for step in steps), max((step.cost for step in steps), default=1.0)
    count = min(cores(), int(cost / WORTH), math.ceil(cost / longest))
    if count < 2:
        return [_noted(step, bar, step.compute, *step.arguments) for step in steps]
    with Workers(count) as workers:
        ordered = sorted(steps, key=lambda step: step.cost, reverse=True)
        results = {step: workers.threads.submit(_noted, step, bar, workers.compute, step) for step in ordered}
        for each in wait(results.values(), return_when=FIRST_EXCEPTION).done:
            each.result()
        return [results[step].result() for step in steps]


def _noted(step: Step, bar: Bar, compute: Callable[..., Any], *arguments: Any) -> Any:
    """Carry out a step here or in another process."""
    bar.begin(step, step.cost)
    try:
        result = compute(*arguments)
    except Exception as error:
        error.add_note(f"in the step {step} of the report")
        raise
    bar.end(step)
    return result


class Workers:
    """Processes, each with a thread that sends it one step after another; a context manager."""

    def __init__(self, count: int) -> None:
        self.threads = ThreadPoolExecutor(count, "report")
        self.folder = TemporaryDirectory(prefix="rocking-report-")
        self.processes: list[subprocess.Popen[bytes]] = []
        self.own = local()

    def compute(self, step: Step) -> Any:
        """Send a step to the process of this thread, and return its result."""
        if not hasattr(self.own, "process"):
            self.own.process = self._start()
        process = self.own.process
        process.stdin.write(pickle.dumps((step.compute, step.arguments)))
        process.stdin.flush()
        try:
            result = pickle.load(process.stdout)
        except EOFError:
            raise RuntimeError(f"a process ended with the code {process.wait()}") from None
        if isinstance(result, Exception):
            raise result
        return result

    def _start(self) -> subprocess.Popen[bytes]:
        program = PROGRAM.format(path=sys.path, folder=self.folder.name)
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # in the process until it can handle it
        process = subprocess.Popen(
            [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        self.processes.append(process)
        return process

    def __enter__(self) -> Workers:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None
    ) -> None:
        self.threads.shutdown(wait=False, cancel_futures=True)
        for process in self.processes:
            if error is not None:
                process.send_signal(signal.SIGINT)
            with suppress(OSError):
                process.stdin.close()  # type: ignore[union-attr]
        for process in self.processes:
            try:
                process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self.threads.shutdown()
        for process in self.processes:
            process.stdout.close()  # type: ignore[union-attr]
        self.folder.cleanup()


def work(folder: str) -> None:
    """Carry out the steps that arrive on stdin, and write their results to stdout, until stdin ends or SIGINT arrives."""
    FOLDER.append(Path(folder))
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a step prints does not get between the results
    interrupts: list[bool] = []
    computing: list[bool] = []

    def interrupt(*_: object) -> None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        interrupts.append(True)
        if computing:
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    with suppress(EOFError, BrokenPipeError, KeyboardInterrupt):
        while not interrupts:
            compute, arguments = pickle.load(sys.stdin.buffer)
            computing.append(True)
            try:
                result = compute(*arguments) if not interrupts else None
            except Exception as error:  # noqa: BLE001 (raised in the process that sent the step)
                result = error
            computing.clear()
            answers.write(_packed(result))
            answers.flush()


def _packed(result: Any) -> bytes:
    """Return a result as bytes; an error that cannot be rebuilt becomes a RuntimeError with its text."""
    try:
        packed = pickle.dumps(result)
        pickle.loads(packed)
    except Exception:
        if not isinstance(result, Exception):
            raise
        packed = pickle.dumps(RuntimeError(f"{type(result).__name__}: {result}"))
    return packed
