"""Engine of a survey, which computes its batches: threads, an executor, or the workers of a Dask cluster."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any, Protocol

import numpy as np


class Engine(Protocol):
    """Executor (`concurrent.futures.Executor`) or client of a Dask cluster (`distributed.Client`)."""

    @property
    def submit(self) -> Callable[..., Any]:
        """Function that submits a call and returns its future."""
        ...


class ClusterFuture(Future[Any]):
    """Result of a task of a Dask cluster."""

    def __init__(self, task: Any) -> None:
        super().__init__()
        self.task = task

    def cancel(self) -> bool:
        """Cancel the task, also while its result is being read."""
        if not self.done() and self.task.client.status == "running":
            self.task.cancel()
        return super().cancel()

    def settle(self, task: Any) -> None:
        """Take over the result of the task, or its error."""
        value, error = None, None
        try:
            value = task.result()
        except BaseException as raised:  # noqa: BLE001 (the caller of `result` gets it)
            error = raised
        if not self.set_running_or_notify_cancel():
            return
        if error is None:
            self.set_result(value)
        else:
            self.set_exception(error)


class ClusterExecutor(Executor):
    """Executor that submits to a Dask cluster.

    It replaces that of `Client.get_executor`, which fails if a worker is lost while its result is read (distributed 2026.8).
    """

    def __init__(self, client: Engine) -> None:
        self.client = client

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Submit a call; the cluster repeats it if its worker is lost."""
        task = self.client.submit(function, *args, **kwargs, pure=False)
        result = ClusterFuture(task)
        task.add_done_callback(result.settle)
        return result


def is_client(executor: object) -> bool:
    """Return whether an object is a client of a Dask cluster that may wait for results."""
    distributed = sys.modules.get("distributed")
    return distributed is not None and isinstance(executor, distributed.Client) and not executor.asynchronous


@contextmanager
def engine(given: Engine | None) -> Iterator[tuple[Executor, np.ndarray]]:
    """Provide an executor and a flag that stops the work of threads. Default: a thread pool, one thread per core."""
    stop = np.zeros(1, np.int64)
    own = ThreadPoolExecutor(cores(), "survey") if given is None else None
    try:
        yield own or (ClusterExecutor(given) if is_client(given) else given), stop  # type: ignore[arg-type, misc]
    except BaseException:
        stop[0] = 1
        raise
    finally:
        if own is not None:
            own.shutdown(cancel_futures=True)


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
