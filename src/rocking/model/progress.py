"""Progress of long work on stderr: the part of its cost that is done, the time left, and what runs now."""

from __future__ import annotations

import os
import shutil
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from datetime import timedelta
from importlib import import_module
from threading import Event, RLock, Thread
from types import TracebackType
from typing import Any

LOOK = 0.25
"""Time between two looks at the clock, s."""
SILENT, SILENT_LATER, LATER = 2.5, 10.0, 60.0
"""Time between two lines in a log, s: at first, and after the time `LATER`."""
WARM = 5.0
"""Time after which the measured speed counts more than that of costs in seconds, s."""
NEARLY = 0.9
"""Largest part of a step of known cost that counts as done before its end."""
GUESS = 1.5
"""Cost of a step of unknown cost that runs for long, over what it has cost so far."""
CELLS = 20
"""Length of the bar, characters."""
OPEN: list[Bar] = []
"""Bars of the work under way. The last one is shown."""


class Estimate:
    """Estimate of the part done, from the costs of steps and from the time that they took.

    Parameters
    ----------
    total : float
        Cost of all steps.
    in_seconds : bool
        Whether the costs are known, in seconds. Then a step that takes longer than its cost lowers the speed. Otherwise its cost is
        taken to be higher than expected.
    """

    def __init__(self, total: float, *, in_seconds: bool) -> None:
        self.total, self.done, self.in_seconds = total, 0.0, in_seconds
        self.cost = self.time = WARM if in_seconds else 0.0
        self.running: dict[object, tuple[float, float]] = {}

    def begin(self, step: object, cost: float, now: float) -> None:
        """Begin a step of an expected cost, which may run beside others."""
        self.running[step] = cost, now

    def end(self, step: object, cost: float, now: float) -> None:
        """End a step, whose cost may be another one than expected."""
        _, since = self.running.pop(step)
        self.done += cost
        self.cost += cost
        self.time += now - since

    def part(self, now: float) -> float:
        """Return the part of the cost that is done, in [0, 1]."""
        running = [(cost, now - since) for cost, since in self.running.values()]
        speed = self._speed(running)
        reached, total = self.done, self.total
        for cost, passed in running:
            if self.in_seconds:
                reached += min(speed * passed, NEARLY * cost)
            else:
                reached += speed * passed
                total += max(GUESS * speed * passed - cost, 0.0)
        return min(reached / total, 1.0) if total > 0.0 else 1.0

    def _speed(self, running: list[tuple[float, float]]) -> float:
        """Return the cost per unit of time of one step."""
        if self.time == 0.0:
            return 0.0
        late = [each for each in running if self.in_seconds and each[1] * self.cost > each[0] * self.time]
        cost, passed = (sum(each) for each in zip((self.cost, self.time), *late, strict=True))
        return cost / passed


class Bar:
    """Progress on stderr; a context manager around the work.

    A terminal and a notebook show a bar, which changes in place. A log gets a line every few seconds, but none about work that ends
    within `SILENT`.

    Parameters
    ----------
    total : float, optional
        Cost of the work, in any unit. Default: unknown. Then the time that has passed is shown, from `SILENT` on.
    what : str
        Name of the work.
    title : str
        Line above the bar.
    unit : str
        Unit of the cost, such as "points", if its rate is of interest.
    in_seconds : bool
        Whether the cost is known, in seconds of one processor. Then a log gets the title at once, and its lines always as often as in
        the first minute. Default: False.
    shown : bool
        Whether anything is written. Default: True.
    clock : callable
        Function that returns the time, s.

    Examples
    --------
    >>> with Bar(100, "random states", shown=False, clock=lambda: 0.0) as bar:
    ...     bar.advance(25)
    ...     print(bar.state()[0])
    random states 25 %, 0:00:00 left
    """

    def __init__(
        self,
        total: float | None = None,
        what: str = "",
        *,
        title: str = "",
        unit: str = "",
        in_seconds: bool = False,
        shown: bool = True,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.known, self.what, self.unit, self.clock = total is not None, what, unit, clock
        self.estimate = Estimate(total or 0.0, in_seconds=in_seconds)
        self.text, self.before, self.reached, self.start = "", 0.0, 0.0, clock()
        self.display = _display(title, steady=in_seconds) if shown and sys.stderr is not None else None
        self.lock, self.over = RLock(), Event()
        self.thread = Thread(target=self._watch, name="progress", daemon=True)

    def __enter__(self) -> Bar:
        self.start = self.clock()
        self.estimate.begin("", 0.0, self.start)
        if self.display is not None:
            OPEN.append(self)
            self.thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None
    ) -> None:
        if self.display is not None:
            self.over.set()
            self.thread.join()
            OPEN.remove(self)
            self.display.close(*self.state(), failed=error is not None)

    def begin(self, step: object, cost: float) -> None:
        """Begin a step of an expected cost, which may run beside others; its text is its name."""
        with self.lock:
            self.estimate.running.pop("", None)
            self.estimate.begin(step, cost, self.clock())
            self.text = ", ".join(dict.fromkeys(map(str, self.estimate.running)))

    def end(self, step: object) -> None:
        """End a step."""
        with self.lock:
            self.estimate.end(step, self.estimate.running[step][0], self.clock())
            self.text = ", ".join(dict.fromkeys(map(str, self.estimate.running)))

    def advance(self, cost: float, *, before: bool = False) -> None:
        """Add the cost of work that is done, if there are no steps; `before`: by an earlier run."""
        with self.lock:
            if before:
                self.estimate.done += cost
                self.before += cost
                return
            now = self.clock()
            self.estimate.end("", cost, now)
            self.estimate.begin("", min(cost, self.estimate.total - self.estimate.done), now)

    def state(self) -> tuple[str, float | None]:
        """Return the progress as a line of text, and the part done; None if the total is unknown."""
        with self.lock:
            now, estimate = self.clock(), self.estimate
            passed = now - self.start
            if not self.known:
                return f"{self.what} {_duration(passed)}", None
            part, known = estimate.part(now), self.before / max(estimate.total, 1e-300)
            if estimate.total - estimate.done <= 1e-9 * estimate.total:
                part = 1.0
            if estimate.in_seconds:  # a late step stops the bar, and does not send it back
                part = self.reached = max(self.reached, part)
            words = [f"{self.what} {int(100.0 * part)} %".lstrip()]
            if part == 1.0:
                words[0] += f" in {_duration(passed)}"
            elif part > known:
                words.append(f"{_duration(passed * (1.0 - part) / (part - known))} left")
            if self.unit and estimate.done > self.before and passed > 0.0:
                words.append(f"{(estimate.done - self.before) / passed:,.0f} {self.unit}/s")
            return ": ".join(filter(None, (", ".join(words), self.text))), part

    def tick(self) -> None:
        """Show the progress, unless another bar was opened meanwhile."""
        passed = self.clock() - self.start
        if self.display is not None and OPEN[-1:] == [self] and (self.known or passed >= SILENT):
            self.display.show(*self.state(), passed)

    def _watch(self) -> None:
        while not self.over.wait(LOOK):
            self.tick()


