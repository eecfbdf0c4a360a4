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
from rocking.model import Kind
from rocking.plot.parts import legend
from rocking.survey import classify_points, classify_with_anchor

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
COARSEST = 8
"""Ratio of the intervals of the finest grid to those of the first."""
PIECE = 0.12
"""Target duration of a batch, s. A thread takes up other work only between two batches."""
AHEAD = 2
"""Batches queued or running per thread, so that no thread waits for the event loop."""
START, FEW, LARGEST = 16, 256, 16_384
"""Points of the first batch, of the last batches of a grid, and of the largest; fewer if points are expensive."""
FASTER = 8
"""Maximum growth factor between two batches, because a few cheap points do not represent the others."""
SHOWN_EVERY = 0.5
"""Minimum time between two images of an incomplete grid, s."""
STRIPES, STRIPE = 7, 2
"""Spacing and width of the stripes of a hatch, in points."""
SHADES = 3
"""Shades per category; the orbits of a category use them in turn."""
PLAIN = SHADES * len(legend.LOOKS)
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

    def values(self, places: np.ndarray, side: int) -> dict[str, np.ndarray]:
        """Return the two quantities at points of a grid of `side` × `side`, given by indices in C order, rows upward."""
        rows, columns = np.divmod(places, side)
        return {
            name: np.linspace(span.low, span.high, side)[at]
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
        return np.where(self.look == legend.NONE, PLAIN, self.look + len(legend.LOOKS) * shade)


def _colours() -> np.ndarray:
    """Return the palette indices of all shades and of `PLAIN`: between the stripes (row 0) and on them (row 1)."""
    hatched = [look.hatch is not None for look in legend.LOOKS] * SHADES + [False]
    plain = np.append(np.arange(PLAIN), NOTHING)
    return np.array([plain, np.where(hatched, HATCH, plain)], np.uint8)


_COLOURS = _colours()


@cache
def _stripes(points: int) -> np.ndarray:
    """Return the stripes of a hatch: 1 on a stripe, otherwise 0."""
    up, across = np.ogrid[:points, :points]
    return ((up - across) % STRIPES < STRIPE).astype(np.uint8)


class Refinement:
    """Refinement of a map on the worker threads, from coarse to fine, until `stop[0]` is set."""

    def __init__(self, plane: Plane, workers: Workers, stop: np.ndarray) -> None:
        self.plane, self.workers, self.stop = plane, workers, stop
        self.piece = START
        self.orbits = Orbits()
        self.fields: dict[str, np.ndarray] = {}

    def coarse(self) -> Picture:
        """Compute the first, coarse map in the calling thread."""
        self._begin((self.plane.points - 1) // COARSEST + 1)
        places = np.flatnonzero(self.inside)
        self._keep(places, self._judge(places, self.plane.first))
        return self._picture(places.size, places.size)

    async def finer(self) -> AsyncIterator[Picture]:
        """Yield successive maps after `coarse`; the last one is complete."""
        side, open_ = len(self.fields["kind"]), self.fields["kind"] == UNDETERMINED
        while side < self.plane.points:
            side = 2 * side - 1
            self._begin(side)
            due = np.ones((side, side), bool)
            due[::2, ::2] = open_
            async for picture in self._settle(np.flatnonzero(due & self.inside)):
                yield picture
            open_ = np.zeros((side, side), bool)

    async def _settle(self, places: np.ndarray) -> AsyncIterator[Picture]:
        """Classify points in batches and yield intermediate maps."""
        # random order, so that batches cover the whole map and cost about the same
        order = np.random.default_rng(0).permutation(places)
        under_way: dict[asyncio.Future[tuple[dict[str, np.ndarray], float]], np.ndarray] = {}
        begun, settled, shown = 0, 0, time.perf_counter()
        while settled < order.size:
            while begun < order.size and len(under_way) < AHEAD * self.workers.count:
                piece = order[begun : begun + self._next(order.size - begun)]
                begun += piece.size
                under_way[asyncio.ensure_future(self.workers.later(partial(self._timed, piece)))] = piece
            done, _ = await asyncio.wait(under_way, return_when=asyncio.FIRST_COMPLETED)
            for future in done:
                piece = under_way.pop(future)
                answers, taken = future.result()
                self._keep(piece, answers)
                settled += piece.size
                times = min(PIECE / max(taken, 1e-6), FASTER)
                self.piece = min(max(int(piece.size * times), 1), LARGEST)
            if time.perf_counter() - shown > SHOWN_EVERY and settled < order.size:
                shown = time.perf_counter()
                yield self._picture(settled, order.size)
        yield self._picture(settled, order.size)

    def _next(self, left: int) -> int:
        """Return the size of the next batch. The last batches are small, so that all threads finish together."""
        return min(self.piece, max(left // (AHEAD * self.workers.count), FEW))

    def _timed(self, places: np.ndarray) -> tuple[dict[str, np.ndarray], float]:
        begun = time.thread_time()
        return self._judge(places, ALL), time.thread_time() - begun

    def _judge(self, places: np.ndarray, cycles: int) -> dict[str, np.ndarray]:
        ask = classify_with_anchor if self.plane.with_attractors else classify_points
        answers = ask(self.plane.values(places, self.side), self.plane.fixed, cycles, PERIOD, self.stop)
        if answers is None:
            raise asyncio.CancelledError
        return answers

    def _begin(self, side: int) -> None:
        """Start a grid of `side` × `side` points, filled with the nearest points of the previous grid."""
        self.side = side
        nearest = (np.arange(side) + 1) // 2
        for name, dtype in FIELDS.items():
            before = self.fields.get(name)
            self.fields[name] = (
                np.zeros((side, side), dtype) if before is None else before[np.ix_(nearest, nearest)]
            )
        values = self.plane.values(np.arange(side * side), side)
        angles = np.abs(values.get("angle", np.zeros(1)))
        self.inside = np.broadcast_to((angles <= self.plane.reach), side * side).reshape(side, side)
        self.fields["look"][~self.inside] = legend.NONE

    def _keep(self, places: np.ndarray, answers: dict[str, np.ndarray]) -> None:
        look = legend.looks(answers["kind"], answers["response_period"], answers["symmetric"])
        answers["look"] = look
        if self.plane.with_attractors:
            states = np.column_stack([answers["orbit_angle"], answers["orbit_velocity"]])
            answers["orbit"] = self.orbits.numbers(look, states)
        for name in FIELDS.keys() & answers.keys():
            self.fields[name].reshape(-1)[places] = answers[name]

    def _picture(self, settled: int, of: int) -> Picture:
        kept = {name: values.copy() for name, values in self.fields.items()}
        done = self.side == self.plane.points and settled == of
        return Picture(kept, self.plane.points, settled, of, done)
