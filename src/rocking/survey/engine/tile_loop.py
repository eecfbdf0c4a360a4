"""Loop over tiles from coarse to fine: batches run on any executor, results are kept in the order of the tiles."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator
from concurrent.futures import FIRST_EXCEPTION, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np
from attrs import frozen

from rocking.survey.engine.progress import Watcher, count_when_done
from rocking.survey.measurement import Arrays, batches, compute
from rocking.survey.store.locking import defer_interrupt
from rocking.survey.tiling import Tile

if TYPE_CHECKING:
    from rocking.survey.store.memory import Memory
    from rocking.survey.store.store import Store

MAX_UNDER_WAY = 512
"""Maximum number of batches that run or wait for an earlier tile; their results take about 0.2 GB."""


@frozen(eq=False)
class Pending:
    """Tile whose batches have been submitted."""

    tile: Tile
    known: np.ndarray
    wanted: list[np.ndarray]
    futures: list[Future]


def run(results: Memory | Store, executor: Executor | None = None, watcher: Watcher | None = None) -> None:
    """Compute all missing points; after any interruption, including Ctrl-C, the results kept so far are valid."""
    with engine(executor) as (pool, stop):
        pending: deque[Pending] = deque()
        under_way = 0
        try:
            for tile in (tile for level in results.levels for tile in level.tiles()):
                known = results.known(tile)
                if known.any():
                    there = results.read(tile, (results.measure.shares,))
                    _tell(watcher, results, tile, there, known, before=True)
                if known.all():
                    continue
                pending.append(_submit(pool, stop, results, tile, known))
                if watcher is not None:
                    for future, wanted in zip(pending[-1].futures, pending[-1].wanted, strict=True):
                        count_when_done(watcher.bar, future, wanted.size)
                under_way += len(pending[-1].futures)
                while under_way > MAX_UNDER_WAY:
                    under_way -= _settle(pending, results, watcher)
            while pending:
                _settle(pending, results, watcher)
        finally:
            for future in (future for each in pending for future in each.futures):
                future.cancel()


def _submit(
    pool: Executor, stop: np.ndarray, results: Memory | Store, tile: Tile, known: np.ndarray
) -> Pending:
    """Submit the points of a tile that neither an earlier run nor a coarser level has computed."""
    wanted = np.flatnonzero(tile.own(~known)).astype(np.int32)
    work = list(batches(tile, results.asked, wanted, results.measure))
    return Pending(
        tile, known, [each.wanted for each in work], [pool.submit(compute, each, stop) for each in work]
    )


def _settle(pending: deque[Pending], results: Memory | Store, watcher: Watcher | None) -> int:
    """Keep the results of the first submitted tile when they are complete; return its number of batches.

    Tiles are kept in the order of submission.
    """
    first = pending[0]
    wait(first.futures, return_when=FIRST_EXCEPTION)
    tile, shared = first.tile, first.tile.shared()
    found = [future.result() for future in first.futures]
    with defer_interrupt():
        answers = results.read(tile) if first.known.any() else results.measure.blank(tile.shape)
        if shared is not None:
            for name, values in results.coarser(tile).items():
                answers[name][shared[0]] = values
        for wanted, new in zip(first.wanted, found, strict=True):
            for name, values in new.items():
                answers[name].reshape(-1)[wanted] = values
        results.write(tile, answers)
    _tell(watcher, results, tile, answers, ~first.known, before=False)
    pending.popleft()
    return len(first.futures)


def _tell(
    watcher: Watcher | None,
    results: Memory | Store,
    tile: Tile,
    answers: Arrays,
    which: np.ndarray,
    *,
    before: bool,
) -> None:
    """Report the results at the points that no coarser level contains."""
    if watcher is not None:
        watcher.settled(answers[results.measure.shares][tile.own(which)], before=before)


@contextmanager
def engine(executor: Executor | None) -> Iterator[tuple[Executor, np.ndarray]]:
    """Provide an executor and a flag that stops the work of threads. Default: a thread pool, one thread per core."""
    stop = np.zeros(1, np.int64)
    own = ThreadPoolExecutor(cores(), "survey") if executor is None else None
    try:
        yield own or executor, stop  # type: ignore[misc]
    except BaseException:
        stop[0] = 1
        raise
    finally:
        if own is not None:
            own.shutdown(cancel_futures=True)


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
