"""Map of responses over two quantities, computed from coarse to fine."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator
from functools import cache, partial

import numpy as np
from attrs import field, frozen

from rocking.explorer.attractor_labels import Orbits
from rocking.explorer.view_state import Span
from rocking.explorer.worker_pools import Workers
from rocking.model.verdict import Kind
from rocking.plot import style
from rocking.survey.attractors import classify_with_anchor
from rocking.survey.verdict_measures import classify_points

PERIOD = 64
"""Largest response period that is sought, in forcing cycles."""
FIELDS = {
    "look": np.uint8,
    "kind": np.uint8,
    "evidence": np.uint8,
    "response_period": np.int32,
    "impacts_per_period": np.int32,
    "symmetric": np.uint8,
    "exponent": np.float64,
    "orbit": np.uint8,
}
"""Stored fields of each point, with their types; `look` is the index in `LOOKS`."""
UNDETERMINED = Kind.UNDETERMINED.code
FIRST, ALL = 60, 10_000
"""Maximum number of cycles per point: in the first, coarse map, and in the finer maps."""
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
STRIPES, STRIPE = 7, 2
"""Spacing and width of the stripes of a hatch, in points."""
SHADES = 3
"""Shades per category; the orbits of a category use them in turn."""
PLAIN = SHADES * len(style.LOOKS)
"""Number of shades of all categories."""
HATCH, NOTHING = PLAIN, PLAIN + 1
"""Palette indices after the shades: stripe of a hatch, transparent."""


@frozen
class Plane:
    """Definition of a map.

    Attributes
    ----------
    across, up : tuple of (str, Span)
        Names and ranges of the two quantities.
    fixed : dict of str to float
        Constant parameters, by name.
    points : int
        Points along each side of the finest grid.
    reach : float
        Largest |Θ₀| of a valid initial state: the brace angle. Default: unlimited.
    first : int
        Maximum number of cycles per point in the first map; fewer if cycles are expensive.
    with_attractors : bool
        True to distinguish orbits of one category, for the initial states of one system. Default: False.
    """

    across: tuple[str, Span]
    up: tuple[str, Span]
    fixed: dict[str, float]
    points: int
    reach: float = np.inf
    first: int = FIRST
    with_attractors: bool = False

    def values(self, places: np.ndarray) -> dict[str, np.ndarray]:
        """Return the two quantities at points of the finest grid, given by indices in C order, rows upward."""
        rows, columns = np.divmod(places, self.points)
        return {
            name: np.linspace(span.low, span.high, self.points)[at]
            for (name, span), at in ((self.across, columns), (self.up, rows))
        }


@frozen(eq=False)
class Picture:
    """Map at one stage of the refinement.

    Attributes
    ----------
    fields : dict of arrays (n, n)
        `FIELDS` of the current grid, rows upward.
    points : int
        Points along each side of the finest grid.
    settled, of : int
        Number of classified points of the current grid, and number of points to classify.
    done : bool
        True if the finest grid is complete.
    """

    fields: dict[str, np.ndarray] = field(repr=False)
    points: int
    settled: int
    of: int
    done: bool

    @property
    def look(self) -> np.ndarray:
        """Indices in `LOOKS`, shape (n, n); `NONE` for an invalid initial state."""
        return self.fields["look"]

    def colours(self) -> np.ndarray:
        """Return palette indices, shape (points, points). The finest grid is used at all stages, to keep hatches in place."""
        side = len(self.look)
        stride = (self.points - 1) // (side - 1)
        nearest = (np.arange(self.points) + stride // 2) // stride
        return _COLOURS[_stripes(self.points), self._drawn()[np.ix_(nearest, nearest)]]

    def counts(self) -> np.ndarray:
        """Return the number of points per shade (rows) and category (columns)."""
        return np.bincount(self._drawn().ravel(), minlength=PLAIN + 1)[:PLAIN].reshape(SHADES, -1)

    def _drawn(self) -> np.ndarray:
        """Return the indices of the shades; `PLAIN` for an invalid initial state."""
        shade = self.fields["orbit"] % SHADES
        return np.where(self.look == style.NONE, PLAIN, self.look + len(style.LOOKS) * shade)


def _colours() -> np.ndarray:
    """Return the palette indices of all shades and of `PLAIN`: between the stripes (row 0) and on them (row 1)."""
    hatched = [look.hatch is not None for look in style.LOOKS] * SHADES + [False]
    plain = np.append(np.arange(PLAIN), NOTHING)
    return np.array([plain, np.where(hatched, HATCH, plain)], np.uint8)


_COLOURS = _colours()


@cache
def _stripes(points: int) -> np.ndarray:
    """Return the stripes of a hatch: 1 on a stripe, otherwise 0."""
    up, across = np.ogrid[:points, :points]
    return ((up - across) % STRIPES < STRIPE).astype(np.uint8)


class Refinement:
    """Refinement of a map on the worker threads, from coarse to fine, until `stop[0]` is set.

    All grids consist of points of the finest one. Threads begin the next grid before the last batches of a grid end.
    """

    def __init__(self, plane: Plane, workers: Workers, stop: np.ndarray) -> None:
        self.plane, self.workers, self.stop = plane, workers, stop
        self.piece = START
        self.orbits = Orbits()
        shape = plane.points, plane.points
        self.fields = {name: np.zeros(shape, dtype) for name, dtype in FIELDS.items()}
        values = plane.values(np.arange(plane.points**2))
        angles = np.abs(values.get("angle", np.zeros(1)))
        self.inside = np.broadcast_to(angles <= plane.reach, plane.points**2).reshape(shape)
        self.fields["look"][~self.inside] = style.NONE
        self.known = ~self.inside

    def coarse(self) -> Picture:
        """Compute the first, coarse map in the calling thread."""
        places = self._shuffled(self._grid(COARSEST))
        self._keep(places, self._judge(places, self.plane.first))
        return self._picture(COARSEST, places.size, places.size)

    async def finer(self) -> AsyncIterator[Picture]:
        """Yield successive maps after `coarse`; the last one is complete."""
        open_ = self.known & (self.fields["kind"] == UNDETERMINED)
        grids: list[np.ndarray] = []
        for stride in STRIDES:
            due = self._grid(stride) & ~self._grid(2 * stride)
            grids.append(self._shuffled(due if grids else due | open_))
        ends = np.cumsum([grid.size for grid in grids])
        stage, shown = 0, time.perf_counter()
        async for classified in self._classify(np.concatenate(grids)):
            while classified >= ends[stage] and stage + 1 < len(grids):
                stage += 1
            if classified == ends[-1] or time.perf_counter() - shown > SHOWN_EVERY:
                settled = int(classified - ends[stage]) + grids[stage].size
                yield self._picture(STRIDES[stage], settled, grids[stage].size)
                shown = time.perf_counter()

    def _grid(self, stride: int) -> np.ndarray:
        """Return the mask of every `stride`-th point along each side."""
        mask = np.zeros_like(self.inside)
        mask[::stride, ::stride] = True
        return mask

    def _shuffled(self, due: np.ndarray) -> np.ndarray:
        """Return the points of a mask in random order, so that batches cover the whole map and cost about the same."""
        return np.random.default_rng(0).permutation(np.flatnonzero(due & self.inside))

    async def _classify(self, order: np.ndarray) -> AsyncIterator[int]:
        """Classify points in batches. Yield the number of leading points that are classified, from 0 to all."""
        under_way: dict[asyncio.Task[tuple[dict[str, np.ndarray], float]], tuple[int, np.ndarray]] = {}
        begun = classified = 0
        yield classified
        while classified < order.size:
            while begun < order.size and len(under_way) < AHEAD * self.workers.count:
                piece = order[begun : begun + self._next(order.size - begun)]
                task = asyncio.create_task(self.workers.later(partial(self._timed, piece)))
                under_way[task] = begun, piece
                begun += piece.size
            done, _ = await asyncio.wait(under_way, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                _, piece = under_way.pop(task)
                answers, taken = task.result()
                self._keep(piece, answers)
                times = min(PIECE / max(taken, 1e-6), FASTER)
                self.piece = min(max(int(piece.size * times), 1), LARGEST)
            classified = min((first for first, _ in under_way.values()), default=begun)
            yield classified

    def _next(self, left: int) -> int:
        """Return the size of the next batch. The last batches are small, so that all threads finish together."""
        return min(self.piece, max(left // (AHEAD * self.workers.count), FEW))

    def _timed(self, places: np.ndarray) -> tuple[dict[str, np.ndarray], float]:
        begun = time.thread_time()
        return self._judge(places, ALL), time.thread_time() - begun

    def _judge(self, places: np.ndarray, cycles: int) -> dict[str, np.ndarray]:
        ask = classify_with_anchor if self.plane.with_attractors else classify_points
        answers = ask(self.plane.values(places), self.plane.fixed, cycles, PERIOD, self.stop)
        if answers is None:
            raise asyncio.CancelledError
        return answers

    def _keep(self, places: np.ndarray, answers: dict[str, np.ndarray]) -> None:
        look = style.looks(answers["kind"], answers["response_period"], answers["symmetric"])
        answers["look"] = look
        if self.plane.with_attractors:
            states = np.column_stack([answers["orbit_angle"], answers["orbit_velocity"]])
            answers["orbit"] = self.orbits.numbers(look, states)
        for name in FIELDS.keys() & answers.keys():
            self.fields[name].reshape(-1)[places] = answers[name]
        self.known.reshape(-1)[places] = True

    def _picture(self, stride: int, settled: int, of: int) -> Picture:
        """Return the map of every `stride`-th point. A point not yet classified has the values of a neighbour."""
        places = np.arange(0, self.plane.points, stride)
        own, coarser = np.ix_(places, places), places // (2 * stride) * (2 * stride)
        nearest = np.ix_(coarser, coarser)
        known = self.known[own]
        kept = {name: np.where(known, values[own], values[nearest]) for name, values in self.fields.items()}
        return Picture(kept, self.plane.points, settled, of, stride == 1 and settled == of)
