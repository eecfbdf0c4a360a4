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


class ClusterExecutor(Executor):
    """Executor that submits to a Dask cluster.

    It replaces that of `Client.get_executor`, which fails if a worker is lost while its result is read (distributed 2026.8).
    """

    def __init__(self, client: Engine) -> None:
        self.client = client

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Submit a call; the cluster repeats it if its worker is lost."""
        answer: Future[Any] = Future()
        task = self.client.submit(function, *args, **kwargs, pure=False)

        def settle(task: Any) -> None:
            if not answer.set_running_or_notify_cancel():
                return
            try:
                answer.set_result(task.result())
            except BaseException as error:  # noqa: BLE001 (the caller of `result` gets it)
                answer.set_exception(error)

        task.add_done_callback(settle)
        answer.add_done_callback(lambda ended: task.cancel() if ended.cancelled() else None)
        return answer


def is_client(executor: object) -> bool:
    """Return whether an object is a client of a Dask cluster."""
    distributed = sys.modules.get("distributed")
    return distributed is not None and isinstance(executor, distributed.Client)


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
