"""Who computes for the visitors, and how what is no longer wanted ends."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

import numpy as np

from rocking.survey import cores

Value = TypeVar("Value")
LOG = logging.getLogger(__name__)


class Workers:
    """Threads that all visitors share: quick ones, for what a click asks for, and patient ones, for what refines.

    Two sets, so that no click waits for a map; compiled code holds no lock, so the page's own thread goes on meanwhile.
    """

    def __init__(self) -> None:
        self.count = cores()
        self.quick = ThreadPoolExecutor(self.count, "quick")
        self.patient = ThreadPoolExecutor(self.count, "patient")

    async def soon(self, work: Callable[[], Value]) -> Value:
        """The result of what a click asks for."""
        return await asyncio.get_running_loop().run_in_executor(self.quick, work)

    async def later(self, work: Callable[[], Value]) -> Value:
        """The result of a piece of what refines."""
        return await asyncio.get_running_loop().run_in_executor(self.patient, work)

    def close(self) -> None:
        """End the threads once they are done with what they are at."""
        for pool in (self.quick, self.patient):
            pool.shutdown(wait=False, cancel_futures=True)


class Jobs:
    """What is under way for one visitor: one job a name. A new one of a name ends the one before."""

    def __init__(self) -> None:
        self._jobs: dict[str, tuple[asyncio.Task[None], np.ndarray]] = {}

    def start(self, name: str, work: Callable[[np.ndarray], Awaitable[None]]) -> None:
        """Begin `work(stop)`; `stop[0]` is set when it is no longer wanted, for compiled code to see."""
        self.end(name)
        stop = np.zeros(1, np.int64)
        task = asyncio.ensure_future(work(stop))
        self._jobs[name] = task, stop
        task.add_done_callback(lambda done: self._ended(name, done))

    def end(self, name: str) -> None:
        """End the job of that name, if there is one."""
        if name in self._jobs:
            task, stop = self._jobs.pop(name)
            stop[0] = 1
            task.cancel()

    async def over(self, name: str, most: float | None = None) -> None:
        """Wait for the end of the job of that name, if there is one, however it ends; for so many seconds at most."""
        if name in self._jobs:
            await asyncio.wait([self._jobs[name][0]], timeout=most)

    def end_all(self) -> None:
        """End whatever is under way."""
        for name in tuple(self._jobs):
            self.end(name)

    @property
    def busy(self) -> bool:
        """Whether anything is under way."""
        return bool(self._jobs)

    def _ended(self, name: str, task: asyncio.Task[None]) -> None:
        if self._jobs.get(name, (None,))[0] is task:
            del self._jobs[name]
        if not task.cancelled() and task.exception() is not None:
            LOG.error("the job %r failed", name, exc_info=task.exception())
