"""Run of a survey: its cost, its progress, the loop over its tiles, and its dataset in memory or in a store."""

from __future__ import annotations

import math
import os
import time
from collections import deque
from collections.abc import Iterator
from concurrent.futures import FIRST_EXCEPTION, CancelledError, Executor, Future, wait
from contextlib import contextmanager, suppress
from threading import Timer
from typing import TYPE_CHECKING, Any

import numpy as np
from attrs import frozen

from rocking.model.package import require_extra
from rocking.model.progress import Bar
from rocking.model.tables_and_json import flags
from rocking.model.text import counted, formatted_path, percent
from rocking.model.validation import Refusal, instance
from rocking.survey.engine import Engine, cores, engine, is_client
from rocking.survey.measurement import Arrays, Batch, Measurement, batches, compute
from rocking.survey.memory import Memory, check_fits
from rocking.survey.spec import SurveySpec
from rocking.survey.store_access import defer_interrupt
from rocking.survey.tiling import Level, Tile

if TYPE_CHECKING:
    import xarray as xr

    from rocking.survey.memory import Memory
    from rocking.survey.zarr_store import Store


PILOTS = 512
"""Points of the sample. They are computed together, as in the survey: alone, a point takes many times as long."""
MAX_SECONDS = 0.5
"""Time limit of the estimate itself, s."""
GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0


@frozen
class Cost:
    """Cost of a survey: points, tiles and computing time.

    Attributes
    ----------
    points, tiles : int
        Total numbers.
    done : int
        Number of points computed by an earlier run.
    seconds : float
        Estimated time of one core for the remaining points, from a sample of up to 512 points. The estimate is rough if
        a few points are very expensive.
    at_least : bool
        Whether the sample was stopped at its time limit. Then `seconds` is a lower bound.
    """

    points: int
    tiles: int
    done: int
    seconds: float
    at_least: bool = False

    def describe(self, workers: int | None) -> str:
        """Return the cost in one line, for a number of workers; None if their number is unknown."""
        what = f"{counted(self.points, 'point')} in {counted(self.tiles, 'tile')}"
        if self.done:
            what += f", {self.done:,} of them computed before"
        about = "more than" if self.at_least else "about"
        on = "one core" if workers is None else counted(workers, "core")
        return f"{what}, {about} {duration(self.seconds / (workers or 1))} on {on}"


def cost(spec: SurveySpec, measure: Measurement, levels: list[Level], there: int) -> Cost:
    """Estimate the cost of a survey, of which `there` points exist, from a sample of its points."""
    tiles = sum(math.prod(level.tile_counts) for level in levels)
    if there == spec.points:
        return Cost(spec.points, tiles, there, 0.0)
    # multiples of the golden section, rounded to integers, spread the sample evenly over the points
    stride = round(GOLDEN * spec.points)
    places = (np.arange(min(PILOTS, spec.points), dtype=object) * stride % spec.points).astype(np.int64)
    stop = np.zeros(1, np.int64)
    compute(Batch(spec, places[:1], measure.function, measure.options), stop)  # opens the compiled kernels
    limit = Timer(MAX_SECONDS, stop.fill, (1,))
    limit.start()
    begun = time.perf_counter()
    with suppress(CancelledError):
        compute(Batch(spec, places, measure.function, measure.options), stop)
    limit.cancel()
    each = (time.perf_counter() - begun) / places.size
    return Cost(spec.points, tiles, there, each * (spec.points - there), bool(stop[0]))


def duration(seconds: float) -> str:
    """Return a time with two digits and its unit."""
    for size, unit in ((86400.0, "days"), (3600.0, "hours"), (60.0, "minutes")):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.2g} {unit}"
    return f"{seconds:.0f} s" if seconds >= 10.0 else f"{seconds:.1g} s"


def count_when_done(bar: Bar, batch: Future[Any], points: int) -> None:
    """Count the points of a batch when it ends."""

    def count(ended: Future[Any]) -> None:
        if not ended.cancelled() and ended.exception() is None:
            bar.advance(points)

    batch.add_done_callback(count)