class Log:
    """Lines in a file or a pipe."""

    def __init__(self, title: str, *, steady: bool) -> None:
        self.stream, self.title, self.steady, self.last = sys.stderr, title, steady, 0.0
        if title and steady:
            self.write(f"{title}\n")
            self.title = ""

    def show(self, line: str, part: float | None, passed: float) -> None:
        """Write a line if one is due after some time, s."""
        if passed - self.last >= (SILENT if self.steady or passed < LATER else SILENT_LATER):
            self.last = passed
            self.write(f"{self.title}\n{line}\n".lstrip())
            self.title = ""

    def close(self, line: str, part: float | None, *, failed: bool) -> None:
        """Write a last line if there were others."""
        if self.last and part is not None and not failed:
            self.write(f"{line}\n")

    def write(self, text: str) -> None:
        """Write a text; characters that the stream lacks become question marks."""
        encoding = getattr(self.stream, "encoding", None) or "utf-8"
        with suppress(OSError, ValueError):  # nobody reads any more: the work goes on
            self.stream.write(text.encode(encoding, "replace").decode(encoding))
            self.stream.flush()


class Terminal(Log):
    """Bar in the last line of a terminal."""

    def __init__(self, title: str) -> None:
        super().__init__(title, steady=True)

    def show(self, line: str, part: float | None, passed: float) -> None:
        """Replace the line."""
        self.write(f"\r\x1b[K{_with_bar(line, part)[: shutil.get_terminal_size().columns - 1]}")

    def close(self, line: str, part: float | None, *, failed: bool) -> None:
        """Leave the line, or an empty one if the total was unknown."""
        if part is None:
            self.write("\r\x1b[K")
        else:
            self.show(line, part, 0.0)
            self.write("\n")


class Notebook:
    """Output of a notebook cell that changes in place."""

    def __init__(self, title: str) -> None:
        self.title = title
        self.handle: Any = None

    def show(self, line: str, part: float | None, passed: float) -> None:
        """Replace the output."""
        text = {"text/plain": f"{self.title}\n{_with_bar(line, part)}".lstrip()}
        if self.handle is None:
            self.handle = import_module("IPython.display").display(text, raw=True, display_id=True)
        else:
            self.handle.update(text, raw=True)

    def close(self, line: str, part: float | None, *, failed: bool) -> None:
        """Leave the last progress."""
        self.show(line, part, 0.0)


def _display(title: str, *, steady: bool) -> Log | Notebook:
    """Return the place where this process shows progress."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if getattr(shell, "kernel", None) is not None:
        return Notebook(title)
    with suppress(AttributeError, ValueError):  # no stream of a terminal, or a closed one
        if sys.stderr.isatty() and os.environ.get("TERM") != "dumb":
            return Terminal(title)
    return Log(title, steady=steady)


def _with_bar(line: str, part: float | None) -> str:
    return line if part is None else f"[{'#' * int(CELLS * part):<{CELLS}}] {line}"


def _duration(seconds: float) -> str:
    return str(timedelta(seconds=round(seconds)))
