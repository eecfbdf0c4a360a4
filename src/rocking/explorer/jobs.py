"""Thread pools and cancellable jobs of all sessions."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

import numpy as np

from rocking.survey.engine import cores

Value = TypeVar("Value")
LOG = logging.getLogger(__name__)


class Workers:
    """Thread pools shared by all sessions: `quick` for selections, `patient` for refinement, `reader` for files.

    With two pools, no selection waits for a map. Compiled code releases the GIL, so that the event loop keeps running.
    """

    def __init__(self) -> None:
        self.count = cores()
        self.quick = ThreadPoolExecutor(self.count, "quick")
        self.patient = ThreadPoolExecutor(self.count, "patient")
        self.reader = ThreadPoolExecutor(1, "reader")

    async def soon(self, work: Callable[..., Value], *arguments: Any) -> Value:
        """Run the work of a selection and return its result."""
        return await asyncio.get_running_loop().run_in_executor(self.quick, work, *arguments)

    async def later(self, work: Callable[..., Value], *arguments: Any) -> Value:
        """Run a batch of a refinement and return its result."""
        return await asyncio.get_running_loop().run_in_executor(self.patient, work, *arguments)

    async def read(self, work: Callable[..., Value], *arguments: Any) -> Value:
        """Read a file, one at a time, and return its contents."""
        return await asyncio.get_running_loop().run_in_executor(self.reader, work, *arguments)

    def close(self) -> None:
        """Shut down the threads after their current work."""
        for pool in (self.quick, self.patient, self.reader):
            pool.shutdown(wait=False, cancel_futures=True)


class Jobs:
    """Running jobs of one session, by name. A new job cancels the earlier job of the same name."""

    def __init__(self) -> None:
        self._jobs: dict[str, tuple[asyncio.Task[None], np.ndarray]] = {}

    def start(self, name: str, work: Callable[..., Awaitable[None]], *arguments: Any) -> None:
        """Start `work(*arguments, stop)`. Cancellation sets `stop[0]`, which compiled code checks."""
        self.end(name)
        stop = np.zeros(1, np.int64)
        task = asyncio.ensure_future(work(*arguments, stop))
        self._jobs[name] = task, stop
        task.add_done_callback(lambda done: self._ended(name, done))

    def end(self, *names: str) -> None:
        """Cancel the jobs of these names that are running."""
        for name in self._jobs.keys() & names:
            task, stop = self._jobs.pop(name)
            stop[0] = 1
            task.cancel()

    async def over(self, name: str, most: float | None = None) -> None:
        """Wait until the job of this name has finished, failed or been cancelled; for `most` seconds at most."""
        if name in self._jobs:
            await asyncio.wait([self._jobs[name][0]], timeout=most)

    def end_all(self) -> None:
        """Cancel all jobs."""
        self.end(*self._jobs)

    @property
    def busy(self) -> bool:
        """Return whether a job is running."""
        return bool(self._jobs)

    def _ended(self, name: str, task: asyncio.Task[None]) -> None:
        if self._jobs.get(name, (None,))[0] is task:
            del self._jobs[name]
        if not task.cancelled() and task.exception() is not None:
            LOG.error("the job %r failed", name, exc_info=task.exception())
