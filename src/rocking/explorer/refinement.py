"""Maps of a measure over two quantities, computed from coarse to fine."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Mapping
from typing import ClassVar

import numpy as np
from attrs import field, frozen

from rocking.explorer.jobs import Workers

COARSEST, STRIDES = 8, (4, 2, 1)
"""Intervals of the first grid and of the finer ones, in intervals of the finest."""
PIECE = 0.12
"""Target duration of a batch, s. A thread takes up other work only between two batches."""
AHEAD = 2
"""Batches queued or running per thread, so that no thread waits for the event loop."""
START, FEW, LARGEST = 16, 256, 16_384
"""Points of the first batch, of the last batches, and of the largest; fewer if points are expensive."""
FASTER = 8
"""Maximum growth factor between two batches, because a few cheap points do not represent the others."""
SHOWN_EVERY = 0.3
"""Minimum time between two images, s. Browser and server need a sixth of it for one."""

Results = dict[str, np.ndarray]
"""Results at n points, by name, each of shape (n,)."""


class Measure:
    """Measure of a map: what is computed at each point of its finest grid, and stored.

    Points are given by the indices of their columns and rows, from 0 at the left and at the bottom.
    """

    points: int
    """Points along each side of the finest grid: a multiple of `COARSEST`, plus 1."""
    types: ClassVar[Mapping[str, type]]
    """Stored results by name, with their types."""
    by_columns: ClassVar[bool] = False
    """True if points of one column share some of the work."""

    def coarse(self, columns: np.ndarray, rows: np.ndarray, stop: np.ndarray) -> Results | None:
        """Return the results at points of the first map; None if another thread sets `stop[0]`."""
        return self.fine(columns, rows, stop)

    def fine(self, columns: np.ndarray, rows: np.ndarray, stop: np.ndarray) -> Results | None:
        """Return the results at points; None if another thread sets `stop[0]`."""
        raise NotImplementedError

    def stored(self, results: Results) -> Results:
        """Return what a map stores of results; not called by two threads at once."""
        return results

    def valid(self) -> np.ndarray:
        """Return which points are valid, shape (points, points). The others keep `blank`."""
        return np.ones((self.points, self.points), bool)

    def blank(self) -> dict[str, np.ndarray]:
        """Return the results before the computation, by name, each of shape (points, points)."""
        return {name: np.zeros((self.points, self.points), dtype) for name, dtype in self.types.items()}

    def undecided(self, fields: Mapping[str, np.ndarray]) -> np.ndarray:
        """Return which points of the first map are computed again, shape (points, points)."""
        return np.zeros((self.points, self.points), bool)


@frozen(eq=False)
class Picture:
    """Map at one stage of the refinement.

    Attributes
    ----------
    fields : dict of arrays (n, n)
        Stored results on the current grid, rows upward.
    points : int
        Points along each side of the finest grid.
    settled, of : int
        Number of computed points of the current grid, and number of points to compute.
    """

    fields: dict[str, np.ndarray] = field(repr=False)
    points: int
    settled: int
    of: int

    @property
    def side(self) -> int:
        """Points along each side of the current grid."""
        return len(next(iter(self.fields.values())))

    @property
    def whole(self) -> bool:
        """True if all points of the current grid are computed, so that it can be read at each point."""
        return self.settled == self.of

    @property
    def done(self) -> bool:
        """True if the finest grid is complete."""
        return self.whole and self.side == self.points

    def progress(self) -> dict[str, object]:
        """Return the progress for the page, as text and as a fraction."""
        share = 0.25 * (self.side / self.points) ** 2 * (1.0 + 3.0 * self.settled / max(self.of, 1))
        text = f"{self.side} × {self.side} points"
        return {"text": text, "share": 1.0 if self.done else share, "side": self.side, "done": self.done}


class Refinement:
    """Refinement of a map on the worker threads, from coarse to fine, until `stop[0]` is set.

    All grids consist of points of the finest one. Threads begin the next grid before the last batches of a grid end.
    """

    def __init__(self, measure: Measure, workers: Workers, stop: np.ndarray) -> None:
        self.measure, self.workers, self.stop = measure, workers, stop
        self.piece = START
        self.fields = measure.blank()
        self.valid = measure.valid()
        self.known = ~self.valid

    def coarse(self) -> Picture:
        """Compute the first, coarse map in the calling thread."""
        places = self._ordered(self._grid(COARSEST))
        self._keep(places, self._computed(places, first=True))
        return self._picture(COARSEST, places.size, places.size)

    async def finer(self) -> AsyncIterator[Picture]:
        """Yield successive maps after `coarse`; the last one is complete."""
        again = self.known & self.measure.undecided(self.fields)
        grids: list[np.ndarray] = []
        for stride in STRIDES:
            due = self._grid(stride) & ~self._grid(2 * stride)
            grids.append(self._ordered(due if grids else due | again))
        ends = np.cumsum([grid.size for grid in grids])
        complete, read, drawn = 0, 0, time.perf_counter()
        async for computed in self._compute(np.concatenate(grids)):
            while complete < len(grids) and computed >= ends[complete]:
                complete += 1
            if complete < len(grids) and time.perf_counter() - drawn <= SHOWN_EVERY:
                continue
            stage = complete - 1 if complete > read else complete  # a complete grid first: it can be read
            read = complete
            settled = int(min(computed, ends[stage]) - ends[stage]) + grids[stage].size
            yield self._picture(STRIDES[stage], settled, grids[stage].size)
            drawn = time.perf_counter()

    def _grid(self, stride: int) -> np.ndarray:
        """Return the mask of every `stride`-th point along each side."""
        mask = np.zeros_like(self.valid)
        mask[::stride, ::stride] = True
        return mask

    def _ordered(self, due: np.ndarray) -> np.ndarray:
        """Return the indices of the points of a mask: single points, or columns, in random order.

        Batches then cover the whole map and cost about the same.
        """
        shuffle = np.random.default_rng(0)
        due = due & self.valid
        if not self.measure.by_columns:
            return shuffle.permutation(np.flatnonzero(due))
        rank = shuffle.permutation(self.measure.points)
        columns, rows = np.nonzero(due.T)
        order = np.argsort(rank[columns], kind="stable")
        return np.asarray(rows * self.measure.points + columns)[order]

    async def _compute(self, order: np.ndarray) -> AsyncIterator[int]:
        """Compute points in batches. Yield the number of leading points that are computed, from 0 to all."""
        ends = self._ends(order)
        under_way: dict[asyncio.Task[tuple[Results, float]], tuple[int, np.ndarray]] = {}
        begun = computed = 0
        yield computed
        while computed < order.size:
            while begun < order.size and len(under_way) < AHEAD * self.workers.count:
                end = ends[np.searchsorted(ends, begun + self._next(order.size - begun))]
                piece = order[begun:end]
                task = asyncio.create_task(self.workers.later(self._timed, piece))
                under_way[task] = begun, piece
                begun += piece.size
            done, _ = await asyncio.wait(under_way, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                _, piece = under_way.pop(task)
                results, taken = task.result()
                self._keep(piece, results)
                times = min(PIECE / max(taken, 1e-6), FASTER)
                self.piece = min(max(int(piece.size * times), 1), LARGEST)
            computed = min((first for first, _ in under_way.values()), default=begun)
            yield computed

    def _ends(self, order: np.ndarray) -> np.ndarray:
        """Return the numbers of leading points at which a batch may end: all, or those of whole columns."""
        if not self.measure.by_columns:
            return np.arange(order.size + 1)
        columns = order % self.measure.points
        return np.append(np.flatnonzero(np.diff(columns)) + 1, order.size)

    def _next(self, left: int) -> int:
        """Return the size of the next batch. The last batches are small, so that all threads finish together."""
        return min(self.piece, max(left // (AHEAD * self.workers.count), FEW), left)

    def _timed(self, places: np.ndarray) -> tuple[Results, float]:
        begun = time.thread_time()
        return self._computed(places), time.thread_time() - begun

    def _computed(self, places: np.ndarray, *, first: bool = False) -> Results:
        rows, columns = np.divmod(places, self.measure.points)
        results = (self.measure.coarse if first else self.measure.fine)(columns, rows, self.stop)
        if results is None:
            raise asyncio.CancelledError
        return results

    def _keep(self, places: np.ndarray, results: Results) -> None:
        stored = self.measure.stored(results)
        for name, values in self.fields.items():
            if name in stored:
                values.reshape(-1)[places] = stored[name]
        self.known.reshape(-1)[places] = True

    def _picture(self, stride: int, settled: int, of: int) -> Picture:
        """Return the map of every `stride`-th point. A point not yet computed has the values of a neighbour."""
        places = np.arange(0, self.measure.points, stride)
        own, coarser = np.ix_(places, places), places // (2 * stride) * (2 * stride)
        nearest = np.ix_(coarser, coarser)
        known = self.known[own]
        kept = {name: np.where(known, values[own], values[nearest]) for name, values in self.fields.items()}
        return Picture(kept, self.measure.points, settled, of)