class Watcher:
    """Report of a survey to its progress bar.

    Points count when their batch ends. The fractions of the response types follow when their tile is kept.
    """

    def __init__(self, bar: Bar, measure: Measurement) -> None:
        self.bar, self.shares = bar, measure.shares
        variable = next(each for each in measure.variables if each.name == measure.shares)
        self.meanings = flags(variable.attributes)
        self.counts = dict.fromkeys(self.meanings, 0)

    def settled(self, numbers: np.ndarray, *, before: bool) -> None:
        """Count the types of completed points; those of an earlier run count as points, too."""
        values, counts = np.unique(numbers, return_counts=True)
        for value, count in zip(values.tolist(), counts.tolist(), strict=True):
            self.counts[value] += count
        total = max(sum(self.counts.values()), 1)
        largest = sorted(
            ((count, self.meanings[value]) for value, count in self.counts.items() if count), reverse=True
        )
        self.bar.text = ", ".join(f"{meaning} {percent(count / total)}" for count, meaning in largest)
        if before:
            self.bar.advance(numbers.size, before=True)


MAX_UNDER_WAY = 512
"""Maximum number of batches that run or wait for an earlier tile; their results take about 0.2 GB."""


@frozen(eq=False)
class Pending:
    """Tile whose batches have been submitted."""

    tile: Tile
    known: np.ndarray
    wanted: list[np.ndarray]
    futures: list[Future]


def run(results: Memory | Store, executor: Engine | None = None, watcher: Watcher | None = None) -> None:
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
                    for future, requested in zip(pending[-1].futures, pending[-1].wanted, strict=True):
                        count_when_done(watcher.bar, future, requested.size)
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
    requested = np.flatnonzero(tile.own(~known)).astype(np.int32)
    work = list(batches(tile, results.spec, requested, results.measure))
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
    rows = [future.result() for future in first.futures]
    with defer_interrupt():
        answers = results.read(tile) if first.known.any() else results.measure.blank(tile.shape)
        if shared is not None:
            for name, values in results.coarser(tile).items():
                answers[name][shared[0]] = values
        for requested, new in zip(first.wanted, rows, strict=True):
            for name, values in new.items():
                answers[name].reshape(-1)[requested] = values
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


def run_survey(
    spec: SurveySpec,
    measure: Measurement,
    store: str | os.PathLike[str] | None = None,
    executor: Engine | None = None,
    *,
    progress: bool = False,
    repair: bool = False,
) -> xr.Dataset:
    """Run a survey, or resume it in a store; return its dataset."""
    if executor is not None and not is_client(executor):
        instance("executor", executor, Executor)
    instance("progress", progress, bool)
    if instance("repair", repair, bool) and store is None:
        raise Refusal("repair", "be used with {store}, whose damaged tiles it recomputes")
    if store is None:
        check_fits(spec, measure)
        results = Memory(spec, measure)
        _carry_out(
            results, executor, progress, "no results are kept (with store, running it again would resume it)"
        )
        return results.dataset()
    require_extra("store")
    from rocking.survey.zarr_store import opened

    with opened(store, spec, measure, repair=repair) as kept:
        _carry_out(
            kept,
            executor,
            progress,
            f"completed tiles are in {formatted_path(store)}; run it again to resume",
        )
    with _noted(f"The survey is complete in {formatted_path(store)}; run it again to read the results."):
        return kept.dataset()


def _carry_out(results: Memory | Store, executor: Engine | None, progress: bool, interrupted: str) -> None:
    with _noted(f"The survey was interrupted; {interrupted}."):
        if not progress:
            run(results, executor)
            return
        planned = cost(results.spec, results.measure, results.levels, results.done)
        title = planned.describe(cores() if executor is None else None)
        with Bar(planned.points, title=title, unit="points") as bar:
            run(results, executor, Watcher(bar, results.measure))


@contextmanager
def _noted(note: str) -> Iterator[None]:
    """Add a note to KeyboardInterrupt that states the consequence for the survey."""
    try:
        yield
    except KeyboardInterrupt as error:
        error.add_note(note)
        raise
